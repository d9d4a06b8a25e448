"""Inverse dynamics: the torques on the joints that a prescribed motion takes."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError, wrong_type
from ptp_symbolic.models.committed import declared_platform
from ptp_symbolic.models.variants import torque_driven
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import ParameterDeclaration, Platform
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import refuse_undeclared
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import real

FloatArray = NDArray[np.float64]
Torques = Callable[..., Sequence[FloatArray]]


@dataclass(frozen=True, eq=False)
class Motion:
    """Angles [k, n] in rad, rates in rad/s and accelerations in rad/s^2 of the n joints.

    `times` [k] in s matter on a base that moves; left out, all are zero.
    """

    angles: ArrayLike
    rates: ArrayLike
    accelerations: ArrayLike
    times: ArrayLike | None = None

    def arrays(self, axes: tuple[str, ...]) -> tuple[FloatArray, ...]:
        """Angles, rates, accelerations [k, n] and times [k] as checked arrays.

        Raises InputError for shapes that differ and values that are not finite.
        """
        named = {n: numbers_of(getattr(self, n), n) for n in ("angles", "rates", "accelerations")}
        for name, array in named.items():
            if array.ndim != 2 or array.shape[1] != len(axes) or len(array) != len(named["angles"]):
                raise InputError(
                    f"Motion: {name} have shape {array.shape}; give [k, {len(axes)}], a column for"
                    f" each of {', '.join(axes)}."
                )
        count = len(named["angles"])
        times = np.zeros(count) if self.times is None else numbers_of(self.times, "times")
        if times.shape != (count,):
            raise InputError(f"Motion: times have shape {times.shape}; give [{count}].")
        for name, array in (*named.items(), ("times", times)):
            if not np.all(np.isfinite(array)):
                raise InputError(f"Motion: {name} are not all finite; remove what is not.")
        return (*named.values(), times)


def numbers_of(given: ArrayLike, what: str) -> FloatArray:
    """What is `given` for a part of a motion, as an array; raises InputError for no numbers."""
    try:
        return np.array(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"Motion: {what} are no array of numbers ({error}); give one.") from error


def inverse_dynamics(
    machine: Model | Platform | str | Path,
    motion: Motion | tuple[ArrayLike, ...],
    parameters: Mapping[str, float] | None = None,
) -> FloatArray:
    """Return the torques [k, n] in N m on the joints that make `machine` follow `motion`.

    `machine` is a platform, the name of a model or a preset, or the path of a platform file; its
    motors and shafts are left out. `motion` is a `Motion`, or angles, rates and accelerations. Dry
    friction acts against the rate, and where that is zero against the acceleration; at rest it is
    left out, as any torque up to breakaway holds. States of effects keep their initial values.
    Raises InputError for a motion or parameters that do not fit, and where a platform leaves out a
    parameter without a natural default.
    Source: Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation, 1994,
    Eq. 4.24.

    >>> import ptp_symbolic as ptp
    >>> ptp.inverse_dynamics("ideal", ([[0.0, 0.0]], [[0.0, 2.0]], [[0.0, 0.0]]))
    array([[0. , 0.2]])
    """
    platform = _with_values(_platform(machine), parameters or {})
    if isinstance(machine, Platform):
        refuse_undeclared(torque_driven(platform))
    axes, forward, backward = _compiled(platform)
    angles, rates, accelerations, times = _motion(motion).arrays(axes)
    directions = np.where(rates != 0.0, np.sign(rates), np.sign(accelerations))
    columns = (*angles.T, *rates.T, *accelerations.T, *directions.T, times)
    found = []
    for plus, minus in zip(forward(*columns), backward(*columns), strict=True):
        found.append(np.broadcast_to(np.where(plus >= 0.0, plus, minus), times.shape))
    return np.column_stack(found)


@lru_cache(maxsize=16)
def _compiled(platform: Platform) -> tuple[tuple[str, ...], Torques, Torques]:
    """The axes of `platform`, and the torques on its joints where they push forwards, and
    backwards; derived once.
    """
    equations = assemble(torque_driven(platform))
    refuse_impossible(equations, platform)
    wanted = [real(f"alpha_{axis}") for axis in equations.axes]
    sliding = [slide(axis) for axis in equations.axes]
    arguments = [*equations.coordinates, *equations.rates, *wanted, *sliding, kinematics.TIME]
    forward, backward = (
        sp.lambdify(arguments, _torques(equations, wanted, sign), "numpy", cse=True)
        for sign in (1, -1)
    )
    return equations.axes, forward, backward


def _motion(given: Motion | tuple[ArrayLike, ...]) -> Motion:
    if isinstance(given, Motion):
        return given
    if not isinstance(given, list | tuple):
        raise wrong_type("A motion", given, "angles, rates and accelerations [k, n], or a Motion")
    if not 3 <= len(given) <= 4:
        raise InputError(
            f"Motion: {len(given)} arrays; give angles, rates and accelerations, and times if any."
        )
    return Motion(*given)


def _torques(equations: Equations, wanted: list[sp.Symbol], sign: int) -> list[sp.Expr]:
    """Joint torques, taken to have this `sign`, as functions of the motion alone, at the declared
    parameters.

    Friction may grow with the size of the torque that it adds to: linear in it, once its sign is
    known. It grows by less than the torque, so that one of both signs comes out as it was taken.
    """
    lacking = sp.Matrix(equations.mass_matrix * sp.Matrix(wanted) - equations.forcing)
    for friction in equations.frictions:
        lacking[equations.rates.index(friction.rate)] += slide(friction.axis) * friction.level
    known = {p.symbol: sp.Float(p.default, 17) for p in equations.parameters}
    known |= {s.symbol: sp.Float(s.initial) for s in equations.extra_states}
    torques = [kinematics.torque(axis) for axis in equations.axes]
    known |= {i.symbol: sp.Float(0) for i in equations.inputs if i.symbol not in torques}
    sizes = {sp.Abs(torque): sign * torque for torque in torques}
    found = []
    for torque, row in zip(torques, lacking, strict=True):
        taken = equations.written_out(row).xreplace(known).xreplace(sizes)
        slope = sp.diff(taken, torque)
        found.append(-taken.xreplace({torque: sp.Float(0)}) / slope)
    return found


def _platform(machine: Model | Platform | str | Path) -> Platform:
    if isinstance(machine, Platform):
        return machine
    if not isinstance(machine, Model):
        return declared_platform(machine)
    if machine.platform is None:
        raise InputError(f"Model '{machine.name}' does not know its platform; give that instead.")
    return machine.platform


def _with_values(platform: Platform, values: Mapping[str, float]) -> Platform:
    kept = tuple(p for p in platform.parameters if p.name not in values)
    given = tuple(ParameterDeclaration(n, None, float(v)) for n, v in values.items())
    return replace(platform, parameters=(*kept, *given))
