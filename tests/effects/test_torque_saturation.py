"""A ceiling of the torque: momentum, energy, and friction that sees the torque that acts."""

import numpy as np
import pytest
from scipy.integrate import quad

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

BODY = EffectDeclaration("rigid_bodies", None, None)
J, LIMIT, SLOPE = 0.05, 0.8, 4.0


def machine(*effects: str) -> Platform:
    own = tuple(EffectDeclaration(e, "pan", None) for e in effects)
    return Platform("ceiling", "Pan axis and ceiling", ("pan",), 9.81, (BODY, *own), (), ())


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(machine("torque_saturation"))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_ramp_into_the_ceiling(model: Model, sign: float) -> None:
    """Impulse of the torque: a parabola up to the ceiling, a straight line from there; the work
    is that of the torque that acts.
    """
    driven = {"tau_pan": ramp(0.0, sign * SLOPE, 0.0, 1.0)}
    values = {"J_pan": J, "tau_max_pan": LIMIT}
    found = simulate(model, np.linspace(0.0, 1.0, 21), driven, values)
    met = LIMIT / SLOPE
    rising = np.minimum(found.t, met)
    rate = sign * (SLOPE * rising**2 / 2 + LIMIT * (found.t - rising)) / J
    assert found["omega_pan"] == pytest.approx(rate, rel=1e-7, abs=1e-9)

    def power(t: float) -> float:
        before = min(t, met)
        acting = min(SLOPE * t, LIMIT)
        return acting * (SLOPE * before**2 / 2 + LIMIT * (t - before)) / J

    work = quad(power, 0.0, 1.0, points=[met], epsabs=1e-12)[0]
    assert found.supplied[-1] == pytest.approx(work, rel=1e-7)
    assert found.dissipated == pytest.approx(np.zeros(len(found.t)), abs=1e-9)
    assert found.supplied == pytest.approx(J / 2 * found["omega_pan"] ** 2, abs=1e-6)


def test_a_ceiling_below_breakaway_never_moves_the_joint() -> None:
    stuck = emission.emit(machine("csvs_friction", "torque_saturation"))
    dry = {"F_c_pan": 0.5, "F_s_pan": 0.7, "tau_max_pan": 0.69}
    asked = {"tau_pan": constant(5.0)}
    assert simulate(stuck, 1.0, asked, dry)["theta_pan"][-1] == 0.0
    assert simulate(stuck, 1.0, asked, dry | {"tau_max_pan": 0.71})["theta_pan"][-1] > 0.0


def test_a_motor_or_a_prescribed_motion_takes_no_torque() -> None:
    for other in ("dc_motor", "prescribed_motion"):
        with pytest.raises(
            InputError, match="'torque_saturation' acts on the torque input of axis"
        ):
            assemble(machine(other, "torque_saturation"))
