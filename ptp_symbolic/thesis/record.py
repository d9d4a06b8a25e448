"""thesis.json: every item and figure of the report, and how the items come out, kind by kind."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from ptp_symbolic.thesis.figures import ThesisFigure
from ptp_symbolic.thesis.items import Item, Kind
from ptp_symbolic.thesis.precision import NOISE, Precision, all_precisions, spread_of_tests
from ptp_symbolic.thesis.printed import DIRECTIONS, UNITS
from ptp_symbolic.thesis.ramp_test import FITTED

SCHEMA_VERSION = 2
OUTCOMES = ("agree", "differ_by_an_erratum", "differ_unexplained")
Summary = dict[str, dict[str, int]]


def summary(items: Mapping[str, Sequence[Item]]) -> Summary:
    """Per kind of item how many there are, and how those that are compared come out.

    The outcomes of a kind add up to its items; errata are settled or open.
    """
    everything = [item for group in items.values() for item in group]
    counts: Summary = {}
    for kind in Kind:
        own = [item for item in everything if item.kind is kind]
        counts[kind.value] = {"items": len(own)}
        if kind in (Kind.COMPUTED, Kind.ROUND_TRIP):
            found = Counter(map(_outcome, own))
            counts[kind.value] |= {outcome: found[outcome] for outcome in OUTCOMES}
        if kind is Kind.ERRATUM:
            counts[kind.value]["settled"] = sum(bool(item.settled) for item in own)
    return counts


def _outcome(item: Item) -> str:
    if item.agrees:
        return OUTCOMES[0]
    return OUTCOMES[1] if item.erratum is not None else OUTCOMES[2]


def json_text(
    items: Mapping[str, Sequence[Item]], figures: Mapping[str, Sequence[ThesisFigure]]
) -> str:
    """The report as JSON: schema_version, summary, one object per item, figure and estimation.

    A figure names the items that are read from it. Estimations are those of Tables 4.1 and 4.2 with
    their standard deviations and correlations.
    """
    rows = [{"part": part, **asdict(item)} for part, group in items.items() for item in group]
    pictures = [
        {
            "part": part,
            "name": figure.name,
            "kind": figure.kind,
            "caption": figure.caption,
            "items": [row["id"] for row in rows if row["id"].startswith(f"{figure.name}.")],
        }
        for part, group in figures.items()
        for figure in group
    ]
    document = {
        "schema_version": SCHEMA_VERSION,
        "summary": summary(items),
        "items": rows,
        "figures": pictures,
        "estimates": [_estimate(precision) for precision in all_precisions()],
        "spread_of_tests": {
            direction: dict(zip(FITTED, spread_of_tests(direction).tolist(), strict=True))
            for direction in DIRECTIONS
        },
    }
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _estimate(precision: Precision) -> dict[str, Any]:
    columns = {
        "printed": precision.printed,
        "estimated": precision.estimated,
        "lower_bound": precision.lower,
        "upper_bound": precision.upper,
        "on_bound": precision.on_bound,
        "fisher_standard_deviation": precision.fisher,
        "spread_of_fits": precision.spread,
    }
    return {
        "table": precision.table,
        "direction": precision.direction,
        "test": precision.test,
        "noise": NOISE[precision.table],
        "parameters": [
            {"name": name, "unit": UNITS[name]}
            | {column: values[k].item() for column, values in columns.items()}
            for k, name in enumerate(precision.parameters)
        ],
        "correlation": precision.correlation.tolist(),
    }
