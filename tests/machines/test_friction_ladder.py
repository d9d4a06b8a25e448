"""Laws of friction of a servo: which parts each has, and the error of a pendulum that is known."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic.machines.friction_ladder import RUNGS, mean_error, platform_of
from ptp_symbolic.machines.study import PLATFORMS
from ptp_symbolic.platform import read_platform

PLATFORM = read_platform(PLATFORMS / "servo_pendulum.toml")
INERTIA, TORQUE_CONSTANT, VISCOUS = 2e-3, 0.4, 0.03
COUNT = 2.0 * np.pi / 4096


def voltage(t: float) -> float:
    """Voltage that is held over every sample of 5 ms."""
    return 2.0 * np.sin(3.0 * 5e-3 * np.floor(t / 5e-3 + 1e-9))


def angle(time: np.ndarray) -> np.ndarray:
    """Angle [k] of a pendulum of 0.49 kg at 0.1 m on a motor, by its equations of motion."""
    inertia = INERTIA + 0.49 * 0.1**2 + 1e-5

    def slope(t: float, x: np.ndarray) -> list[float]:
        torque = TORQUE_CONSTANT * x[2] - VISCOUS * x[1] - 0.49 * 9.81 * 0.1 * np.sin(x[0])
        return [x[1], torque / inertia, (voltage(t) - 3.4 * x[2] - TORQUE_CONSTANT * x[1]) / 3e-3]

    found = solve_ivp(slope, (0.0, time[-1]), [0.0] * 3, "LSODA", time, max_step=1e-3, rtol=1e-8)
    return np.asarray(found.y[0])


def test_the_laws_are_those_of_the_paper() -> None:
    """Their parts beside Coulomb and viscous friction, and the factors that are one."""
    platforms = [platform_of(PLATFORM, rung) for rung in RUNGS]
    free = [{p.name for p in platform.parameters if p.free} for platform in platforms]
    tied = [{p.name: p.same_as for p in q.parameters if p.same_as} for q in platforms]
    plain = {"J_y_payload", "K_t_tilt", "F_c_tilt", "F_v_tilt"}
    static = {"F_s_tilt", "v_s_tilt"}
    apart = {"mu_motor_tilt", "mu_outer_tilt", "mu_motor_rest_tilt", "mu_outer_rest_tilt"}
    squares = {"q_motor_rest_tilt", "q_outer_rest_tilt"}
    one = {"mu_outer_tilt": "mu_motor_tilt"}
    at_rest = {"mu_outer_rest_tilt": "mu_motor_rest_tilt"}
    assert free == [
        plain,
        plain | static,
        plain | {"mu_motor_tilt"},
        plain | static | {"mu_motor_tilt", "mu_motor_rest_tilt"},
        plain | static | apart,
        plain | static | apart | squares,
    ]
    smooth = {"F_s_tilt": "F_c_tilt"}
    assert tied == [smooth, {}, smooth | one, one | at_rest, {}, {}]


def test_the_error_of_the_true_pendulum_is_that_of_rounding(tmp_path: Path) -> None:
    """A quarter of a count is the mean of what rounding leaves; friction it has not is seen."""
    time = 5e-3 * np.arange(400)
    path = tmp_path / "swing.csv"
    columns = [time, [voltage(t) for t in time], np.rint(angle(time) / COUNT) * COUNT]
    rows = "\n".join(",".join(f"{x:.9g}" for x in row) for row in np.column_stack(columns))
    path.write_text(f"time [s],voltage [V],angle [rad]\n{rows}\n", encoding="utf-8")
    values = {"J_y_payload": INERTIA, "K_t_tilt": TORQUE_CONSTANT, "F_v_tilt": VISCOUS}
    true = {**values, "F_c_tilt": 0.0, "F_s_tilt": 0.0}
    assert mean_error(PLATFORM, true, [path]) == pytest.approx(COUNT / 4.0, rel=0.1)
    assert mean_error(PLATFORM, {**true, "F_v_tilt": 1.1 * VISCOUS}, [path]) > COUNT
