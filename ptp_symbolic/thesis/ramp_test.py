"""Section 4.3: inertia and friction of Table 4.2 from a current ramp, and what its bounds hide."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

import ptp_symbolic
from ptp_symbolic.models.emission import emit
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.thesis import printed
from ptp_symbolic.thesis.friction import drive_values
from ptp_symbolic.thesis.items import half_last_digit
from ptp_symbolic.thesis.printed import RampTest

FloatArray = NDArray[np.float64]

# The length of the test is not printed; at its end the current has reached 0.29 A.
TIMES = np.linspace(0.0, 20.0, 1_001)
COUNT = 2.0 * np.pi / printed.COUNTS_PER_REVOLUTION
COLUMNS = ("J", "F_s", "F_c", "v_s", "F_v")
# In the order of Appendix C, and the parameters of the model that take their values.
FITTED = ("J", "F_c", "F_s", "v_s", "F_v")
MODEL_PARAMETERS = ("J_pan", "F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan")
PROFILE = (0.0, 0.02, 0.04, 0.049, 0.051, 0.06, 0.08, 0.1)
MOTOR_INERTIA_ERROR = 0.02


@dataclass(frozen=True, eq=False)
class Estimate:
    """Result of one fit: x = J, Fc, Fs, vs, Fv in SI units, rms residual in encoder counts."""

    x: FloatArray
    rms_counts: float

    def value(self, name: str) -> float:
        """The parameter `name` of Table 4.2."""
        return float(self.x[FITTED.index(name)])


def torque_ramp() -> float:
    """Slope in N m/s of the motor torque at the gear output, as in Appendix C."""
    p = drive_values()
    return printed.CURRENT_RAMP * p["K_t_pan"] * p["N_pan"]


@cache
def pan_model() -> Model:
    """The load with CSVS friction, driven by a torque; its inertia is that of motor and load."""
    effects = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("csvs_friction", "pan", "joint"),
    )
    return emit(Platform("ramp_test", "Ramp test of section 4.3", ("pan",), 9.81, effects, (), ()))


@cache
def true_angle(test: RampTest) -> FloatArray:
    """Angle in rad at TIMES of a ramp test, made by scipy from breakaway on."""
    slope, f = torque_ramp(), test.friction
    inertia = printed.APPENDIX_C_MOTOR_INERTIA + test.J
    start = f.F_s / slope

    def derivative(t: float, x: FloatArray) -> list[float]:
        sliding = f.F_c + (f.F_s - f.F_c) * np.exp(-((x[1] / f.v_s) ** 2)) + f.F_v * x[1]
        return [x[1], (slope * t - sliding) / inertia]

    moving = TIMES[start < TIMES]
    run = solve_ivp(
        derivative,
        (start, TIMES[-1]),
        [0.0, 0.0],
        "DOP853",
        moving,
        rtol=1e-10,
        atol=1e-12,
        max_step=0.02,
    )
    return np.concatenate([np.zeros(len(TIMES) - len(moving)), run.y[0]])


def measured_angle(test: RampTest, phase: float = 0.0) -> FloatArray:
    """Encoder angle in rad at TIMES of a ramp test that starts `phase` counts from a count."""
    return np.floor(true_angle(test) / COUNT + phase + 0.5) * COUNT


def applied_torque() -> dict[str, InputSignal]:
    """The torque ramp of Appendix C as input of `pan_model`."""
    return {"tau_pan": ramp(0.0, torque_ramp() * TIMES[-1], 0.0, TIMES[-1])}


def model_values(x: Sequence[float] | FloatArray, motor_inertia: float) -> dict[str, float]:
    """Parameters of `pan_model` for x = J, Fc, Fs, vs, Fv."""
    return dict(zip(MODEL_PARAMETERS, [motor_inertia + x[0], *x[1:]], strict=True))


def model_angle(x: Sequence[float] | FloatArray, motor_inertia: float) -> FloatArray:
    """Angle in rad at TIMES of this program's model for x = J, Fc, Fs, vs, Fv."""
    values = model_values(x, motor_inertia)
    return ptp_symbolic.simulate(pan_model(), TIMES, applied_torque(), values)["theta_pan"]


def row(test: RampTest) -> FloatArray:
    """A row of Table 4.2 as x = J, Fc, Fs, vs, Fv."""
    return np.array([column([test], name)[0] for name in FITTED])


def sensitivities(test: RampTest, state: str) -> FloatArray:
    """Derivatives [k, 5] of a state at TIMES by J, Fc, Fs, vs, Fv, through the breakaway."""
    model = pan_model()
    found = ptp_symbolic.sensitivity(
        model,
        TIMES,
        applied_torque(),
        model_values(row(test), printed.APPENDIX_C_MOTOR_INERTIA),
        by_parameters=list(MODEL_PARAMETERS),
    )
    return found.states[:, model.state_names.index(state)]


