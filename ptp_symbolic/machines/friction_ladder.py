"""Friction laws of a geared servo, each with one part more, fitted and simulated freely.

After the ladder of Duclusaud et al. (ICRA 2025): Coulomb and viscous friction; a static part that
falls off with the rate (Stribeck); friction that grows with the load, without and with the static
part; at last friction that differs by direction. Their last two rungs tell the torque of the motor
from that of the load, which no effect here does. The measure is theirs: the mean absolute error of
the position in free simulation.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.data import read_logs
from ptp_symbolic.numeric.identify.fit import fit_parameters
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform
from ptp_symbolic.workflows.fit import fit_platform
from ptp_symbolic.workflows.result import Progress

AXIS = "tilt"
LOAD = EffectDeclaration("load_dependent_friction", AXIS, None)
DIRECTION = EffectDeclaration("direction_dependent_friction", AXIS, None)
LOAD_START = ParameterDeclaration("mu_load_tilt", "1", 0.1, True, 0.0, 0.9)
BY_DIRECTION = tuple(
    ParameterDeclaration(f"a_{name}_tilt", "1", 0.0, True, -0.9, 0.9) for name in ("F_c", "F_v")
)


@dataclass(frozen=True)
class Rung:
    """A friction law beyond Coulomb and viscous friction."""

    title: str
    static: bool
    effects: tuple[EffectDeclaration, ...] = ()
    parameters: tuple[ParameterDeclaration, ...] = ()


RUNGS = (
    Rung("Coulomb, viscous", static=False),
    Rung("Coulomb, viscous, Stribeck", static=True),
    Rung("Coulomb, viscous, load", False, (LOAD,), (LOAD_START,)),
    Rung("Coulomb, viscous, Stribeck, load", True, (LOAD,), (LOAD_START,)),
    Rung(
        "Coulomb, viscous, Stribeck, load, direction",
        True,
        (LOAD, DIRECTION),
        (LOAD_START, *BY_DIRECTION),
    ),
)


def platform_of(platform: Platform, rung: Rung) -> Platform:
    """`platform`, which declares `csvs_friction` on its axis, with the friction of a rung."""
    begun = variants.extended(platform, rung.effects, {}, rung.parameters)
    if rung.static:
        return begun
    tied = {f"F_s_{AXIS}": f"F_c_{AXIS}", f"v_s_{AXIS}": None}
    parameters = tuple(
        replace(p, free=False, same_as=tied[p.name]) if p.name in tied else p
        for p in begun.parameters
    )
    return replace(begun, parameters=parameters)


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
