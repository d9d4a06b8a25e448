"""Erratum 4: the energy of a swinging shaft by SciPy, with either sign of the damping."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic.thesis import errata_shaft

MOTOR, LOAD, STIFFNESS, DAMPING = 1.1e-5 * 500**2, 0.05, 5000.0, 1.0


def energy_after(seconds: float, sign: float) -> float:
    """Energy over the first one of two bodies on a shaft; the damper opposes motion for sign 1."""

    def slope(_: float, x: np.ndarray) -> list[float]:
        torque = STIFFNESS * (x[0] - x[1]) + sign * DAMPING * (x[2] - x[3])
        return [x[2], x[3], -torque / MOTOR, torque / LOAD]

    start = np.array([LOAD, -MOTOR, 0.0, 0.0])
    x = solve_ivp(slope, (0.0, seconds), start, rtol=1e-10, atol=1e-12).y[:, -1]
    energy = [
        STIFFNESS * (y[0] - y[1]) ** 2 + MOTOR * y[2] ** 2 + LOAD * y[3] ** 2 for y in (start, x)
    ]
    return float(energy[1] / energy[0])


@pytest.mark.parametrize(
    ("term", "sign"), [(errata_shaft.PRINTED_DAMPING, -1.0), (errata_shaft.derived_damping(), 1.0)]
)
def test_the_printed_sign_feeds_the_oscillation(term: object, sign: float) -> None:
    rate = errata_shaft.growth(term)
    assert rate == pytest.approx(-sign * DAMPING / 2 * (1 / MOTOR + 1 / LOAD))
    # a whole number of periods, so that the energy follows the envelope
    stiff = STIFFNESS * (1 / MOTOR + 1 / LOAD)
    seconds = 10 * 2 * math.pi / math.sqrt(stiff - rate**2)
    assert energy_after(seconds, sign) == pytest.approx(math.exp(2 * rate * seconds), rel=1e-6)


def test_the_emitted_shaft_has_the_derived_sign() -> None:
    assert errata_shaft.emitted_damping() == pytest.approx(DAMPING)


def test_a_printed_term_that_were_right_would_settle_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert errata_shaft.shaft_damping().settled
    monkeypatch.setattr(errata_shaft, "PRINTED_DAMPING", errata_shaft.derived_damping())
    assert not errata_shaft.shaft_damping().settled
