"""What the ledger books where: supply and losses of every effect, from the states of a run and laws
written down here.

Each effect is at work alone, on one of three machines that carry them all, or on one of its own.
Power in is that of torques at joints and of voltages at the terminals of motors, of a prescribed
motion and of a base that shakes; everything else that leaves the machine is lost, and what a spring
or a field gives back was stored.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

from ptp_symbolic import simulate
from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.numeric.simulation.signals.inputs import multisine
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.effects import EFFECTS
from tests.effects.bases import BASES

TIMES = np.arange(0.0, 2.0 + 5e-5, 1e-4)
CLOSE = 2e-4  # of all that went through: quadrature across friction's jumps and contacts


@dataclass(frozen=True)
class Run:
    """States of a trajectory by name, parameters by name, and inputs as functions of time in s."""

    found: Trajectory
    p: Mapping[str, float]
    inputs: Mapping[str, Callable[[np.ndarray], np.ndarray]]

    def __getattr__(self, name: str) -> np.ndarray:
        return self.found[name]

    @property
    def t(self) -> np.ndarray:
        return self.found.t

    def given(self, name: str, late: float = 0.0) -> np.ndarray:
        """An input as it is given, or was some time ago; zero before the run."""
        then = self.t - late
        return np.where(then < 0.0, self.inputs[name](np.zeros(1)), self.inputs[name](then))


Power = Callable[[Run], np.ndarray]


def wave(amplitudes: list[float], frequencies: list[float]) -> Callable[[np.ndarray], np.ndarray]:
    """A sum of sines, of amplitudes and frequencies in Hz."""
    pairs = list(zip(amplitudes, frequencies, strict=True))
    return lambda t: sum(a * np.sin(2.0 * np.pi * f * t) for a, f in pairs)
