"""thesis.json: every item and figure of the report, and how the items come out, kind by kind."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict

from ptp_symbolic.thesis.figures import ThesisFigure
from ptp_symbolic.thesis.items import Item, Kind

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
    """The report as JSON: schema_version, summary, one object per item and per figure.

    A figure names the items that are read from it.
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
    }
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
