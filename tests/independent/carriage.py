"""A carriage on a spindle against hand-written equations in m, N and kg, integrated by SciPy."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

FloatArray = NDArray[np.float64]

MASS, SPRING, REST = 12.0, 1500.0, 0.02  # kg, N/m, m
COULOMB, VISCOUS = 6.0, 25.0  # N, N s/m
LEAD, GEAR = 5e-3, 2.0  # m per turn of the spindle; turns of the motor per turn of the spindle
INDUCTANCE, RESISTANCE, CONSTANT, ROTOR = 2e-3, 1.5, 0.04, 2e-5  # H, ohm, N m/A, kg m^2
PITCH = 24e-3  # m from a pair of magnets of a linear motor to the next
COUNTS = 2e6  # per metre

MACHINE = f"""
[platform]
name = "carriage"
axes = ["pan"]
joints = {{ pan = "linear" }}
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "viscous_friction"
axis = "pan"
[[effects]]
effect = "csvs_friction"
axis = "pan"
[[effects]]
effect = "cable_spring"
axis = "pan"
[parameters]
m_pan = {{ value = {1e3 * MASS}, unit = "g" }}
b_pan = {{ value = {1e-3 * VISCOUS}, unit = "N s/mm" }}
F_c_pan = {{ value = {COULOMB}, unit = "N" }}
F_s_pan = {{ same_as = "F_c_pan" }}
v_s_pan = {{ value = 0.01, unit = "m/s" }}
F_v_pan = {{ value = 0.0, unit = "N s/m" }}
k1_cable_pan = {{ value = {1e-3 * SPRING}, unit = "N/mm" }}
theta0_cable_pan = {{ value = {1e3 * REST}, unit = "mm" }}
"""
MOTOR = f"""
L_pan = {{ value = {INDUCTANCE} }}
R_pan = {{ value = {RESISTANCE} }}
K_t_pan = {{ value = {CONSTANT}, unit = "N m/A" }}
J_motor_pan = {{ value = {ROTOR}, unit = "kg m^2" }}
N_pan = {{ value = {GEAR / (1e3 * LEAD)}, unit = "turn/mm" }}
[[effects]]
effect = "dc_motor"
axis = "pan"
"""
POSITION = f"""
[signals.theta_pan]
role = "output"
column = "position"
unit = "mm"
counts_per_metre = {COUNTS}
"""
FORCE = """
[signals.tau_pan]
role = "input"
column = "force"
unit = "N"
"""
VOLTAGE = """
[signals.u_pan]
role = "input"
column = "voltage"
unit = "V"
"""


def force_at(t: float) -> float:
    return 80.0 * np.sin(5.0 * t) + 40.0 * np.sin(13.0 * t)


def voltage_at(t: float) -> float:
    """A sweep from 0.2 to 1.5 Hz in 2 s."""
    return 12.0 * np.sin(2.0 * np.pi * (0.2 * t + 1.3 * t**2 / 4.0))


@dataclass
class Carriage:
    """The carriage, driven by the force or, with its `motor`, by the voltage; a force of size
    `ripple` in N comes back with every pair of magnets; `way` is -1, 0 (it stands still) or 1.
    """

    motor: bool
    ripple: float = 0.0
    way: float = 0.0

    @property
    def ratio(self) -> float:
        """Angle of the motor in rad per metre."""
        return 2.0 * np.pi * GEAR / LEAD

    def push(self, t: float, state: FloatArray) -> float:
        """What acts on the carriage in N, dry friction apart."""
        drive = self.ratio * CONSTANT * state[2] if self.motor else force_at(t)
        wave = self.ripple * np.sin(2.0 * np.pi * state[0] / PITCH)
        return float(drive + wave - SPRING * (state[0] - REST) - VISCOUS * state[1])

    def slope(self, t: float, state: FloatArray) -> list[float]:
        """Rates of position, speed and current."""
        moved, current = MASS, 0.0
        if self.motor:
            moved += ROTOR * self.ratio**2
            back = self.ratio * CONSTANT * state[1]
            current = (voltage_at(t) - RESISTANCE * state[2] - back) / INDUCTANCE
        if self.way == 0.0:
            return [0.0, 0.0, current]
        return [state[1], (self.push(t, state) - self.way * COULOMB) / moved, current]


class Turning:
    """Where the carriage stops, or breaks away."""

    terminal = True

    def __init__(self, carriage: Carriage) -> None:
        self.carriage = carriage
        self.direction = -carriage.way or 1.0

    def __call__(self, t: float, state: FloatArray) -> float:
        moving = self.carriage.way != 0.0
        return float(state[1] if moving else abs(self.carriage.push(t, state)) - COULOMB)


def truth(times: FloatArray, motor: bool, ripple: float = 0.0) -> FloatArray:
    """Position in m, speed in m/s and current in A [k, 3] at `times`, from rest at 0."""
    carriage, found = Carriage(motor, ripple), np.zeros((len(times), 3))
    t, state = float(times[0]), np.zeros(3)
    while True:
        pushed = carriage.push(t, state)
        freed = carriage.way == 0.0 and t > times[0]
        carriage.way = float(np.sign(pushed)) if freed or abs(pushed) > COULOMB else 0.0
        part = solve_ivp(
            carriage.slope,
            (t, times[-1]),
            state,
            "DOP853",
            dense_output=True,
            events=Turning(carriage),
            rtol=1e-11,
            atol=1e-13,
            max_step=2e-3,
        )
        here = (times >= t) & (times <= part.t[-1])
        found[here] = part.sol(times[here]).T
        if part.status != 1:
            return found
        t, state = float(part.t[-1]), part.y[:, -1]
        if carriage.way:
            state[1] = 0.0
