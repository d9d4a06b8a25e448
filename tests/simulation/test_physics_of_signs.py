"""Signs and conventions that a formula with the opposite one would pass unseen."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.input_values import (
    evaluate_input_slopes,
    evaluate_inputs,
)
from ptp_symbolic.numeric.simulation.inputs import constant, sine_sweep, stack
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.documents.statements import Statement, statements


def pan(*effects: str) -> Platform:
    """A pan axis with `effects` on it."""
    declared = [EffectDeclaration("rigid_bodies", None, None)]
    declared += [EffectDeclaration(effect, "pan", None) for effect in effects]
    return Platform("signs", "Signs", ("pan",), 9.81, tuple(declared), (), ())


def printed(platform: Platform) -> dict[tuple[str, ...], Statement]:
    return {s.key: s for s in statements(assemble(platform))}


def test_printed_friction_slows_what_slides() -> None:
    """Sliding forward, a larger friction torque leaves less force."""
    (force,) = [s for s in printed(pan("csvs_friction")).values() if str(s.left) == "f_pan"]
    friction, direction = sp.symbols("F_sliding_pan slide_pan", real=True)
    assert sp.diff(force.right, friction).subs(direction, 1) == -1
    assert sp.diff(force.right, friction).subs(direction, -1) == 1


def test_a_printed_delay_looks_back() -> None:
    late = printed(pan("input_delay"))["input", "tau_pan"].right
    (instant,) = late.args
    assert instant.subs({"t": 5}).subs(sp.Symbol("t", real=True), 5) == 5 - sp.Symbol(
        "t_delay_pan", real=True
    )


def test_an_encoder_off_its_centre_sits_on_the_joint_behind_a_shaft() -> None:
    platform = read_platform("thesis-pan-drive")
    added = EffectDeclaration("encoder_eccentricity", "pan", None)
    reading = printed(replace(platform, effects=(*platform.effects, added)))["output", "theta_pan"]
    names = {str(symbol) for symbol in reading.right.free_symbols}
    assert "theta_pan" in names
    assert "theta_gear_pan" not in names


def test_a_prescribed_joint_takes_no_power_for_one_that_sticks() -> None:
    """Held by friction, the tilt joint does not move: all power goes into the pan joint."""
    platform = read_platform("tests/platforms/fieldlog_two_axis.toml")
    moved = EffectDeclaration("prescribed_motion", "pan", None)
    model = emission.emit(replace(platform, effects=(*platform.effects, moved)))
    stuck = {"F_c_tilt": 5.0, "F_s_tilt": 5.0, "c_y_payload": 0.05}
    found = simulate(model, 1.0, {"alpha_pan": constant(0.2)}, stuck, {"theta_tilt": 1.3})
    assert np.all(found["omega_tilt"] == 0.0)
    gained = found.stored[-1] - found.stored[0]
    assert found.supplied[-1] - found.dissipated[-1] == pytest.approx(gained, rel=1e-9)
    assert gained > 0.0


@pytest.mark.parametrize("method", ["rosenbrock", "fixed_step"])
def test_time_at_rest_goes_on_until_the_end_of_rest(method: str) -> None:
    """The tilt joint comes to rest later; the rest of the pan joint does not begin anew with it."""
    declared = [EffectDeclaration("rigid_bodies", None, None)]
    declared += [EffectDeclaration("csvs_friction", axis, None) for axis in ("pan", "tilt")]
    declared += [EffectDeclaration("rate_dependent_breakaway", "pan", None)]
    model = emission.emit(
        Platform("rests", "Rests", ("pan", "tilt"), 9.81, tuple(declared), (), ())
    )
    heavy = {"J_pan": 0.5, "J_y_tilt": 0.5, "F_v_tilt": 0.0, "F_s_tilt": 0.2401}
    heavy["a_rest_pan"] = 1e-6  # an effect that does nothing counts no time
    start = {"omega_pan": 0.02, "omega_tilt": 0.4}
    found = simulate(model, 2.0, None, heavy, start, method=method)
    pan_stops, tilt_stops = (
        next(e.time for e in found.events if (e.element, e.mode) == (f"friction {axis}", "sticks"))
        for axis in ("pan", "tilt")
    )
    assert pan_stops < 0.5 < tilt_stops < 1.5
    later = found.t > pan_stops + 0.01
    assert found["rest_time_pan"][later] == pytest.approx(found.t[later] - pan_stops, abs=2e-3)


def test_the_slope_of_a_sweep_is_that_of_its_values() -> None:
    packed = stack([sine_sweep(14.0, 0.1, 5.0, 1.0, 9.0)])
    cursor, step = packed.new_cursor(), 1e-6
    for t in np.linspace(1.2, 8.8, 40):
        ahead, behind, slope = np.zeros((3, 1))
        evaluate_inputs(t + step, 1, *packed.arrays, cursor, ahead)
        evaluate_inputs(t - step, 1, *packed.arrays, cursor, behind)
        evaluate_input_slopes(t, 1, *packed.arrays, cursor, slope)
        assert slope == pytest.approx((ahead - behind) / (2.0 * step), rel=1e-6, abs=1e-4)
