"""A made-up diagnosis and its curves, for every verdict, as the report receives them."""

import math
from functools import cache
from typing import Any

import numpy as np

from ptp_symbolic.report.diagnosis import render_diagnosis

COUNT = 2.0 * math.pi / 7200.0
FLOOR = 0.289
RUNS = {
    "ramp": "train",
    "sine": "train",
    "trapezoid": "train",
    "sweep": "validate",
    "step": "validate",
}


def synthetic_curves(
    samples: int = 1200, after: bool = True, current: bool = True, drift_counts: float = 40.0
) -> dict[str, Any]:
    """Runs of a pan axis whose declared model drifts off by an angle-dependent amount."""
    generator = np.random.default_rng(7)
    curves: dict[str, Any] = {}
    for index, (run, set_name) in enumerate(RUNS.items()):
        time = np.arange(samples) * 0.005
        frequency = 2.0 * math.pi * (0.25 + 0.1 * index)
        angle = 1.5 * np.sin(frequency * time) * (1.0 - np.exp(-time))
        rate = np.gradient(angle, time)
        drift = drift_counts * COUNT * np.sin(angle - 0.8) * np.minimum(time, 2.0)
        measured = np.round((angle + 1e-5 * generator.normal(size=samples)) / COUNT) * COUNT
        signals = {
            "theta_pan": {
                "unit": "rad",
                "measured": measured,
                "before": angle - drift,
                "after": angle if after else None,
                "counts": COUNT,
            }
        }
        if current:
            amperes = 0.4 * np.cos(frequency * time)
            signals["i_pan"] = {
                "unit": "A",
                "measured": amperes + 0.004 * generator.normal(size=samples),
                "before": amperes * 1.05,
                "after": amperes if after else None,
                "counts": None,
            }
        curves[run] = {
            "set": set_name,
            "time": time,
            "signals": signals,
            "angle": {"pan": angle},
            "rate": {"pan": rate},
        }
    return curves


def metrics(counts: float) -> dict[str, float]:
    return {
        "rmse_counts": counts,
        "rmse": counts * COUNT,
        "relative_l2": counts / 1000.0,
        "fit_percent": 100.0 - counts / 10.0,
    }


def signal_errors(counts: float) -> dict[str, Any]:
    return {
        "theta_pan": {"rmse": counts * COUNT, "unit": "rad", "rmse_counts": counts},
        "i_pan": {"rmse": 0.0137 * counts, "unit": "A", "rmse_counts": None},
    }


def errors(counts: float, after: float) -> dict[str, Any]:
    found: dict[str, Any] = {"definition": "root mean square over all samples"}
    for name in ("train", "validate"):
        runs = [run for run, set_name in RUNS.items() if set_name == name]
        found[name] = {
            stage: {
                "total": metrics(value),
                "by_run": {run: metrics(value * (1.0 + 0.2 * k)) for k, run in enumerate(runs)},
                "by_signal": signal_errors(value),
            }
            for stage, value in (("before", counts), ("after", after), ("noise_floor", FLOOR))
        }
    return found


def quantity(value: float, half: float, unit: str, **more: Any) -> dict[str, Any]:
    return {"value": value, "ci95": [value - half, value + half], "unit": unit, **more}


ADDED: dict[str, Any] = {
    "effect": "base_tilt",
    "title": "base that is not level",
    "axis": None,
    "parameters": {
        "beta_base": quantity(0.08731, 0.00032, "rad"),
        "alpha_base": quantity(0.8021, 0.0041, "rad"),
    },
    "gain": {"share": 0.9873, "ci95": [0.9851, 0.9894]},
    "confusable_with": [],
    "separating_experiment": "Sweep the pan axis over a full turn.",
}
REFUSED = {
    "gear_eccentricity@pan": "reduces the sum of squares by 3 % only",
    "encoder_quantization": "the validation runs are predicted no better with it",
}
EQUATION = {
    "title": "Gravity torque about the pan axis",
    "effect": "base_tilt",
    "latex": r"\tau = -m g c \sin\beta \sin(\theta_{pan} - \alpha)",
    "text": "τ = −m g c sin β sin(θ_pan − α)",
    "mathml": "<mrow><mi>τ</mi><mo>=</mo><mo>-</mo><mi>m</mi><mo>&InvisibleTimes;</mo><mi>g</mi>"
    "<mi>c</mi><mi>sin</mi><mo>(</mo><mi>β</mi><mo>)</mo><mi>sin</mi><mrow><mo>(</mo><msub><mi>θ</mi>"
    "<mi>pan</mi></msub><mo>-</mo><mi>α</mi><mo>)</mo></mrow></mrow>",
}


