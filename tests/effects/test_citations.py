"""Places of the thesis that effects cite, each read and found to say what the effect takes from it.

An effect that cites another place fails here until somebody has read that place.
"""

import re

from ptp_symbolic.symbolic.effects import catalogue

PLACE = re.compile(r"\d+(?:\.\d+)+")
ERRATUM = re.compile(r"errat(?:um|a) (\d+)(?: and (\d+))?")
READ = {
    "backlash": "2.16 5.7",  # the dead zone; the gap
    "base_tilt": "2.2.1",  # gravity as an external force of a rigid body
    "constant_torque": "3.8",  # its efforts e_1, e_2
    "csvs_friction": "2.10 2.11 4.1",  # both branches; exponent 2 in Eq. 4.1
    "dc_motor": "3.10 3.11",  # winding; motor and load
    "direction_dependent_friction": "4.1 4.2",  # tables with omega > 0 and omega < 0
    "encoder_quantization": "3.2.3.1 4.2.2",  # 7200 counts per turn; 1800 pulses, four times
    "imu": "3.1",  # body rates of the tilt body
    "linear_actuator": "3.10 3.12 3.2.3.2 5.5 5.6",  # winding, screw, linkage, numbers
    "payload": "3.2.2 5.3",  # payload on the tilt body; its mass, inertia and offset
    "payload_com_offset": "3.2.2",  # mass imbalance
    "pid_controller": "3.2.3.1",  # PID, LM629
    "product_of_inertia": "2.2",  # table: asymmetric
    "pwm_drive": "3.2.3.1",  # PWM from the output of the PID
    "rate_dependent_breakaway": "5.4.2",  # breakaway against the rate of the force
    "rigid_bodies": "3.8 5.1",  # equations; inertias
    "shaft_compliance": "2.15 5.7",  # torque of the twist; stiffness
    "stribeck_exponent": "2.11",  # gamma
    "viscous_friction": "2.8 3.8",  # law; b_p, b_t
    "voltage_offset": "3.10",  # the input u
    "voltage_saturation": "5.3 5.4",  # 24 V
}
ERRATA_READ = {
    "csvs_friction": {2, 3},
    "dc_motor": {8},
    "linear_actuator": {9, 10},
    "payload": {18},
    "product_of_inertia": {27},
    "shaft_compliance": {4},
    "stribeck_exponent": {3},
}


def test_effects_cite_the_places_of_the_thesis_that_say_so() -> None:
    citing = {e.id: e.reference for e in catalogue() if "thesis" in e.reference}
    places = {name: PLACE.findall(text[text.index("thesis") :]) for name, text in citing.items()}
    assert places == {name: text.split() for name, text in READ.items()}
    errata = {
        name: {int(n) for found in ERRATUM.findall(text) for n in found if n}
        for name, text in citing.items()
    }
    assert {name: found for name, found in errata.items() if found} == ERRATA_READ
