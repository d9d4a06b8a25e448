"""Friction laws of a geared servo, each with one part more, fitted and simulated freely.

The ladder of Duclusaud et al. (ICRA 2025), models M1 to M6: Coulomb and viscous friction; a static
part that falls off with the rate (Stribeck); friction that grows with the difference of the torques
of motor and load, without and with the static part; with factors of their own for the two; with
squares of them at rest. The exponent of the Stribeck curve is fixed at 2 here; they fit it. The
measure is theirs: the mean absolute error of the position in free simulation.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.data import read_logs
from ptp_symbolic.numeric.identify.fit import fit_parameters
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform
from ptp_symbolic.symbolic.effects.directional_load_friction import DIRECTIONAL_LOAD_FRICTION
from ptp_symbolic.workflows.fit import fit_platform
from ptp_symbolic.workflows.result import Progress

AXIS = "tilt"
LOAD = EffectDeclaration(DIRECTIONAL_LOAD_FRICTION.id, AXIS, None)
FACTORS = ("mu_motor", "mu_outer")
AT_REST = ("mu_motor_rest", "mu_outer_rest")
SQUARES = ("q_motor_rest", "q_outer_rest")
ONE, ONE_AT_REST = {"mu_outer": "mu_motor"}, {"mu_outer_rest": "mu_motor_rest"}
START = {p.at_axis(AXIS).name: p.starts[0] for p in DIRECTIONAL_LOAD_FRICTION.parameters}


@dataclass(frozen=True)
class Rung:
    """A friction law: whether it has a static part, and which factors of load are free in it; a
    factor in `tied` is that of another one.
    """

    title: str
    static: bool
    free: tuple[str, ...] = ()
    tied: Mapping[str, str] = field(default_factory=dict)


RUNGS = (
    Rung("M1: Coulomb, viscous", static=False),
    Rung("M2: with Stribeck curve", static=True),
    Rung("M3: M1 with friction by load", False, ("mu_motor",), ONE),
    Rung("M4: M3 with Stribeck curve", True, ("mu_motor", "mu_motor_rest"), ONE | ONE_AT_REST),
    Rung("M5: M4 with motor and load apart", True, (*FACTORS, *AT_REST)),
    Rung("M6: M5 with squares at rest", True, (*FACTORS, *AT_REST, *SQUARES)),
)


def platform_of(platform: Platform, rung: Rung) -> Platform:
    """`platform`, which declares `csvs_friction` on its axis, with the friction of a rung."""
    factors = [_factor(name, None) for name in rung.free]
    factors += [_factor(name, other) for name, other in rung.tied.items()]
    begun = variants.extended(platform, (LOAD,) if factors else (), {}, factors)
    if rung.static:
        return begun
    tied = {f"F_s_{AXIS}": f"F_c_{AXIS}", f"v_s_{AXIS}": None}
    parameters = tuple(
        replace(p, free=False, same_as=tied[p.name]) if p.name in tied else p
        for p in begun.parameters
    )
    return replace(begun, parameters=parameters)


def _factor(name: str, same_as: str | None) -> ParameterDeclaration:
    """A factor of load, free unless it is that of another one."""
    own, other = f"{name}_{AXIS}", None if same_as is None else f"{same_as}_{AXIS}"
    return ParameterDeclaration(own, None, START[own], free=same_as is None, same_as=other)


def ladder(
    platform: Platform, train: Sequence[Path], validate: Sequence[Path], progress: Progress
) -> list[dict[str, Any]]:
    """Every rung fitted to `train`: the mean absolute error of its position in free simulation of
    either part, in rad; nothing but the state at the start of a run is fitted to `validate`.
    """
    rows = []
    for rung in RUNGS:
        progress(f"friction of the servo: {rung.title}")
        declared = platform_of(platform, rung)
        found = fit_platform(declared, train).summary["parameters"]
        values = {name: row["value"] for name, row in found.items()}
        errors = [mean_error(declared, values, part) for part in (train, validate)]
        rows.append({"law": rung.title, "train": errors[0], "validate": errors[1]})
    return rows


def mean_error(platform: Platform, values: dict[str, float], paths: Sequence[Path]) -> float:
    """Mean absolute error in rad of the angle, simulated freely over whole runs with `values`."""
    model = emission.emit(platform)
    runs = prepare_runs(model, platform, read_logs(paths, platform))
    declared = {p.name: p.value for p in platform.parameters}
    tied = {p.name: values[p.same_as] for p in platform.parameters if p.same_as in values}
    fit = fit_parameters(model, runs, (), {**model.defaults, **declared, **values, **tied})
    errors = [np.abs(e.residual.reshape(run.measured.shape) / run.weight) for run, e in fit.pairs()]
    return float(np.mean(np.concatenate(errors)))
