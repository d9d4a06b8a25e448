"""A harmonic drive: an own integration, the linear shaft as a special case, energy, no backlash."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

J, B, ROTOR, RATIO = 0.4, 3.0, 1.2e-5, 100.0
L, R, K_T = 5e-3, 4.0, 0.06
K1, K3, D, K_H, T_H = 4000.0, 1.5e8, 2.0, 1500.0, 1.2
MOTOR = {
    "J_pan": J,
    "b_pan": B,
    "J_motor_pan": ROTOR,
    "N_pan": RATIO,
    "L_pan": L,
    "R_pan": R,
    "K_t_pan": K_T,
}
DRIVE = {
    "k1_drive_pan": K1,
    "k3_drive_pan": K3,
    "d_drive_pan": D,
    "k_hyst_pan": K_H,
    "T_hyst_pan": T_H,
}
VOLTAGE = {"u_pan": "multisine:14@0.9,2.3"}


def machine(*shaft: str) -> Platform:
    declared = [EffectDeclaration("rigid_bodies", None, None)]
    declared += [
        EffectDeclaration(e, "pan", None) for e in ("viscous_friction", "dc_motor", *shaft)
    ]
    return Platform("harmonic", "Harmonic drive", ("pan",), 9.81, tuple(declared), (), ())


def voltage(t: float) -> float:
    return 14.0 * (math.sin(2.0 * math.pi * 0.9 * t) + math.sin(2.0 * math.pi * 2.3 * t))


def integrated(end: float) -> np.ndarray:
    """Joint and gear output (angle, rate each), current and z at `end` in s, piece by piece."""
    x, t, slipping = np.zeros(6), 0.0, False
    while t < end:

        def slope(at: float, x: np.ndarray, slipping: bool = slipping) -> list[float]:
            angle, rate, gear, gear_rate, current, z = x
            twist, speed = gear - angle, gear_rate - rate
            torque = K1 * twist + K3 * twist**3 + D * speed + K_H * z
            joint = (torque - B * rate) / J
            rotor = (RATIO * K_T * current - torque) / (ROTOR * RATIO**2)
            electric = (voltage(at) - R * current - K_T * RATIO * gear_rate) / L
            return [rate, joint, gear_rate, rotor, electric, 0.0 if slipping else speed]

        def ends(_: float, x: np.ndarray, slipping: bool = slipping) -> float:
            return float(x[3] - x[1]) if slipping else T_H / K_H - abs(float(x[5]))

        ends.terminal, ends.direction = True, 0 if slipping else -1  # type: ignore[attr-defined]
        begun = solve_ivp(slope, (t, t + 1e-7), x, "LSODA", rtol=1e-11, atol=1e-13)
        piece = solve_ivp(
            slope, (t + 1e-7, end), begun.y[:, -1], "LSODA", events=ends, rtol=1e-11, atol=1e-13
        )
        t, x = piece.t[-1], piece.y[:, -1]
        slipping = not slipping if len(piece.t_events[0]) else slipping
    return x


@pytest.mark.parametrize("end", [0.3, 1.2])
def test_motion_and_hysteresis_are_those_of_another_integrator(end: float) -> None:
    model = emission.emit(machine("harmonic_drive"))
    found = simulate(model, [0.0, end], VOLTAGE, MOTOR | DRIVE, rtol=1e-9, atol=1e-11)
    names = ("theta_pan", "omega_pan", "theta_gear_pan", "omega_gear_pan", "i_pan", "z_hyst_pan")
    truth = integrated(end)
    assert sum("goes on" in event.mode for event in found.events) >= 2
    assert [found[n][-1] for n in names[:3:2]] == pytest.approx(truth[:3:2], abs=1e-6)
    assert [found[n][-1] for n in names[1:5:2]] == pytest.approx(truth[1:5:2], abs=1e-4)
    assert found["z_hyst_pan"][-1] == pytest.approx(truth[5], abs=1e-7)


def test_the_twist_is_large_enough_for_the_cube_to_matter() -> None:
    model = emission.emit(machine("harmonic_drive"))
    found = simulate(model, 1.2, VOLTAGE, MOTOR | DRIVE)
    twist = np.max(np.abs(found["theta_gear_pan"] - found["theta_pan"]))
    assert K3 * twist**2 > 0.2 * K1


def test_without_cube_and_slip_it_is_a_shaft() -> None:
    plain = {"k3_drive_pan": 0.0, "T_hyst_pan": 1e4}
    shaft = {"k_shaft_pan": K1 + K_H, "d_shaft_pan": D}
    ours, theirs = (
        simulate(emission.emit(machine(effect)), 1.0, VOLTAGE, MOTOR | values, rtol=1e-9)
        for effect, values in (("harmonic_drive", DRIVE | plain), ("shaft_compliance", shaft))
    )
    assert ours["theta_pan"] == pytest.approx(theirs["theta_pan"], abs=1e-7)
    assert ours["theta_gear_pan"] == pytest.approx(theirs["theta_gear_pan"], abs=1e-7)


def test_its_energies_add_up_and_loops_lose_some() -> None:
    """Of what slips and of damping, nothing comes back."""
    model = emission.emit(machine("harmonic_drive"))
    quiet = MOTOR | DRIVE | {"d_drive_pan": 0.0}
    slips, sticks = (
        simulate(model, 1.5, VOLTAGE, quiet | {"T_hyst_pan": limit}) for limit in (T_H, 1e4)
    )
    for found in (slips, sticks):
        left = found.stored - found.stored[0] - found.supplied + found.dissipated
        assert np.max(np.abs(left)) <= 1e-6 * np.max(np.abs(found.supplied))
    assert np.all(np.diff(slips.dissipated) >= -1e-9)


def test_backlash_beside_it_is_refused() -> None:
    with pytest.raises(InputError, match="Effect 'backlash' acts on 'half_gap_pan'"):
        assemble(machine("harmonic_drive", "backlash"))
