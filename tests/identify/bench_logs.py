"""Logs of a bench as a laboratory has them: PWM in counts, encoder, gyro, current, torque.

Each has its own scale, sign, zero and delay.

The truth is written by hand and integrated by SciPy, command by command: a geared motor with
inductance turns a load by a flexible shaft against viscous friction.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

TRUTH = {
    "J_pan": 0.05,
    "b_pan": 0.2,
    "k_shaft_pan": 40.0,
    "d_shaft_pan": 0.02,
    "R_pan": 5.0,
    "K_t_pan": 0.05,
}
INDUCTANCE, ROTOR, RATIO = 5e-3, 1e-5, 50.0
PERIOD, HOLD, DURATION = 0.005, 0.05, 6.0
COUNTS = 65536
LAGS = {"t_lag_omega_pan": 0.008, "t_lag_i_pan": 0.003}  # s, of those who filter
VOLTS_PER_COUNT, ZERO = 0.1875, 128  # of an unsigned 8-bit PWM at 24 V
INPUT_DELAY, ENCODER_DELAY, GYRO_DELAY = 0.007, 0.004, 0.0093
NOISE = {"omega_pan": 4e-3, "i_pan": 0.01, "tau_shaft_pan": 0.02, "omega_motor_pan": 0.2}
SIGNALS = {
    "u_pan": 'role = "input", column = "pwm", unit = "V", scale = 0.1875, offset = 128,'
    ' noise = 0.0, delay = "7 ms"',
    "theta_pan": 'role = "output", column = "enc", unit = "rad", scale = -9.587379924285257e-05,'
    ' counts_per_revolution = 65536, noise = 0.0, delay = "4 ms"',
    "omega_pan": 'role = "output", column = "gyro", unit = "deg/s", offset = 3.0,'
    ' noise = 0.23, delay = "9.3 ms"',
    "i_pan": 'role = "output", column = "adc", unit = "A", scale = 0.002, offset = 2048,'
    ' noise = 0.01, delay = "4 ms"',
    "tau_shaft_pan": 'role = "output", column = "cell", unit = "N m", noise = 0.02, delay = "4 ms"',
    "omega_motor_pan": 'role = "output", column = "tacho", unit = "rpm", noise = 1.9,'
    ' delay = "4 ms"',
}
HEADINGS = {
    "u_pan": "pwm",
    "theta_pan": "enc [counts]",
    "omega_pan": "gyro [deg/s]",
    "i_pan": "adc",
    "tau_shaft_pan": "cell [N m]",
    "omega_motor_pan": "tacho [rpm]",
}


@cache
def motion(pwm: tuple[int, ...]) -> dict[str, Callable[[np.ndarray], np.ndarray]]:
    """The signals as functions of time in s, at rest before the first command acts."""
    t = TRUTH
    ends = HOLD * np.arange(len(pwm) + 1) + INPUT_DELAY
    state, pieces = np.zeros(7), []
    voltages = VOLTS_PER_COUNT * (np.array(pwm) - ZERO)
    for volts, begin, end in zip(voltages, ends[:-1], ends[1:], strict=True):

        def rates(_, y, volts=volts):
            angle, rate, gear, gear_rate, current, gyro, shunt = y
            torque = t["k_shaft_pan"] * (gear - angle) + t["d_shaft_pan"] * (gear_rate - rate)
            return [
                rate,
                (torque - t["b_pan"] * rate) / t["J_pan"],
                gear_rate,
                (RATIO * t["K_t_pan"] * current - torque) / (ROTOR * RATIO**2),
                (volts - t["R_pan"] * current - t["K_t_pan"] * RATIO * gear_rate) / INDUCTANCE,
                (rate - gyro) / LAGS["t_lag_omega_pan"],
                (current - shunt) / LAGS["t_lag_i_pan"],
            ]

        found = solve_ivp(
            rates, (begin, end), state, method="LSODA", rtol=1e-8, atol=1e-10, dense_output=True
        )
        pieces.append(found.sol)
        state = found.y[:, -1]

    def states(at: np.ndarray) -> np.ndarray:
        result = np.zeros((7, len(at)))
        index = np.clip(np.searchsorted(ends, at, side="right") - 1, -1, len(pieces) - 1)
        for k in np.unique(index[index >= 0]):
            result[:, index == k] = pieces[k](at[index == k])
        return result

    def torque(at: np.ndarray) -> np.ndarray:
        angle, rate, gear, gear_rate = states(at)[:4]
        return t["k_shaft_pan"] * (gear - angle) + t["d_shaft_pan"] * (gear_rate - rate)

    return {
        "theta_pan": lambda at: states(at)[0],
        "omega_pan": lambda at: states(at)[1],
        "omega_motor_pan": lambda at: RATIO * states(at)[3],
        "i_pan": lambda at: states(at)[4],
        "tau_shaft_pan": torque,
        "filtered_omega_pan": lambda at: states(at)[5],
        "filtered_i_pan": lambda at: states(at)[6],
    }


def write_logs(
    folder: Path, seeds: Sequence[int], extra: Sequence[str] = (), filtered: Sequence[str] = ()
) -> list[Path]:
    """One log per seed with PWM, encoder and the signals in `extra`, those in `filtered` late."""
    paths = []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        pwm = rng.integers(70, 187, round(DURATION / HOLD))
        pwm[:2] = ZERO
        true = motion(tuple(pwm))
        time = PERIOD * np.arange(round(DURATION / PERIOD))

        def seen(name: str, delay: float, true=true, time=time, rng=rng) -> np.ndarray:
            shown = true[f"filtered_{name}" if name in filtered else name](time - delay)
            return shown + NOISE.get(name, 0.0) * rng.standard_normal(len(time))

        angle = seen("theta_pan", ENCODER_DELAY) + rng.uniform(0.0, 1e-4)
        columns: Mapping[str, np.ndarray] = {
            "u_pan": np.repeat(pwm, round(HOLD / PERIOD)),
            "theta_pan": np.rint(-angle * COUNTS / (2.0 * np.pi)),
            "omega_pan": np.degrees(seen("omega_pan", GYRO_DELAY)) + 3.0,
            "i_pan": np.rint(seen("i_pan", ENCODER_DELAY) / 0.002 + 2048),
            "tau_shaft_pan": seen("tau_shaft_pan", ENCODER_DELAY),
            "omega_motor_pan": seen("omega_motor_pan", ENCODER_DELAY) * 60.0 / (2.0 * np.pi),
        }
        names = ("u_pan", "theta_pan", *extra)
        path = folder / f"bench_{seed}.csv"
        header = ",".join(["time [ms]", *(HEADINGS[n] for n in names)])
        table = np.column_stack([1e3 * time, *(columns[n] for n in names)])
        np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")
        paths.append(path)
    return paths


def platform_text(free: Sequence[str], extra: Sequence[str] = (), effects: str = "") -> str:
    """The platform with the parameters in `free` begun at 1.7 times their values."""
    known = {"L_pan": INDUCTANCE, "J_motor_pan": ROTOR, "N_pan": RATIO}
    lines = ['[platform]\nname = "bench"\naxes = ["pan"]']
    lines.append('[[effects]]\neffect = "rigid_bodies"')
    for effect in ("viscous_friction", "shaft_compliance", "dc_motor"):
        lines.append(f'[[effects]]\neffect = "{effect}"\naxis = "pan"')
    lines += [effects, "[parameters]"]
    lines += [f"{name} = {{ value = {value} }}" for name, value in known.items()]
    for name, value in TRUTH.items():
        begun = f"start = {1.7 * value!r}" if name in free else f"value = {value}"
        lines.append(f"{name} = {{ {begun} }}")
    lines.append("[signals]")
    lines += [f"{name} = {{ {SIGNALS[name]} }}" for name in ("u_pan", "theta_pan", *extra)]
    return "\n".join(lines) + "\n"
