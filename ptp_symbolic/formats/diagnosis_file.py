"""The JSON Schema of `diagnosis.json`."""

from ptp_symbolic.formats.json_schema import (
    DRAFT,
    NUMBER,
    TEXT,
    TRUTH,
    WHOLE,
    Schema,
    list_of,
    one_of,
    or_none,
    record,
    said,
    table_of,
)
from ptp_symbolic.numeric.diagnose.verdict import (
    EXPLAINED,
    NOTHING_MISSING,
    PARTLY,
    UNEXPLAINED,
    UP_TO_GROUP,
)
from ptp_symbolic.platform import AXES
from ptp_symbolic.workflows.result import SCHEMA_VERSION

VERDICTS = (NOTHING_MISSING, EXPLAINED, UP_TO_GROUP, PARTLY, UNEXPLAINED)
AXIS = or_none(one_of(AXES), "The axis; null for an effect of the whole platform.")
INTERVAL = list_of(or_none(NUMBER), "95 % interval; null where an end is not known.", 2)
GAIN = record(
    {"share": NUMBER, "ci95": INTERVAL},
    description="Predictive gain: the share by which the squared error on blocks left out falls.",
)
VALUE = record({"value": NUMBER, "ci95": INTERVAL, "unit": TEXT})
ERROR = {
    "rmse_counts": or_none(NUMBER, "Root mean square in encoder counts."),
    "rmse": said(NUMBER, "Root mean square in the unit of the signal."),
    "relative_l2": said(NUMBER, "Norm of the residual over the norm of what was measured."),
    "fit_percent": said(NUMBER, "100 (1 - norm of residual / norm of measured minus mean)."),
}
FITTED = record(
    {
        "value": NUMBER,
        "ci95": INTERVAL,
        "unit": TEXT,
        "meaning": TEXT,
        "start": or_none(NUMBER, "The declared value; null for what was added."),
        "at_bound": said(TRUTH, "Whether the fit ended on a bound."),
        "identified": said(TRUTH, "Whether the logs determine the value."),
        "only_with": list_of(TEXT, "Parameters together with which alone it is determined."),
    }
)


def diagnosis_schema() -> Schema:
    """The schema of the data that `diagnose` writes."""
    entries = {
        "schema_version": {"const": SCHEMA_VERSION},
        "platform": record({"name": TEXT, "title": TEXT}),
        "verdict": one_of(VERDICTS, "The answer."),
        "summary": said(TEXT, "The answer in one or two sentences."),
        "fitted_to": one_of(
            ("outputs", "torques"), "What values and intervals belong to: simulation or regression."
        ),
        "added": list_of(_added(), "The effects that were named."),
        "ranking": list_of(
            _row(), "Structures, then sets, the best first; then what was not tried."
        ),
        "error": record({"definition": TEXT, "train": _part(), "validate": _part()}),
        "repeatability": or_none(_repeatability(), "How well runs with equal inputs agree."),
        "residual_tests": list_of(_test(), "Whiteness and independence of the residuals."),
        "fit": record({when: _fit() for when in ("before", "after")}),
        "held_out": or_none(GAIN),
        "why": list_of(_reason(), "The rules that are numbers: gains, and what remains."),
        "refused": table_of(TEXT, "What explained a part and was not named, with the reason."),
        "remainder": or_none(_remainder(), "What the residual torque depends on."),
        "hints": list_of(TEXT, "What remains, in words, and what was not tried."),
        "black_box": or_none({"type": "object"}, "Models without physics, beside."),
        "windows": or_none(_windows(), "The windows into which runs were cut."),
        "material": said(
            NUMBER,
            "Share of the sum of squares that an effect reduces at least.",
        ),
        "remarks": list_of(TEXT, "What to know about logs and platform."),
        "equations": list_of(_equation(), "The equations that the named effects change."),
        "provenance": _provenance(),
    }
    return {
        "$schema": DRAFT,
        "title": "Diagnosis of ptp-symbolic",
        **record(entries, description="What `ptp-symbolic diagnose` found."),
    }


