"""An inertial measurement unit on the tilt body (the pan body where there is no tilt axis).

Its gyro measures the rates of the body, its accelerometer the specific force of the point where it
sits, acceleration less gravity, both in the axes of the sensor: those of the body, turned about z
by the yaw, then about the new y by the pitch, then about the new x by the roll of the mounting.
Each is an output of platforms that declare a signal of its name. A reading at an instant follows
from the inputs from that instant on.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Sensor
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

POSITION = tuple(
    Parameter(f"{k}_imu", "m", 0.0, -10.0, 10.0, f"{k} of the accelerometer in the body's axes")
    for k in "xyz"
)
MOUNTING = tuple(
    Parameter(f"{word}_imu", "rad", 0.0, -7.0, 7.0, f"{word} of the sensor's axes in the body's")
    for word in ("roll", "pitch", "yaw")
)


def _contribute(place: Place) -> Contribution:
    frame = place.payload_frame
    roll, pitch, yaw = (p.symbol for p in MOUNTING)
    arm = sp.Matrix([p.symbol for p in POSITION])
    spin, spin_rate, force = (
        sp.Matrix([place.quantity(f"{name}_{k}_{frame}") for k in "xyz"])
        for name in ("spin", "spin_rate", "specific_force")
    )
    force += spin_rate.cross(arm) + spin.cross(spin.cross(arm))
    to_sensor = sp.rot_axis1(roll) * sp.rot_axis2(pitch) * sp.rot_axis3(yaw)
    kinds = (("omega", "rad/s", "rate", spin), ("specific_force", "m/s^2", "specific force", force))
    return Contribution(
        sensors=tuple(
            Sensor(f"{name}_{k}_imu", unit, f"{word} in the sensor's {k}", value)
            for name, unit, word, vector in kinds
            for k, value in zip("xyz", to_sensor * vector, strict=True)
        )
    )


IMU = Effect(
    id="imu",
    title="inertial measurement unit",
    reference="Titterton and Weston (2004), section 3.4; body rates as in thesis Eq. 3.1",
    parameters=(*POSITION, *MOUNTING),
    contribute=_contribute,
    on_axis=False,
    structural=True,
    separating_experiment="Hold the tilt axis at several angles for the orientation, turn both axes"
    " fast for the position.",
    instead_on_linear="it is mounted on a body that turns",
)
