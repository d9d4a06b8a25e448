"""Errata of the drives: screw, stroke, step, ringing, impact, hysteresis (chapters 2, 3, 5)."""

import math

import numpy as np

from ptp_symbolic.thesis import backlash_laws, contact, printed, responses, tilt_drive
from ptp_symbolic.thesis.friction import drive_values
from ptp_symbolic.thesis.items import Item, erratum


def creep_speed(shorted: bool) -> float:
    """Stroke speed in m/s at which the screw overhauls under the load of Table 5.6."""
    d, offset = tilt_drive.model("48.5").defaults, tilt_drive.com_offset("48.5")
    force = d["m_payload"] * d["gravity"] * offset / d["r_arm_tilt"]
    torque = -tilt_drive.actuator("48.5").lowering * force / d["N_tilt"]
    resistance = d["b_motor_tilt"] + (d["K_t_tilt"] ** 2 / d["R_tilt"] if shorted else 0.0)
    return torque / resistance / d["N_tilt"] * d["lead_tilt"] / (2.0 * math.pi)


def self_locking() -> Item:
    """Erratum 10: the screw of Table 5.5 overhauls."""
    d = tilt_drive.model("48.5").defaults
    lead_angle = math.degrees(math.atan(d["lead_tilt"] / (math.pi * d["d_screw_tilt"])))
    friction_angle = math.degrees(math.atan(d["f_screw_tilt"]))
    lowering = tilt_drive.actuator("48.5").lowering
    simulated = tilt_drive.simulate_tilt_drive(
        "48.5", np.array([0.0, 1.0]), "ahead", tilt_drive.NO_VOLTAGE
    ).stroke_speed[-1]
    expected = creep_speed(shorted=True)
    return erratum(
        10,
        "section 3.2.3.2, lead screw",
        "self-locking",
        "overhauls",
        "",
        lead_angle > friction_angle and lowering < 0.0 and abs(simulated / expected + 1.0) < 0.02,
        f"lead angle {lead_angle:.2f} deg above friction angle {friction_angle:.2f} deg; T_lower ="
        f" {lowering:.3g} m x F < 0; creep {1e6 * creep_speed(False):.1f} um/s open circuit and"
        f" {1e6 * expected:.2f} um/s shorted, simulated {-1e6 * simulated:.2f}",
    )


def initial_stroke() -> Item:
    """Erratum 19: the initial stroke is given twice."""
    angles = {name: float(np.degrees(tilt_drive.deviation(name))) for name in tilt_drive.PRESETS}
    return erratum(
        19,
        "Table 5.6, initial stroke",
        "40.5022 mm and 48.5 mm",
        f"{angles['40.5']:.2f} deg and {angles['48.5']:.2f} deg from the perpendicular",
        "",
        abs(abs(angles["40.5"]) - 7.0) < 0.05 and abs(abs(angles["48.5"]) - 0.4) < 0.05,
        "lever of the derived linkage, Table 5.6; the two strokes are different starts, both are"
        " computed",
    )


def step_table() -> Item:
    """Erratum 20: Table 5.8 is empty; the step as the text describes it."""
    run = responses.response("step")
    start, end = responses.STEP
    compared_to = responses.last_end("step")
    moving = run.t[np.abs(run["omega_gear_pan"]) > 1e-9]
    settled = start <= moving[0] and end < moving[-1] < compared_to
    return erratum(
        20,
        "Table 5.8, step specification",
        "(empty)",
        f"{printed.SUPPLY_VOLTAGE:g} V from {start:g} s to {end:g} s, compared to"
        f" {compared_to:g} s",
        "",
        bool(settled),
        f"from the text of 5.4.1; simulated, the drive moves from {moving[0]:.3f} to"
        f" {moving[-1]:.3f} s, inside the time compared",
    )


def com_direction() -> Item:
    """Erratum 24: for which direction of the offset the claims of section 5.3 hold."""
    found = {}
    for direction in tilt_drive.COM_DIRECTIONS:
        run = tilt_drive.trapezoid_run("40.5", direction)
        holds = abs(run.force[-1]) > 1.0 and run.tilt_angle[-1] < 0.0
        found[direction] = tilt_drive.reversal("40.5", direction) is not None and holds
    which = ", ".join(d for d, holds in found.items() if holds)
    return erratum(
        24,
        "section 5.3, direction of the c.g. offset",
        "(not printed)",
        which,
        "",
        which == "above",
        "simulated with the c.g. above, ahead of, below and behind the axis: force first"
        " positive, then negative, not zero at the end, tilt angle negative",
    )


def ringing() -> Item:
    """Erratum 25: the oscillation after the step is physical."""
    mode, rows = contact.contact_mode(), contact.convergence()
    simulated = contact.ringing_frequency()
    converges = bool(np.all(np.diff(rows[1:, 1]) < 0.0) and rows[-1, 1] < 1e-2 * rows[0, 1])
    return erratum(
        25,
        "section 5.4.1, oscillation after the step",
        "numerical",
        f"contact mode, {mode.frequency:.0f} Hz, damping {mode.damping:.2f}",
        "",
        converges and abs(simulated / mode.frequency - 1.0) < 0.02,
        f"the twist is off by {rows[0, 1]:.1g} rad at tolerance {rows[0, 0]:g} and by"
        f" {rows[-1, 1]:.1g} rad at {rows[-1, 0]:g}; the simulation rings at {simulated:.1f} Hz,"
        f" the eigenvalues say {mode.frequency:.1f} Hz",
    )


def plastic_impact() -> Item:
    """Erratum 26: the dead-zone model has no plastic impact."""
    bare, damped = (backlash_laws.restitution(b) for b in (0.0, drive_values()["b_pan"]))
    return erratum(
        26,
        "sections 1.6 and 5.4.2, restitution of the dead-zone model",
        0.0,
        bare,
        "1",
        abs(bare - 1.0) < 1e-6 and abs(damped - 0.82) < 0.01,
        f"simulation of the pan drive, its motor held; {damped:.3f} with the joint's viscous"
        " friction, 0 would be plastic",
    )


def contact_condition() -> Item:
    """Erratum 29: Eq. 2.18 as printed never lets the load coast."""
    friction, right = (
        backlash_laws.hysteresis(f"hysteresis_{kind}")["theta_pan"]
        for kind in ("friction", "inertia")
    )
    given, half_gap = backlash_laws.printed_inertia_driven(), backlash_laws.HALF_GAP
    same, other = (float(np.max(np.abs(x - friction))) for x in (given, right))
    return erratum(
        29,
        "Eq. 2.18, contact conditions",
        "on the velocity",
        "on the acceleration",
        "",
        same < 1e-2 * half_gap and other > 0.5 * half_gap,
        f"drive angle sin(2 pi t), half gap {half_gap:g} rad: as printed the load differs from the"
        f" simulated backlash of Eq. 2.17 by at most {same:.1g} rad, the simulated backlash with"
        f" the corrected condition by {other:.2g} rad",
    )
