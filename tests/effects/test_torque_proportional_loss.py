"""Losses that go with the transmitted torque: efficiency both ways, presliding, the ledger."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, multisine
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

BODY = EffectDeclaration("rigid_bodies", None, None)
J, MEAN, DIFFERENCE, ANGLE = 0.05, 0.2, 0.08, 0.01
LOSS = {"mu_avg_pan": MEAN, "mu_dif_pan": DIFFERENCE, "h_loss_pan": ANGLE}
GEAR = LOSS | {"J_pan": J}


def machine(*effects: str) -> Platform:
    own = tuple(EffectDeclaration(e, "pan", None) for e in effects)
    return Platform("gear", "Pan axis and lossy gear", ("pan",), 9.81, (BODY, *own), (), ())


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(machine("torque_proportional_loss"))


@pytest.mark.parametrize("torque", [0.8, -0.8])
@pytest.mark.parametrize("rate", [4.0, -4.0])
def test_a_gear_loses_one_share_driven_and_another_back_driven(
    model: Model, torque: float, rate: float
) -> None:
    """Sliding on, torque times 1 - (avg + dif) accelerates, times 1 + (avg - dif) brakes."""
    drives = torque * rate > 0.0
    share = 1.0 - (MEAN + DIFFERENCE) if drives else 1.0 + (MEAN - DIFFERENCE)
    start = {"omega_pan": rate, "z_loss_pan": math.copysign(1.0, rate)}
    found = simulate(model, 0.1, {"tau_pan": constant(torque)}, GEAR, start, rtol=1e-10)
    assert found["omega_pan"] == pytest.approx(rate + share * torque / J * found.t, rel=1e-9)
    turned = np.abs(found["theta_pan"])
    lost = (MEAN + DIFFERENCE if drives else MEAN - DIFFERENCE) * abs(torque) * turned
    assert found.dissipated == pytest.approx(lost, abs=1e-8)
    assert found.supplied == pytest.approx(torque * found["theta_pan"], abs=1e-8)


def test_losses_come_up_as_an_exponential_of_the_angle(model: Model) -> None:
    start = {"omega_pan": 0.3}
    found = simulate(model, 0.1, None, GEAR, start, rtol=1e-10)
    up = 1.0 - np.exp(-found["theta_pan"] / ANGLE)
    assert found["z_loss_pan"] == pytest.approx(up, abs=1e-6)


def test_motion_and_ledger_under_a_torque_that_swings(model: Model) -> None:
    """SciPy integrates the law and its powers: what the input gives, what the loss takes (of which
    what has bent gives back a part: all but |w| z^2 times the loss).
    """
    amplitude, frequency = 0.9, 3.0
    times = np.linspace(0.0, 1.0, 51)

    def slopes(t: float, y: np.ndarray) -> list[float]:
        _, w, z = y[:3]
        tau = amplitude * math.sin(2.0 * math.pi * frequency * t)
        loss = MEAN * abs(tau) * z + DIFFERENCE * tau * z * z
        turning = (w - abs(w) * z) / ANGLE
        lost = abs(w) * (MEAN * abs(tau) * z**2 + DIFFERENCE * tau * z**3)
        return [w, (tau - loss) / J, turning, tau * w, lost, loss * w - lost]

    own = solve_ivp(
        slopes, (0.0, 1.0), np.zeros(6), t_eval=times, rtol=1e-10, atol=1e-12, max_step=2e-3
    )
    driven = {"tau_pan": multisine([amplitude], [frequency])}
    found = simulate(model, times, driven, GEAR, rtol=1e-9, atol=1e-11)
    assert found["omega_pan"] == pytest.approx(own.y[1], abs=1e-5)
    assert found["z_loss_pan"] == pytest.approx(own.y[2], abs=1e-5)
    assert found.supplied == pytest.approx(own.y[3], abs=1e-5)
    assert found.dissipated == pytest.approx(own.y[4] + own.y[5], abs=1e-5)
    assert found["z_loss_pan"].min() < -0.9
    stored = J / 2 * found["omega_pan"] ** 2
    assert stored == pytest.approx(found.supplied - found.dissipated, abs=1e-7)


@pytest.mark.parametrize("drive", [("dc_motor",), ("dc_motor", "shaft_compliance")])
def test_a_motor_settles_where_its_torque_less_the_loss_meets_the_drag(
    drive: tuple[str, ...],
) -> None:
    """Steadily the joint's viscous torque is the share (1 - avg - dif) of what is transmitted; on
    a shaft the transmitted torque is that of the joint, and the motor carries the loss.
    """
    model = emission.emit(machine("viscous_friction", *drive, "torque_proportional_loss"))
    friction, n, k_t, r, volts = 3.0, 500.0, 0.0724, 12.9, 12.0
    values = LOSS | {"b_pan": friction, "N_pan": n, "K_t_pan": k_t, "R_pan": r}
    found = simulate(model, [0.0, 20.0], {"u_pan": constant(volts)}, values)
    share = MEAN + DIFFERENCE
    gain = 1.0 - share if len(drive) == 1 else 1.0 / (1.0 + share)
    rate = n * k_t * volts / r / (friction / gain + (n * k_t) ** 2 / r)
    assert found["omega_pan"][-1] == pytest.approx(rate, rel=1e-6)


def test_a_gear_never_gains_and_one_whose_torque_nobody_knows_is_refused(model: Model) -> None:
    with pytest.raises(InputError, match="mu_dif lies within -mu_avg and mu_avg"):
        simulate(model, 0.1, None, GEAR | {"mu_dif_pan": -0.3})
    with pytest.raises(InputError, match="acts on 'transmitted_torque_pan'"):
        assemble(machine("prescribed_motion", "torque_proportional_loss"))
