"""Motor and gear on an axis whose torque is the input: a larger inertia, or a mass of its own."""

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

ROTOR, LOAD, STIFFNESS, TORQUE = 0.08, 0.25, 140.0, 0.6


def machine(*effects: str, axes: tuple[str, ...] = ("pan",)) -> Platform:
    body = EffectDeclaration("rigid_bodies", None, None)
    own = tuple(EffectDeclaration(e, "pan", None) for e in effects)
    return Platform("rotor", "Axis with a rotor", axes, 9.81, (body, *own), (), ())


def test_rigid_it_adds_to_the_inertia_of_its_own_axis_alone() -> None:
    bare, own = (
        assemble(machine(*effects, axes=("pan", "tilt"))).mass_matrix
        for effects in ((), ("rotor_inertia",))
    )
    (rotor,) = (own - bare).free_symbols
    assert str(rotor) == "J_rotor_pan"
    assert (own - bare)[0, 0] == rotor
    assert not any((own - bare)[i, j] for i, j in ((0, 1), (1, 0), (1, 1)))


def test_two_masses_that_a_torque_on_the_first_sets_swinging() -> None:
    """From rest: the centre of mass is accelerated evenly, and the twist swings about its mean."""
    model = emission.emit(machine("rotor_inertia", "shaft_compliance"))
    values = {"J_pan": LOAD, "J_rotor_pan": ROTOR, "k_shaft_pan": STIFFNESS, "d_shaft_pan": 0.0}
    found = simulate(
        model, 0.5, {"tau_pan": constant(TORQUE)}, values, ledger=True, rtol=1e-11, atol=1e-13
    )
    frequency = np.sqrt(STIFFNESS * (1.0 / ROTOR + 1.0 / LOAD))
    mean = TORQUE * LOAD / (ROTOR + LOAD) / STIFFNESS
    twist = found["theta_gear_pan"] - found["theta_pan"]
    assert twist == pytest.approx(mean * (1.0 - np.cos(frequency * found.t)), abs=1e-8 * mean)
    centre = (ROTOR * found["theta_gear_pan"] + LOAD * found["theta_pan"]) / (ROTOR + LOAD)
    assert centre == pytest.approx(TORQUE / (ROTOR + LOAD) * found.t**2 / 2.0, abs=1e-10)
    assert found.supplied == pytest.approx(TORQUE * found["theta_gear_pan"], abs=1e-9)
    assert found.dissipated == pytest.approx(np.zeros(len(found.t)), abs=1e-10)


def test_what_cannot_turn_or_has_a_motor_is_refused() -> None:
    with pytest.raises(InputError, match=r"Nothing turns before the shaft or gap on axis 'pan'"):
        emission.emit(machine("shaft_compliance"))
    with pytest.raises(InputError, match="which a motor or a prescribed motion replaces"):
        assemble(machine("dc_motor", "rotor_inertia"))
