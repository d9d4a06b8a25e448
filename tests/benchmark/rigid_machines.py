"""The machines of rigid bodies: what is declared of each."""

from tests.benchmark.rigid_machine import Plate, RigidMachine
from tests.benchmark.servo_runs import BOTH


def _tilt_plate(
    motor: dict[str, float], mass: float, inertia: float, friction: tuple[float, ...]
) -> Plate:
    """A geared motor, a payload on an arm, friction as (F_c, F_s, v_s, F_v)."""
    known = {f"{name}_tilt": value for name, value in motor.items()}
    known |= {"m_payload": mass, "J_y_payload": 0.0, "c_x_payload": 0.1, "c_z_payload": 0.0}
    names = ("F_c_tilt", "F_s_tilt", "v_s_tilt", "F_v_tilt")
    starts = {"J_y_tilt": inertia} | dict(zip(names, friction, strict=True))
    return Plate(known, starts)


_SMALL_MOTOR = {"L": 5e-3, "R": 5.0, "K_t": 0.03, "J_motor": 1e-6, "N": 150.0}
_LARGE_MOTOR = {"L": 4e-3, "R": 3.0, "K_t": 0.06, "J_motor": 4e-6, "N": 200.0}
TILT_SERVO = RigidMachine(
    "tilt_servo",
    ("tilt",),
    _tilt_plate(_SMALL_MOTOR, 0.5, 0.02, (0.3, 0.45, 0.03, 0.4)),
    _tilt_plate(_LARGE_MOTOR, 5.0, 0.1, (1.2, 1.8, 0.03, 2.0)),
    voltage_driven=True,
    viscous=False,
)
DIRECT_DRIVE = RigidMachine(
    "direct_drive",
    ("pan",),
    Plate(
        {
            "m_payload": 2.0,
            "J_z_payload": 0.0,
            "c_x_payload": 0.1,
            "c_y_payload": 0.0,
            "F_v_pan": 0.0,
        },
        {"J_pan": 0.03, "b_pan": 0.05, "F_c_pan": 0.15, "F_s_pan": 0.22, "v_s_pan": 0.03},
    ),
)
_LIGHT_BODIES = {"J_pan": 0.012, "J_x_tilt": 0.0041, "J_y_tilt": 0.0065, "J_z_tilt": 0.0027}
_LARGE_BODIES = {"J_pan": 0.02, "J_x_tilt": 0.012, "J_y_tilt": 0.014, "J_z_tilt": 0.01}


def _two_axis_plate(bodies: dict[str, float]) -> Plate:
    """The platform of tests/platforms/fieldlog_two_axis.toml with other bodies."""
    payload = {
        "m_payload": 4.992,
        "J_x_payload": 0.0053,
        "J_y_payload": 0.0068,
        "J_z_payload": 0.0068,
        "c_x_payload": 0.1,
        "c_y_payload": 0.0,
        "c_z_payload": 0.0,
    }
    friction = {"v_s_pan": 0.01, "F_v_pan": 0.0, "v_s_tilt": 0.01, "F_v_tilt": 0.0}
    starts = {"b_pan": 0.1, "F_c_pan": 0.05, "b_tilt": 0.1, "F_c_tilt": 0.05}
    return Plate(bodies | payload | friction, starts)


TWO_AXIS = RigidMachine(
    "two_axis",
    BOTH,
    _two_axis_plate(_LIGHT_BODIES),
    _two_axis_plate(_LARGE_BODIES),
    tied={"F_s_pan": "F_c_pan", "F_s_tilt": "F_c_tilt"},
)


def _with_motors(bodies: dict[str, float], motor: dict[str, float], mass: float) -> Plate:
    """Both axes with a geared motor each, that of the pan axis with half the gear ratio more."""
    known = {f"{name}_{axis}": value for axis in BOTH for name, value in motor.items()}
    known["N_pan"] *= 1.5
    known |= bodies | {"m_payload": mass, "c_x_payload": 0.1, "c_y_payload": 0.0}
    known |= {"c_z_payload": 0.0, "J_x_payload": 0.002, "J_y_payload": 0.003, "J_z_payload": 0.003}
    starts: dict[str, float] = {}
    for axis, size in (("pan", 1.5), ("tilt", 1.0)):
        values = (0.3 * size, 0.45 * size, 0.03, 0.4 * size)
        names = (f"{name}_{axis}" for name in ("F_c", "F_s", "v_s", "F_v"))
        starts |= dict(zip(names, values, strict=True))
    return Plate(known, starts)


TWO_AXIS_SERVO = RigidMachine(
    "two_axis_servo",
    BOTH,
    _with_motors(_LIGHT_BODIES, _SMALL_MOTOR, 0.5),
    _with_motors(_LARGE_BODIES, _LARGE_MOTOR, 5.0),
    voltage_driven=True,
    viscous=False,
)