def _added() -> Schema:
    return record(
        {
            "effect": TEXT,
            "title": TEXT,
            "axis": AXIS,
            "parameters": table_of(VALUE),
            "gain": GAIN,
            "confusable_with": list_of(TEXT, "What these logs cannot tell it from."),
            "separating_experiment": TEXT,
        }
    )


def _reason() -> Schema:
    entries = {
        "about": or_none(TEXT, "The effect that was asked about; null for the whole model."),
        "rule": said(TEXT, "What is compared."),
        "value": or_none(NUMBER, "The number that these logs give."),
        "at_least": said(NUMBER, "The least that it has to be."),
        "at_most": said(NUMBER, "The most that it may be."),
        "holds": TRUTH,
    }
    return record(entries, optional=("at_least", "at_most"))


def _row() -> Schema:
    entries = {
        "effect": TEXT,
        "title": said(TEXT, "What a structure is called: the kinds of one effect differ in it."),
        "axis": AXIS,
        "structure": list_of(TEXT, "The structures of the platform that it was added to."),
        "gain": or_none(GAIN),
        "gain_along_motion": or_none(GAIN),
        "train_error_after": or_none(NUMBER),
        "parameters": table_of(record({"value": NUMBER, "unit": TEXT})),
        "accepted": TRUTH,
        "why": said(TEXT, "Why it was accepted or not."),
    }
    return record(entries, optional=("title", "gain_along_motion"))


def _part() -> Schema:
    return record({when: _errors() for when in ("before", "after", "noise_floor")})


def _errors() -> Schema:
    signal = record({"rmse": NUMBER, "unit": TEXT, "rmse_counts": or_none(NUMBER)})
    without = record({"run": TEXT, **ERROR, "unit": TEXT})
    return record(
        {
            "total": record({**ERROR, "unit": TEXT}),
            "by_run": table_of(record(ERROR)),
            "by_signal": table_of(signal),
            "without": or_none(without, "The error without the run that holds most of it."),
            "windows": or_none(_windows()),
        }
    )


def _windows() -> Schema:
    return record({"count": WHOLE, "seconds": said(NUMBER, "Their mean length.")})


def _repeatability() -> Schema:
    signal = record({"rmse": NUMBER, "unit": TEXT, "rmse_counts": or_none(NUMBER)})
    return record({"runs": list_of(list_of(TEXT)), "by_signal": table_of(signal)})


def _test() -> Schema:
    return record(
        {
            "name": TEXT,
            "signal": TEXT,
            "statistic": NUMBER,
            "threshold": NUMBER,
            "passed": TRUTH,
            "meaning": TEXT,
        }
    )


def _fit() -> Schema:
    return record({"parameters": table_of(FITTED)})


def _remainder() -> Schema:
    numbers = list_of(or_none(NUMBER))
    against = {"axis": one_of(AXES), "against": TEXT, "unit": TEXT}
    share = said(NUMBER, "Share of the variance of the residual torque.")
    bins = {"at": numbers, "mean": numbers, "error": numbers, "share": share}
    return record(
        {
            "unit": one_of(("N m", "N")),
            "maps": list_of(record({**against, **bins}), "Means over a variable, in bins."),
            "lines": list_of(
                record({**against, "frequency": NUMBER, "share": share}), "Spectral lines."
            ),
        }
    )


def _equation() -> Schema:
    texts = {name: TEXT for name in ("title", "effect", "latex", "text", "mathml")}
    return record({**texts, "detail": said(TRUTH, "Whether a reader may skip it.")})


def _provenance() -> Schema:
    file = {"file": TEXT, "sha256": TEXT}
    clock = {"samples": WHOLE, "duration": NUMBER, "rate": NUMBER}
    log = record({"part": one_of(("train", "validate")), **file, **clock})
    return record(
        {
            "version": TEXT,
            "date": TEXT,
            "command": or_none(TEXT),
            "platform": or_none(record(file)),
            "logs": list_of(log),
        }
    )
