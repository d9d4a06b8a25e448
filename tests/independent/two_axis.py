"""Torque-driven platform with set-valued Coulomb friction, built on the independent Newton-Euler.

Each joint sticks, slides forward or slides backward. Between mode changes the motion is smooth and
classical Runge-Kutta takes steps of 0.25 ms; a mode change is located by bisection, so that the
error stays that of the smooth motion. A stuck joint stands exactly still: its friction is whatever
balances it, up to the Coulomb torque.
"""

import itertools
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numba
import numpy as np

from tests.independent import rigid_platform
from tests.independent.rigid_platform import Chain, Floats

STEP = 0.25e-3  # s
DEAD_BAND = 1e-13  # rad/s; rounding right after breakaway must not count as a reversal
EVENT_TOLERANCE = 1e-12  # s
FRICTIONLESS = 1  # the mode of a joint without Coulomb torque, which never changes

_torque = numba.njit(rigid_platform.chain_torque)
_NO_GRAVITY = np.zeros(3)
_MODES = np.array(
    sorted(itertools.product((0, 1, -1), repeat=2), key=lambda mode: np.abs(mode).sum())
)


class TwoAxis(NamedTuple):
    """Links and joint torques: coulomb, k1, k3, theta0, tau0, each [2], SI units."""

    links: Chain
    coulomb: Floats
    k1: Floats
    k3: Floats
    theta0: Floats
    tau0: Floats


def two_axis(parameters: Mapping[str, float]) -> TwoAxis:
    """The platform of `parameters`, named as in the project: F_c_pan, k1_cable_tilt, tau0_pan."""

    def pair(name: str) -> Floats:
        return np.array([float(parameters.get(f"{name}_{axis}", 0.0)) for axis in ("pan", "tilt")])

    return TwoAxis(
        rigid_platform.chain(parameters),
        *(pair(name) for name in ("F_c", "k1_cable", "k3_cable", "theta0_cable", "tau0")),
    )


@numba.njit
def _driving_torque(model: TwoAxis, theta: Floats, omega: Floats, tau: Floats) -> Floats:
    """Torque [2] that is left for friction and inertia, N m."""
    stretch = theta - model.theta0
    bias = _torque(model.links, theta, omega, np.zeros(2))
    passive = model.links.damping * omega + model.k1 * stretch + model.k3 * stretch**3
    return tau + model.tau0 - passive - bias


@numba.njit
def _motion(
    model: TwoAxis, theta: Floats, omega: Floats, tau: Floats, slip: Any
) -> tuple[Floats, Floats]:
    """Accelerations [2] with stuck joints held, and the friction [2] that this takes."""
    links = model.links
    still = Chain(links.axes, links.crosses, links.inertias, _NO_GRAVITY, links.damping)
    mass = np.empty((2, 2))
    for k in range(2):
        unit = np.zeros(2)
        unit[k] = 1.0
        mass[:, k] = _torque(still, theta, np.zeros(2), unit)
    drive = _driving_torque(model, theta, omega, tau)
    force = drive - model.coulomb * slip
    held = mass.copy()
    for k in range(2):
        if slip[k] == 0:
            held[k, :] = 0.0
            held[:, k] = 0.0
            held[k, k] = 1.0
            force[k] = 0.0
    determinant = held[0, 0] * held[1, 1] - held[0, 1] * held[1, 0]
    alpha = np.empty(2)
    alpha[0] = (held[1, 1] * force[0] - held[0, 1] * force[1]) / determinant
    alpha[1] = (held[0, 0] * force[1] - held[1, 0] * force[0]) / determinant
    return alpha, drive - np.dot(mass, alpha)


@numba.njit
def _step(
    model: TwoAxis, theta: Floats, omega: Floats, tau: Floats, slip: Any, h: float
) -> tuple[Floats, Floats]:
    """One classical Runge-Kutta step of `h` seconds in a fixed mode."""
    a1, _ = _motion(model, theta, omega, tau, slip)
    v2 = omega + 0.5 * h * a1
    a2, _ = _motion(model, theta + 0.5 * h * omega, v2, tau, slip)
    v3 = omega + 0.5 * h * a2
    a3, _ = _motion(model, theta + 0.5 * h * v2, v3, tau, slip)
    v4 = omega + h * a3
    a4, _ = _motion(model, theta + h * v3, v4, tau, slip)
    after = theta + h / 6.0 * (omega + 2.0 * v2 + 2.0 * v3 + v4)
    return after, omega + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)


