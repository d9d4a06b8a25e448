"""The tables of the diagnosis page: rows in the order of reading, bars placed on their axis."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, TypeGuard

Record = Mapping[str, Any]

STAGES = ("before", "after", "noise_floor")
SETS = ("validate", "train")


@dataclass(frozen=True)
class LogAxis:
    """A logarithmic axis from 10**low to 10**high."""

    low: float
    high: float

    def place(self, value: Any) -> float | None:
        """Where a value lies, in percent of the length; None if not positive and finite."""
        if not usable(value) or value <= 0.0:
            return None
        share = (math.log10(value) - self.low) / (self.high - self.low)
        return round(100.0 * min(max(share, 0.0), 1.0), 2)


@dataclass(frozen=True)
class ErrorRow:
    """The error of one run, or of all (`run` None), before and after, against the floor."""

    run: str | None
    before: Record
    after: Record
    noise_floor: Record
    ratio: float | None
    place: Mapping[str, float | None]


@dataclass(frozen=True)
class SignalRow:
    """The error (rms) of one signal in its own unit, or in counts where it has an encoder."""

    signal: str
    unit: str
    before: float | None
    after: float | None
    noise_floor: float | None


@dataclass(frozen=True)
class ErrorGroup:
    """The rows of the validation or the training runs, the total first, and those of the signals
    where there are several.
    """

    set: str
    rows: tuple[ErrorRow, ...]
    signals: tuple[SignalRow, ...]

    @property
    def runs(self) -> int:
        """How many runs there are."""
        return len(self.rows) - 1


def usable(value: Any) -> TypeGuard[float]:
    """Whether it is a finite number."""
    return isinstance(value, int | float) and math.isfinite(value)


def log_axis(values: Iterable[Any]) -> LogAxis:
    """An axis that holds all values above zero and is never shorter than a decade."""
    logs = [math.log10(v) for v in values if usable(v) and v > 0.0] or [0.0]
    low, high = min(logs), max(logs)
    margin = max(0.06 * (high - low), (1.0 - (high - low)) / 2.0)
    return LogAxis(low - margin, high + margin)


def error_of(diagnosis: Record, set_name: str, stage: str, run: str | None = None) -> Record:
    """The errors of one run, or in total; empty when unknown. A run without a floor has theirs."""
    part: Record = ((diagnosis.get("error") or {}).get(set_name) or {}).get(stage) or {}
    total: Record = part.get("total") or {}
    if run is None:
        return total
    return (part.get("by_run") or {}).get(run) or (total if stage == "noise_floor" else {})


def error_measure(totals: Iterable[Record]) -> tuple[str, str]:
    """Key and unit in which errors are shown: encoder counts where every angle has them, else rad
    (m of a linear joint).

    A platform has the same encoders in all runs: one total in counts tells of all.
    """
    known = list(totals)
    if any(usable(total.get("rmse_counts")) for total in known):
        return "rmse_counts", "counts"
    return "rmse", next((str(total["unit"]) for total in known if total.get("unit")), "rad")


def declared_totals(diagnosis: Record) -> list[Record]:
    """The errors of the declared model in total, on the validation and on the training runs."""
    return [error_of(diagnosis, name, "before") for name in SETS]


def error_groups(diagnosis: Record, key: str) -> list[ErrorGroup]:
    """The before/after table, the validation runs first; sets without any error are left out."""
    groups = []
    for name in SETS:
        parts = (diagnosis.get("error") or {}).get(name) or {}
        runs = sorted({r for s in STAGES for r in (parts.get(s) or {}).get("by_run") or {}})
        if parts:
            errors = [
                {s: error_of(diagnosis, name, s, run) for s in STAGES} for run in (None, *runs)
            ]
            groups.append((name, list(zip((None, *runs), errors, strict=True))))
    axis = log_axis(part.get(key) for _, rows in groups for _, e in rows for part in e.values())
    return [
        ErrorGroup(
            name,
            tuple(_error_row(run, errors, key, axis) for run, errors in rows),
            _signal_rows(diagnosis, name),
        )
        for name, rows in groups
    ]


def _error_row(run: str | None, errors: Mapping[str, Record], key: str, axis: LogAxis) -> ErrorRow:
    last, floor = (errors["after"] or errors["before"]).get(key), errors["noise_floor"].get(key)
    ratio = last / floor if usable(last) and usable(floor) and floor else None
    places = {stage: axis.place(errors[stage].get(key)) for stage in STAGES}
    return ErrorRow(run, errors["before"], errors["after"], errors["noise_floor"], ratio, places)


def _signal_rows(diagnosis: Record, set_name: str) -> tuple[SignalRow, ...]:
    """The errors of every signal; none where there is but one, which the total tells already."""
    stages = [signal_errors(diagnosis, set_name, stage) for stage in STAGES]
    if len(stages[0]) < 2:
        return ()
    return tuple(
        SignalRow(name, unit, *(stage.get(name, (None, unit))[0] for stage in stages))
        for name, (_, unit) in stages[0].items()
    )


def signal_errors(
    diagnosis: Record, set_name: str, stage: str
) -> dict[str, tuple[float | None, str]]:
    """Error and unit of every signal at a stage: counts where it has an encoder, else its own."""
    part: Record = ((diagnosis.get("error") or {}).get(set_name) or {}).get(stage) or {}
    return {
        name: (error["rmse_counts"], "counts")
        if usable(error.get("rmse_counts"))
        else (error.get("rmse"), str(error.get("unit") or ""))
        for name, error in (part.get("by_signal") or {}).items()
    }


def doubts(parameter: Record) -> list[str]:
    """What speaks against relying on a fitted parameter."""
    partners = parameter.get("only_with") or []
    found = ["at its bound"] if parameter.get("at_bound") else []
    if partners:
        found.append(f"identifiable only together with {', '.join(partners)}")
    elif parameter.get("identified") is False:
        found.append("not identified")
    return found


def parameter_rows(diagnosis: Record) -> list[dict[str, Any]]:
    """Every fitted parameter before and after, with its change in percent of the value before."""
    fit = diagnosis.get("fit") or {}
    before, after = (((fit.get(s) or {}).get("parameters") or {}) for s in ("before", "after"))
    rows = []
    for name in dict.fromkeys([*before, *after]):
        old, new = before.get(name), after.get(name)
        change = None
        if old and new and old.get("value") and usable(new.get("value")):
            change = 100.0 * (new["value"] - old["value"]) / abs(old["value"])
        last = new or old or {}
        rows.append(
            {
                "name": name,
                "before": old,
                "after": new,
                "last": last,
                "change": change,
                "doubts": doubts(last),
            }
        )
    return rows


def ranking(diagnosis: Record, key: str) -> dict[str, Any]:
    """Candidates in the order of their error on the training runs, and the marks beside it.

    Those that were not fitted, and have no such error, are apart. `closest` is the first set in
    the order of the diagnosis where nothing was added. `margin` is an error over the smallest.
    `clipped`: some error lies beyond the right end of the axis.
    """
    marks = {s: error_of(diagnosis, "train", s).get(key) for s in ("before", "noise_floor")}
    rows = [dict(candidate) for candidate in diagnosis.get("ranking") or []]
    fitted = [row for row in rows if usable(row.get("train_error_after"))]
    unexplained = diagnosis["verdict"] == "unexplained"
    sets = [row for row in fitted if not row.get("structure")]
    closest = sets[0] if unexplained and sets else None
    fitted.sort(key=lambda row: row["train_error_after"])
    errors = [row["train_error_after"] for row in fitted]
    # a refit that ran away must not squeeze all others into a corner
    ceiling = 4.0 * max([mark for mark in marks.values() if usable(mark)], default=math.inf)
    axis = log_axis([*marks.values(), *[e for e in errors if e < ceiling]])
    for row, error in zip(fitted, errors, strict=True):
        row["place"] = axis.place(error)
        row["margin"] = error / errors[0] if errors[0] else None
    return {
        "rows": fitted,
        "unfitted": [row for row in rows if not usable(row.get("train_error_after"))],
        "closest": closest,
        "clipped": any(row["place"] == 100.0 for row in fitted),
        "place": {stage: axis.place(mark) for stage, mark in marks.items()},
    }
