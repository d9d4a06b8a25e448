"""What a diagnosis left open: the group that its logs cannot tell apart."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform


def group_of(folder: Path, platform: Platform) -> tuple[tuple[str, ...], dict[str, float]]:
    """The named set and those that may stand in its place, as keys joined by ``+``, and fitted
    values of parameters in SI; no set where the diagnosis in `folder` leaves nothing open.

    Raises InputError for a folder without a diagnosis of `platform`.
    """
    path = folder / "diagnosis.json"
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        name = found["platform"]["name"]
        fitted = found["fit"]["after"]["parameters"]
        named = {_key(a["effect"], a["axis"]): a["confusable_with"] for a in found["added"]}
        ranking = found["ranking"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path}: is no diagnosis; name the folder that `diagnose --out` has written."
        ) from error
    if name != platform.name:
        raise InputError(
            f"{path}: is of platform '{name}', not of '{platform.name}'; give the platform that was"
            " diagnosed."
        )
    sets = [tuple(named)]
    for key, others in named.items():
        sets += [tuple(other if k == key else k for k in named) for other in others]
    values: dict[str, float] = {}
    for members in reversed(sets):
        values |= _fitted_in(ranking, members)
    values |= {parameter: row["value"] for parameter, row in fitted.items()}
    return tuple("+".join(members) for members in sets) if len(sets) > 1 else (), values


def _key(effect: str, axis: str | None) -> str:
    return effect if axis is None else f"{effect}@{axis}"


def _fitted_in(ranking: list[Mapping[str, Any]], members: tuple[str, ...]) -> dict[str, float]:
    """Values of the effects of the best set with these `members`, by parameter."""
    wanted = sorted(key.partition("@")[0] for key in members)
    for row in ranking:
        if sorted(row["effect"].split(" + ")) == wanted:
            return {name: p["value"] for name, p in row["parameters"].items()}
    return {}
