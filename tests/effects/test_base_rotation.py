"""A base that turns: three derivations, and motions in closed form seen from space."""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.inputs import InputSignal, constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.proof import prove_equal

FORCE = ("base_acceleration", "specific_force")


def platform(*effects: str | tuple[str, str], axes: tuple[str, ...] = ("pan", "tilt")) -> Platform:
    pairs = [(e, None) if isinstance(e, str) else e for e in ("rigid_bodies", *effects)]
    declared = tuple(EffectDeclaration(e, None, None, kind) for e, kind in pairs)
    return Platform("turned", "Turning base", axes, 9.81, declared, (), ())


@pytest.mark.parametrize("axes", [("pan", "tilt"), ("pan",), ("tilt",)])
@pytest.mark.parametrize("force", ["base_acceleration", FORCE], ids=["acceleration", "force"])
def test_three_derivations_agree(axes: tuple[str, ...], force: str | tuple[str, str]) -> None:
    offset = ("pan_com_offset",) if "pan" in axes else ()
    equations = assemble(platform("payload", *offset, "base_rotation", force, axes=axes))
    for route in (kane, newton_euler):
        assert prove_equal(equations.rigid_equations, route(equations.rigid)).equal


@pytest.mark.parametrize("axes", [("pan", "tilt"), ("pan",), ("tilt",)])
def test_the_equations_that_are_integrated_are_those_derived(axes: tuple[str, ...]) -> None:
    equations = assemble(platform("payload", "base_rotation", FORCE, axes=axes))
    taus = {i.symbol: 0 for i in equations.inputs if i.name.startswith("tau")}
    written = equations.written_out(equations.forcing).xreplace(taus)
    rigid = equations.rigid_equations
    assert prove_equal(replace(rigid, forcing=written.as_immutable()), rigid).equal


def test_a_free_pan_body_stays_behind_in_space() -> None:
    """A yawing base leaves a balanced, frictionless pan body as it is: theta_pan = -yaw."""
    slope = 0.7
    given: dict[str, InputSignal | str] = {
        "omega_z_base": ramp(0.0, 2.0 * slope, 0.0, 2.0),
        "alpha_z_base": constant(slope),
    }
    times = np.linspace(0.0, 2.0, 21)
    found = simulate(emission.emit(platform("base_rotation", axes=("pan",))), times, given)
    assert found["theta_pan"] == pytest.approx(-slope * times**2 / 2, abs=1e-9)


def test_a_tilt_body_on_a_turntable_swings_about_its_centrifugal_rest() -> None:
    """Body with principal inertias J_x < J_z about x and z: a small swing at steady yaw rate W has
    the frequency W sqrt((J_z - J_x) / J_y), Euler's equations linearised about theta = 0.
    """
    inertia = {"J_x_tilt": 0.02, "J_y_tilt": 0.05, "J_z_tilt": 0.06}
    rate, start = 3.0, 1e-4
    swing = rate * np.sqrt((0.06 - 0.02) / 0.05)
    times = np.linspace(0.0, 2.0, 21)
    found = simulate(
        emission.emit(platform("base_rotation", axes=("tilt",))),
        times,
        {"omega_z_base": constant(rate)},
        inertia,
        {"theta_tilt": start},
        rtol=1e-11,
        atol=1e-14,
    )
    assert found["theta_tilt"] == pytest.approx(start * np.cos(swing * times), abs=1e-10)
    assert found["theta_tilt"].min() < -0.99 * start


def test_a_linear_joint_on_a_base_that_turns_is_refused() -> None:
    given = platform("base_rotation", axes=("pan",))
    with pytest.raises(InputError, match="'base_rotation' makes no sense on a linear joint"):
        assemble(replace(given, linear_axes=("pan",)))