@numba.njit
def _leaves_mode(model: TwoAxis, theta: Floats, omega: Floats, tau: Floats, slip: Any) -> bool:
    """Whether a sliding joint has reversed or a stuck joint carries more than it can."""
    _, friction = _motion(model, theta, omega, tau, slip)
    for k in range(2):
        if model.coulomb[k] == 0.0:
            continue
        if slip[k] != 0 and slip[k] * omega[k] < -DEAD_BAND:
            return True
        if slip[k] == 0 and abs(friction[k]) > model.coulomb[k]:
            return True
    return False


@numba.njit
def _choose_mode(model: TwoAxis, theta: Floats, omega: Floats, tau: Floats, slip: Any) -> None:
    """Stop reversed joints, then find the mode in which friction and motion fit; in place."""
    for k in range(2):
        if model.coulomb[k] > 0.0 and slip[k] * omega[k] < 0.0:
            omega[k] = 0.0
    for mode in _MODES:
        fits = True
        for k in range(2):
            if model.coulomb[k] == 0.0:
                fits = fits and mode[k] == FRICTIONLESS
            elif omega[k] != 0.0:
                fits = fits and mode[k] == (1 if omega[k] > 0.0 else -1)
        if fits:
            alpha, friction = _motion(model, theta, omega, tau, mode)
            for k in range(2):
                if model.coulomb[k] == 0.0:
                    continue
                if mode[k] == 0:
                    fits = fits and abs(friction[k]) <= model.coulomb[k]
                elif omega[k] == 0.0:
                    fits = fits and mode[k] * alpha[k] > 0.0
        if fits:
            slip[:] = mode
            return
    raise RuntimeError("no friction mode fits the state")


@numba.njit
def advance(
    model: TwoAxis, theta: Floats, omega: Floats, slip: Any, tau: Floats, span: float
) -> int:
    """Move angles [2], rates [2] and modes [2] on by `span` s under held torque; count events."""
    if _leaves_mode(model, theta, omega, tau, slip):
        _choose_mode(model, theta, omega, tau, slip)
    left, events = span, 0
    while left > EVENT_TOLERANCE:
        h = min(STEP, left)
        angle, rate = _step(model, theta, omega, tau, slip, h)
        if _leaves_mode(model, angle, rate, tau, slip):
            low = 0.0
            while h - low > EVENT_TOLERANCE:
                middle = 0.5 * (low + h)
                angle, rate = _step(model, theta, omega, tau, slip, middle)
                if _leaves_mode(model, angle, rate, tau, slip):
                    h = middle
                else:
                    low = middle
            angle, rate = _step(model, theta, omega, tau, slip, h)
            _choose_mode(model, angle, rate, tau, slip)
            events += 1
            if events > 1000:
                raise RuntimeError("mode changes pile up")
        theta[:], omega[:] = angle, rate
        left -= h
    return events


def simulate(
    model: TwoAxis,
    theta: Floats,
    omega: Floats,
    torque: Callable[[float, Floats, Floats], Floats],
    samples: int,
    period: float = 5e-3,
) -> tuple[Floats, Floats, Floats]:
    """Torques, angles and rates [samples, 2] at the sample times.

    `torque(time, theta, omega)` gives the torque [2] in N m that is held until the next sample.
    """
    theta, omega = np.array(theta, dtype=float), np.array(omega, dtype=float)
    slip = np.where(model.coulomb > 0.0, np.sign(omega), FRICTIONLESS).astype(np.int64)
    torques, angles, rates = (np.empty((samples, 2)) for _ in range(3))
    for k in range(samples):
        tau = np.asarray(torque(k * period, theta.copy(), omega.copy()), dtype=float)
        torques[k], angles[k], rates[k] = tau, theta, omega
        advance(model, theta, omega, slip, tau, period)
    return torques, angles, rates
