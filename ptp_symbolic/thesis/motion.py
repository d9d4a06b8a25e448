"""The motion profiles of chapter 5 and the joint torques that they need."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from ptp_symbolic.numeric.simulation.inputs import InputSignal, cubic_transition
from ptp_symbolic.platform import AXES, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import real
from ptp_symbolic.thesis.printed import Transition

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Motion:
    """Angle in rad, rate in rad/s and acceleration in rad/s^2 of one joint, each [k]."""

    angle: FloatArray
    rate: FloatArray
    acceleration: FloatArray


@dataclass(frozen=True, eq=False)
class Torques:
    """Joint torques in N m, each [k], at times t [k] in s, with the motion that needs them."""

    t: FloatArray
    pan: FloatArray
    tilt: FloatArray
    motion: Mapping[str, Motion]


def along(times: FloatArray, transition: Transition) -> Motion:
    """The motion whose rate makes one cubic transition; the angle starts at zero."""
    given = cubic_transition(transition.start, transition.end, transition.t0, transition.t1)
    return moving(times, given)


def moving(times: FloatArray, rate: InputSignal, start: float = 0.0) -> Motion:
    """The motion whose rate is a signal without sines, from angle `start` in rad at times[0]."""
    ends = [min(times[0], rate.breaks[0]) - 1.0, *rate.breaks]
    ends.append(max(times[-1], rate.breaks[-1]) + 1.0)
    first = rate.coefficients[0, 0]
    last = np.polyval(rate.coefficients[-1, ::-1], rate.breaks[-1] - rate.breaks[-2])
    pieces = [[first, 0.0, 0.0, 0.0], *rate.coefficients, [last, 0.0, 0.0, 0.0]]
    curve = PPoly(np.array(pieces).T[::-1], np.array(ends))
    whole = curve.antiderivative()
    return Motion(start + whole(times) - whole(times[0]), curve(times), curve.derivative()(times))


def at_rest(times: FloatArray, angle: float) -> Motion:
    """A joint that is fixed at `angle` in rad."""
    still = np.zeros_like(times)
    return Motion(still + angle, still, still)


def needed_torques(
    platform: Platform,
    times: FloatArray,
    motion: Mapping[str, Motion],
    values: Mapping[str, float] | None = None,
) -> Torques:
    """Inverse dynamics: the joint torques that make a torque-driven `platform` follow `motion`.

    `values` replaces parameters of the platform, SI.
    """
    equations = assemble(platform)
    accelerations = sp.Matrix([sp.Symbol(f"acceleration_{axis}") for axis in AXES])
    torques = {kinematics.torque(axis): 0 for axis in AXES}
    needed = equations.mass_matrix * accelerations - equations.forcing.xreplace(torques)
    numbers = {p.name: p.default for p in equations.parameters} | dict(values or {})
    needed = needed.subs({real(name): value for name, value in numbers.items()})
    arguments = [*map(kinematics.angle, AXES), *map(kinematics.rate, AXES), *accelerations]
    function = sp.lambdify(arguments, list(needed), modules="numpy")
    moves = [motion[axis] for axis in AXES]
    pan, tilt = function(
        *(m.angle for m in moves), *(m.rate for m in moves), *(m.acceleration for m in moves)
    )
    shape = np.zeros_like(times)
    return Torques(times, pan + shape, tilt + shape, motion)
