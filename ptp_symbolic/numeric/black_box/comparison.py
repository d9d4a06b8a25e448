"""Named effects beside rivals without physics, on runs that none of them was fitted to."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from ptp_symbolic.numeric.black_box.free_motion import FreeRuns, free_error
from ptp_symbolic.numeric.black_box.learners import (
    AxisRows,
    Learned,
    Values,
    axis_rows,
    neural_network,
    space_along,
    sparse_regression,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]

RIVALS = {"sparse": sparse_regression, "network": neural_network}
FEWEST = 50  # rows of an axis, in the training and in the validation runs


def black_box(
    space: EquationSpace,
    train: Sequence[Run],
    validate: Sequence[Run],
    declared: Values,
    named: Values | None,
    size: str,
    free: FreeRuns,
) -> dict[str, Any]:
    """The torque that the declared model lacks along the measured motion, axis by axis: how much of
    it the named effects and the rivals explain, and how far off the rivals are in `free` simulation
    with their torque on the joints; as plain data.

    `declared` and `named` are the values of all parameters before and after (None: nothing was
    named), `size` says how many parameters the named effects have. The rivals learn from the rows
    of the whole `train` runs; `validate` judges all.
    """
    after = declared if named is None else named
    spaces = [space_along(space, runs, declared, after) for runs in (train, validate)]
    found, learned = {}, {}
    for axis, name in enumerate(space.model.module.AXES):
        fitted, judging = (axis_rows(part, axis, declared, after) for part in spaces)
        if min(len(fitted.run), len(judging.run)) < FEWEST:
            continue
        names = [run.name for run in validate]
        learned[name] = learn(fitted)
        found[name] = {
            "unit": "N" if space.model.is_linear(name) else "N m",
            "seen": _seen(fitted),
            "rows": {"train": len(fitted.run), "validate": len(judging.run)},
            **compared(fitted, judging, names, None if named is None else size, learned[name]),
        }
    freely = {
        rival: free_error(free, {axis: own[rival].torque for axis, own in learned.items()})
        for rival in RIVALS
        if learned
    }
    return {"half_width": space.half_width, "axes": found, "free": freely}


def learn(train: AxisRows) -> dict[str, Learned]:
    """The rivals of one axis, by name."""
    with threadpool_limits(limits=1):  # matrices are small: more threads would wait for each other
        return {name: rival(train) for name, rival in RIVALS.items()}


def compared(
    train: AxisRows,
    validate: AxisRows,
    runs: Sequence[str],
    size: str | None,
    learned: Mapping[str, Learned],
) -> dict[str, Any]:
    """The residual torque of every model on the rows of one axis; `runs` are the names of the
    validation runs, `size` is that of the named effects (None: there are none).
    """
    models = {
        "declared": (None, train.declared, validate.declared),
        "named": (size, train.named, validate.named),
        **{name: (own.size, *_left(train, validate, own)) for name, own in learned.items()},
    }
    if size is None:
        del models["named"]
    return {
        "models": {
            key: {
                "size": size,
                "train": _figures(left, train.declared),
                "validate": _figures(judged, validate.declared),
                "by_run": {
                    runs[k]: _rms(judged[validate.run == k]) for k in np.unique(validate.run)
                },
            }
            for key, (size, left, judged) in models.items()
        },
        "terms": learned["sparse"].terms,
    }


def _seen(rows: AxisRows) -> dict[str, dict[str, float]]:
    """Mean and deviation in SI by which what is seen is centred and scaled."""
    centre, scale = rows.seen.mean(axis=0), rows.seen.std(axis=0)
    return {
        name: {"mean": float(c), "deviation": float(s)}
        for name, c, s in zip(rows.names, centre, scale, strict=True)
    }


def _left(train: AxisRows, validate: AxisRows, learned: Learned) -> tuple[FloatArray, FloatArray]:
    left = [r.declared - learned.torque(r.seen) for r in (train, validate)]
    return left[0], left[1]


def _figures(left: FloatArray, declared: FloatArray) -> dict[str, float]:
    """Rms of what is left, and the share of the declared model's mean square that is explained."""
    whole = float(declared @ declared)
    return {"rms": _rms(left), "share": 1.0 - float(left @ left) / whole if whole else 0.0}


def _rms(left: FloatArray) -> float:
    return float(np.sqrt(np.mean(left**2)))
