"""Logs whose motion is known in closed form, and the problem to find what their platform lacks.

A body on a spring and a damper under a torque that is held from sample to sample: its motion is a
matrix exponential. The platform declares the damper, and a payload of known mass, alone.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from scipy.linalg import expm

from ptp_symbolic.models import declared, emission, variants
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem
from ptp_symbolic.numeric.diagnose.preparation import problem_of
from ptp_symbolic.numeric.identify.constants import MATERIAL
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.preparation import effect_keys

INERTIA, DAMPING, STIFFNESS = 0.05, 0.1, 0.8  # kg m^2, N m s/rad, N m/rad
MASS = 2.0  # kg, of a payload
PAYLOAD = MASS * 0.1**2  # kg m^2, of the inertia
PERIOD, SAMPLES = 0.01, 600
COUNT = 2.0 * np.pi / 65536
PLATFORM = """[platform]
name = "table"
title = "A turntable"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "payload"
[[effects]]
effect = "viscous_friction"
axis = "pan"
[parameters.J_pan]
start = 0.06
unit = "kg m^2"
bounds = [0.001, 1.0]
[parameters.b_pan]
start = 0.15
unit = "N m s/rad"
bounds = [0.0, 10.0]
[parameters.m_payload]
value = 2.0
unit = "kg"
[parameters.c_x_payload]
value = 0.1
unit = "m"
[parameters.c_y_payload]
value = 0.0
unit = "m"
[parameters.J_z_payload]
value = 0.0
unit = "kg m^2"
[signals.tau_pan]
role = "input"
column = "torque"
unit = "N m"
[signals.theta_pan]
role = "output"
column = "angle"
unit = "rad"
counts_per_revolution = 65536
"""
GYRO_NOISE = 0.002  # rad/s
GYRO = f"""[signals.omega_pan]
role = "output"
column = "gyro"
unit = "rad/s"
noise = {GYRO_NOISE}
"""


def log(
    seed: int,
    stiffness: float = STIFFNESS,
    gust: float = 0.0,
    lasting: int = 1,
    late: int = 0,
    gyro: bool = False,
) -> Log:
    """Six seconds under a torque that changes every half second, so many samples `late`, and under
    one that is not logged and changes after so many samples, `gust` (rms) in N m. The rate is
    logged too where there is a `gyro`.
    """
    rng = np.random.default_rng(seed)
    torque = np.repeat(rng.uniform(-0.5, 0.5, SAMPLES // 50), 50)
    acting = np.concatenate([np.zeros(late), torque[: SAMPLES - late]])
    acting += gust * np.repeat(rng.standard_normal(SAMPLES // lasting), lasting)
    flow = np.zeros((3, 3))
    flow[0, 1], flow[1] = 1.0, [-stiffness / INERTIA, -DAMPING / INERTIA, 1.0 / INERTIA]
    step = expm(PERIOD * flow)
    state = np.zeros((SAMPLES, 2))
    for k in range(SAMPLES - 1):
        state[k + 1] = (step @ [*state[k], acting[k]])[:2]
    reading = np.rint(state[:, :1] / COUNT) * COUNT
    if gyro:
        rate = state[:, 1:] + GYRO_NOISE * rng.standard_normal((SAMPLES, 1))
        reading = np.hstack([reading, rate])
    return Log(f"run_{seed}", PERIOD * np.arange(SAMPLES), torque[:, None], reading)


@contextmanager
def spring_table(
    folder: Path,
    stiffness: float = STIFFNESS,
    gust: float = 0.0,
    lasting: int = 1,
    gyro: bool = False,
) -> Iterator[SearchProblem]:
    """The problem, its platform written to `folder`; the other arguments are those of `log`."""
    text = PLATFORM + GYRO if gyro else PLATFORM

    def logged(seed: int) -> Log:
        return log(seed, stiffness, gust, lasting, gyro=gyro)

    with table_of(folder, logged, text=text) as problem:
        yield problem


@contextmanager
def table_of(
    folder: Path,
    logged: Callable[[int], Log],
    validation: tuple[int, ...] = (3,),
    text: str = PLATFORM,
) -> Iterator[SearchProblem]:
    """The problem of the platform `text`, written to `folder`, with what is `logged` by seed, two
    logs to be fitted, and others for `validation`.
    """
    path = folder / "table.toml"
    path.write_text(text)
    platform = read_platform(path)
    model = emission.emit(variants.with_candidates(platform))
    train, validate = (
        prepare_runs(model, platform, [logged(seed) for seed in seeds])
        for seeds in ((1, 2), validation)
    )
    free, known = declared.free_parameters(platform, model), declared.known_values(platform, model)
    noises = {signal.signal: signal.noise for signal in platform.signals}
    with ThreadPoolExecutor(2) as executor:
        yield problem_of(
            model,
            train,
            validate,
            free,
            known,
            effect_keys(platform),
            noises,
            None,
            MATERIAL,
            executor,
            lambda text: None,
        )
