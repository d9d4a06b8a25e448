"""What a diagnosis left open: the group that its logs cannot tell apart."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform, effect_key
from ptp_symbolic.workflows.result import read_diagnosis


def group_of(
    diagnosis: Path | Mapping[str, Any], platform: Platform
) -> tuple[tuple[str, ...], dict[str, float]]:
    """The named set and those that may stand in its place, as keys joined by ``+``, and fitted
    values of parameters in SI; no set where the `diagnosis`, a summary or its folder, leaves
    nothing open.

    Raises InputError for a folder without a diagnosis of `platform`, and for the platform that it
    has written in place of the one that was diagnosed.
    """
    fitted, named, ranking, file = read_diagnosis(diagnosis, platform, _open_parts)
    declared = {effect_key(e.effect, e.axis) for e in platform.effects}
    already = [key for key in named if key in declared]
    if already:
        where = f" in {diagnosis}" if isinstance(diagnosis, Path) else ""
        diagnosed = f", {file}" if file else ""
        raise InputError(
            f"{platform.source or platform.name}: declares {' and '.join(already)} already, which"
            f" the diagnosis{where} has added; give the platform that was diagnosed"
            f"{diagnosed}, in place of the extended one."
        )
    sets = [tuple(named)]
    for key, others in named.items():
        sets += [tuple(other if k == key else k for k in named) for other in others]
    values: dict[str, float] = {}
    for members in reversed(sets):
        values |= _fitted_in(ranking, members)
    values |= {parameter: row["value"] for parameter, row in fitted.items()}
    return tuple("+".join(members) for members in sets) if len(sets) > 1 else (), values


def _open_parts(found: Mapping[str, Any]) -> tuple[Any, dict[str, list[str]], Any, str | None]:
    """Fitted parameters, named effects with what may stand in their place, the ranking, and the
    file of the platform that was diagnosed.
    """
    source = (found.get("provenance") or {}).get("platform") or {}
    named = {effect_key(a["effect"], a["axis"]): a["confusable_with"] for a in found["added"]}
    return found["fit"]["after"]["parameters"], named, found["ranking"], source.get("file")


def _fitted_in(ranking: list[Mapping[str, Any]], members: tuple[str, ...]) -> dict[str, float]:
    """Values of the effects of the best set with these `members`, by parameter."""
    wanted = sorted(key.partition("@")[0] for key in members)
    for row in ranking:
        if sorted(row["effect"].split(" + ")) == wanted:
            return {name: p["value"] for name, p in row["parameters"].items()}
    return {}