def fit(
    angle: FloatArray,
    inertia: float | None = None,
    motor_inertia: float = printed.APPENDIX_C_MOTOR_INERTIA,
    bounded: bool = True,
    start: FloatArray | None = None,
) -> Estimate:
    """The fit of Appendix C with its starts and bounds, on the angle, with erratum 15 corrected.

    `inertia` holds J at a value in kg m^2; `bounded` False frees J from its bounds; `start` is
    another start of J, Fc, Fs, vs, Fv.
    """
    lower, upper = np.array(printed.APPENDIX_C_LOWER), np.array(printed.APPENDIX_C_UPPER)
    s = printed.APPENDIX_C_START
    begin = np.array([printed.INERTIA, s.F_c, s.F_s, s.v_s, s.F_v] if start is None else start)
    if not bounded:
        lower[0], upper[0] = -1.0, 1.0
    if inertia is not None:
        lower[0], upper[0], begin[0] = inertia - 1e-9, inertia + 1e-9, inertia
    begin = np.clip(begin, lower, upper)
    begin[1:] = np.clip(begin[1:], lower[1:] + 1e-3, upper[1:] - 1e-3)
    found = least_squares(
        lambda x: (model_angle(x, motor_inertia) - angle) / COUNT,
        begin,
        bounds=(lower, upper),
        method="trf",
        x_scale=np.maximum(begin, 0.05),
        xtol=1e-8,
        ftol=1e-10,
        diff_step=1e-5,
    )
    return Estimate(found.x, float(np.sqrt(np.mean(found.fun**2))))


@cache
def estimates(direction: str) -> tuple[Estimate, ...]:
    """The five tests of one direction, estimated from data made with their printed values."""
    return tuple(fit(measured_angle(test)) for test in printed.TABLE_4_2[direction])


@cache
def inertia_profile() -> FloatArray:
    """Rows [k, 2] of fixed J in kg m^2 and the rms residual in counts; test 1, everything refitted.

    The bounds of the other parameters stay as in Appendix C.
    """
    angle = measured_angle(printed.TABLE_4_2["positive"][0])
    return np.array([[J, fit(angle, J).rms_counts] for J in PROFILE])


@cache
def inertia_without_bounds() -> tuple[float, float]:
    """J in kg m^2 without its bounds, for the motor inertia as printed and 2 % too high."""
    angle = measured_angle(printed.TABLE_4_2["positive"][0])
    motor = printed.APPENDIX_C_MOTOR_INERTIA
    wrong = motor * (1.0 + MOTOR_INERTIA_ERROR)
    return (
        fit(angle, bounded=False).value("J"),
        fit(angle, motor_inertia=wrong, bounded=False).value("J"),
    )


def angle_change_between_bounds() -> float:
    """Largest change of the angle in counts when J moves from its lower to its upper bound."""
    f = printed.TABLE_4_2["positive"][0].friction
    low, high = (
        model_angle([J, f.F_c, f.F_s, f.v_s, f.F_v], printed.APPENDIX_C_MOTOR_INERTIA)
        for J in (printed.APPENDIX_C_LOWER[0], printed.APPENDIX_C_UPPER[0])
    )
    return float(np.max(np.abs(high - low)) / COUNT)


def speed_sensitivity() -> float:
    """Largest change of the speed, relative to the speed at the end, per relative change of J.

    By the forward sensitivities through the breakaway, test 1 of Table 4.2.
    """
    test = printed.TABLE_4_2["positive"][0]
    values = model_values(row(test), printed.APPENDIX_C_MOTOR_INERTIA)
    final = ptp_symbolic.simulate(pan_model(), TIMES, applied_torque(), values)["omega_pan"][-1]
    change = np.max(np.abs(sensitivities(test, "omega_pan")[:, 0])) * test.J
    return float(change / final)


def column(tests: Sequence[RampTest], name: str) -> FloatArray:
    """One column of Table 4.2 in the order of the tests."""
    return np.array([t.J if name == "J" else getattr(t.friction, name) for t in tests])


def matching_subsets(direction: str) -> list[tuple[int, ...]]:
    """Subsets of the five tests (numbers 1 to 5) whose means round to the printed friction.

    A mean that rounds up or down to the last printed digit counts, J left aside.
    """
    tests, average = printed.TABLE_4_2[direction], printed.TABLE_4_2_AVERAGE[direction]
    found = []
    for size in range(1, 6):
        for chosen in combinations(range(5), size):
            rows = [tests[k] for k in chosen]
            gaps = [
                abs(column(rows, n).mean() - column([average], n)[0])
                <= 2.001 * half_last_digit(float(column([average], n)[0]))
                for n in COLUMNS[1:]
            ]
            if all(gaps):
                found.append(tuple(k + 1 for k in chosen))
    return found
