"""A turntable on a spring and a damper as a model to experiment with, and its closed form."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy.linalg import expm

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.experiment.machine import Conditions, Contender, Limit, without_logs
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform, read_platform
from tests.diagnose.spring_table import PAYLOAD, PERIOD, PLATFORM
from tests.identify.curves import Floats

VALUES = {"J_pan": 0.05, "b_pan": 0.1, "k1_cable_pan": 0.8}
KNOWN = {"m_payload": 2.0, "c_x_payload": 0.1, "c_y_payload": 0.0, "J_z_payload": 0.0}
INERTIA = VALUES["J_pan"] + PAYLOAD
NOISE = 1e-4  # rad
BOUNDS = {"tau0_pan": (-1.0, 1.0), "k1_cable_pan": (0.0, 10.0)}
AMPLITUDE = 0.2  # N m


def table(folder: Path) -> tuple[Platform, Model]:
    """The platform, its angle with white noise and its torque without, and the model of it and of
    all candidates.
    """
    path = folder / "table.toml"
    path.write_text(PLATFORM)
    platform = read_platform(path)
    sensed = tuple(
        replace(s, noise=1e-12 if s.role == "input" else NOISE, counts_per_revolution=None)
        for s in platform.signals
    )
    return replace(platform, signals=sensed), emitted(platform)


@cache
def emitted(platform: Platform) -> Model:
    """The model, emitted once."""
    return emission.emit(variants.with_candidates(platform))


def contender(model: Model, name: str, free: tuple[str, ...], **values: float) -> Contender:
    """The table with `values` in place of its own, of which `free` are to be fitted."""
    by_name = {p.name: p for p in model.parameters}
    off = {p.name: p.vanishes for p in model.parameters if p.vanishes is not None}
    every = {**model.defaults, **off, **KNOWN, **VALUES, **values}
    own = []
    for f in free:
        lower, upper = BOUNDS.get(f, (by_name[f].lower, by_name[f].upper))
        own.append(free_parameter(f, every[f], lower, upper))
    return without_logs(name, model, own, every)


def conditions(platform: Platform, duration: float) -> Conditions:
    """A run of `duration` s with a torque of at most AMPLITUDE either way."""
    t = np.arange(round(duration / PERIOD)) * PERIOD
    limits = {"tau_pan": Limit("tau_pan", -AMPLITUDE, AMPLITUDE)}
    return Conditions(platform, t, limits, {})


def motion(torque: Floats, angle: float = 0.0, rate: float = 0.0, **change: float) -> Floats:
    """Angle [k] of J theta'' = tau + tau0 - k theta - b theta', the torque held per sample."""
    m = {"J": INERTIA, "b": VALUES["b_pan"], "k": VALUES["k1_cable_pan"], "tau0": 0.0}
    m = {name: value + change.get(name, 0.0) for name, value in m.items()}
    flow = np.zeros((3, 3))
    flow[0, 1], flow[1] = 1.0, np.array([-m["k"], -m["b"], 1.0]) / m["J"]
    step = expm(PERIOD * flow)
    state, angles = np.array([angle, rate]), np.zeros(len(torque))
    for k, applied in enumerate(torque):
        angles[k] = state[0]
        state = (step @ [*state, applied + m["tau0"]])[:2]
    return angles