def ranking(winner: str | None, best: float) -> list[dict[str, Any]]:
    """The best fit first, as the search ranks it; by error the second one comes later."""
    tried = (
        ("base_tilt", best, 0.9873),
        ("constant_torque", 22.4, 0.41),
        ("cable_spring", 1.89, 0.92),
        ("direction_dependent_friction", 27.3, 0.08),
        ("payload_com_offset", 29.79, -0.002),
        ("backlash", None, None),
        ("shaft_compliance", 29.8, None),
        ("viscous_friction", 9e6, None),
    )
    return [
        {
            "effect": effect,
            "axis": None if effect == "base_tilt" else "pan",
            "gain": None if share is None else gain(share, 0.0022),
            "train_error_after": train,
            "parameters": ADDED["parameters"]
            if effect == "base_tilt"
            else {"k": {"value": 0.3, "unit": "N m/rad"}},
            "accepted": effect == winner,
            "why": "every effect in it is significant" if effect == winner else "predicts worse",
        }
        for effect, train, share in tried
    ]


def gain(share: float, half: float) -> dict[str, Any]:
    return {"share": share, "ci95": [share - half, share + half]}


def synthetic_diagnosis(verdict: str) -> dict[str, Any]:
    added = [] if verdict in ("nothing_missing", "unexplained") else [ADDED]
    before = 0.291 if verdict == "nothing_missing" else 29.8
    after = {"partly_explained": 7.4}.get(verdict, 0.292) if added else before
    if verdict == "explained_up_to_group":
        added = [{**ADDED, "confusable_with": ["cable_spring@pan", "constant_torque@tilt"]}]
    parameters = {
        "J_pan": quantity(
            0.0912,
            0.0011,
            "kg m^2",
            start=0.1,
            at_bound=False,
            identified=True,
            meaning="inertia of the pan body",
        ),
        "F_s_pan": quantity(0.0, 0.02, "N m", start=0.675, at_bound=True, identified=True),
        "d_shaft_pan": quantity(3.1, math.nan, "N m s/rad", start=1.0, identified=False),
    }
    moved = quantity(0.0999, 0.0006, "kg m^2", start=0.1, meaning="inertia of the pan body")
    new = {"J_pan": moved, **ADDED["parameters"]} if added else {}
    fit = {"before": {"parameters": parameters}, "after": {"parameters": {**parameters, **new}}}
    return {
        "schema_version": 1,
        "platform": {"name": "fieldlog_pan", "title": "Pan axis of the field logs, PWM drive"},
        "verdict": verdict,
        "summary": "On 2 validation runs the error was compared with the noise floor.",
        "added": added,
        "ranking": ranking("base_tilt" if added else None, after),
        "error": errors(before, after),
        "residual_tests": [
            {
                "name": "whiteness",
                "signal": "theta_pan",
                "statistic": 1.2,
                "threshold": 2.6,
                "passed": True,
                "meaning": "the residual does not repeat itself",
            },
            {
                "name": "independence of the angle",
                "signal": "theta_pan",
                "statistic": 9.9,
                "threshold": 2.6,
                "passed": False,
                "meaning": "the residual depends on the angle",
            },
        ],
        "fit": fit,
        "held_out": gain(0.975, 0.004) if added else None,
        "why": WHY if added else [],
        "refused": {} if verdict == "nothing_missing" else REFUSED,
        "windows": None,
        "material": 0.05,
        "remarks": [],
        "hints": ["The residual repeats once per turn."] if verdict == "unexplained" else [],
        "remainder": REMAINDER if verdict in ("unexplained", "partly_explained") else None,
        "equations": [EQUATION] if added else [],
        "runtime_seconds": 41.7,
    }


WHY = [
    {
        "about": "base_tilt",
        "rule": "lower end of the 95 % interval of that share",
        "value": 0.9713,
        "at_least": 0.5,
        "holds": True,
    },
    {
        "about": None,
        "rule": "residual of theta_pan on the validation runs, over the largest of noise",
        "value": 1.374,
        "at_most": 1.1,
        "holds": False,
    },
]
REMAINDER = {
    "unit": "N m",
    "maps": [
        {
            "axis": "pan",
            "against": side,
            "unit": unit,
            "at": [-1.0, 0.0, 1.0],
            "mean": [-0.4, 0.1, 0.3],
            "error": [0.05, 0.04, 0.05],
            "share": share,
        }
        for side, unit, share in (("angle", "rad", 0.62), ("rate", "rad/s", 0.03))
    ],
    "lines": [
        {"axis": "pan", "against": "angle", "unit": "1/turn", "frequency": 3.0, "share": 0.5}
    ],
}


@cache
def page(verdict: str, samples: int = 600, current: bool = True) -> str:
    diagnosis = synthetic_diagnosis(verdict)
    drift = 0.0 if verdict == "nothing_missing" else 40.0
    curves = synthetic_curves(samples, current=current, drift_counts=drift)
    return render_diagnosis(diagnosis, curves)
