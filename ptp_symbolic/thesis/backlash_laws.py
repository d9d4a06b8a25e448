"""Section 2.3.2.2: dead zone, hysteresis and impact across a gap, as the emitted effects say."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

import ptp_symbolic
from ptp_symbolic.models.emission import emit
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import multisine
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.thesis.friction import drive_values
from ptp_symbolic.thesis.responses import as_printed, pan_drive

FloatArray = NDArray[np.float64]

# The drive of Fig. 2.19 turns as sin(2 pi FREQUENCY t) rad before a gap of 2 HALF_GAP rad.
HALF_GAP, FREQUENCY = 0.3, 1.0
HYSTERESIS_TIMES = np.linspace(0.0, 2.0, 40_001)
# A drive so heavy that the load does not turn it: inertia in kg m^2, winding in ohm and H, N m/A.
HEAVY = {"J_motor_pan": 1e3, "N_pan": 1.0, "R_pan": 1.0, "L_pan": 1e-3, "K_t_pan": 100.0}
# What the load before the impact turns with, in rad/s, and the end in s of the impacts drawn.
IMPACT_RATE, IMPACT_END = 1.0, 0.12
STUCK = 1e4  # N m; friction that no impact overcomes


@cache
def rigid_model(kind: str) -> Model:
    """Motor and load with a gap of a kind of `backlash` whose faces are rigid."""
    effects = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("dc_motor", "pan", None),
        EffectDeclaration("backlash", "pan", None, kind),
    )
    return emit(Platform("gap", "Gap of chapter 2", ("pan",), 9.81, effects, (), ()))


def transmitted_torque(twist: FloatArray) -> FloatArray:
    """Torque [k] in N m on a load at rest behind the gap of the pan drive, for `twist` [k] in rad
    (Fig. 2.18).
    """
    model = pan_drive()
    p, no_input = model.parameter_vector(as_printed()), np.zeros(len(model.input_names))
    states = np.zeros((len(twist), len(model.state_names)))
    states[:, model.state_names.index("theta_gear_pan")] = twist
    rate, inertia = model.state_names.index("omega_pan"), drive_values()["J_pan"]
    return np.array([inertia * model.rhs(0.0, x, no_input, p)[rate] for x in states])


@cache
def hysteresis(kind: str) -> Trajectory:
    """Drive and load angle along HYSTERESIS_TIMES, for a kind of `backlash` (Fig. 2.19).

    The voltage is what the motor needs to turn as sin(2 pi FREQUENCY t); the load starts at the
    face that the drive turns against.
    """
    h, circular = HEAVY, 2.0 * np.pi * FREQUENCY
    torque_per_angle = -h["J_motor_pan"] * circular**2
    current = torque_per_angle / h["K_t_pan"]
    in_phase = h["R_pan"] * current
    ahead = (h["L_pan"] * current + h["K_t_pan"]) * circular
    voltage = multisine([in_phase, ahead], [FREQUENCY, FREQUENCY], [0.0, np.pi / 2.0])
    return ptp_symbolic.simulate(
        rigid_model(kind),
        HYSTERESIS_TIMES,
        {"u_pan": voltage},
        HEAVY | {"J_pan": drive_values()["J_pan"], "gap_pan": 2.0 * HALF_GAP},
        {"omega_gear_pan": circular, "omega_pan": circular, "theta_pan": -HALF_GAP},
    )


def printed_inertia_driven() -> FloatArray:
    """Load angle [k] in rad along HYSTERESIS_TIMES as Eq. 2.18 is printed, on the velocity.

    Contact lasts as long as the drive keeps its direction, so the load leaves it at rest.
    """
    circular, times = 2.0 * np.pi * FREQUENCY, HYSTERESIS_TIMES
    drive, rate = np.sin(circular * times), circular * np.cos(circular * times)
    load, load_rate = np.full(len(times), -HALF_GAP), 0.0
    for k in range(1, len(times)):
        face = drive[k] - np.copysign(HALF_GAP, rate[k])
        if rate[k] * (face - load[k - 1]) >= 0.0:
            load[k], load_rate = face, rate[k]
        else:
            load[k] = load[k - 1] + (times[k] - times[k - 1]) * load_rate
    return load


def _sprung(joint_friction: float, times: FloatArray) -> Trajectory:
    """A load that turns in the gap of the pan drive, whose motor friction holds."""
    held = {"F_c_pan": STUCK, "F_s_pan": STUCK, "b_pan": joint_friction}
    return ptp_symbolic.simulate(
        pan_drive(), times, None, as_printed() | held, {"omega_pan": IMPACT_RATE}, rtol=1e-10
    )


def sprung_impact(joint_friction: float = 0.0) -> Trajectory:
    """The load between the faces of the dead zone, which are springs without damping."""
    return _sprung(joint_friction, np.linspace(0.0, IMPACT_END, 1_201))


def restitution(joint_friction: float) -> float:
    """Speed after over speed before the first impact of `sprung_impact`; friction in N m s/rad."""
    events = [e for e in sprung_impact(joint_friction).events if e.element == "contact pan"]
    touched, free = (event.time for event in events[:2])
    run = _sprung(joint_friction, np.array([0.0, touched, free]))
    return float(-run["omega_pan"][2] / run["omega_pan"][1])


def rigid_impact(coefficient: float) -> Trajectory:
    """The load between rigid faces with a coefficient of restitution, the drive at rest."""
    values = HEAVY | {name: drive_values()[name] for name in ("J_pan", "gap_pan")}
    return ptp_symbolic.simulate(
        rigid_model("elastic_impact"),
        np.linspace(0.0, IMPACT_END, 1_201),
        None,
        values | {"e_gap_pan": coefficient},
        {"omega_pan": IMPACT_RATE},
    )
