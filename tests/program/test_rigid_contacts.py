"""Derivatives that a module with rigid contacts emits, against differences, in its modes."""

from types import ModuleType

import numpy as np
import pytest

from ptp_symbolic.models import emission
from tests.effects.test_backlash_kinds import KINDS, PAYLOAD, platform

MODES = ((1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (1.0, 1.0, 1.0), (0.0, -1.0, 1.0))
KERNELS = ("mode_derivative", "guards", "impacts")


def values(
    module: ModuleType, name: str, rows: int, z: np.ndarray, u: np.ndarray, m: np.ndarray
) -> np.ndarray:
    """What the kernel `name` writes at state and parameters z."""
    n, out = len(module.STATE_NAMES), np.zeros(rows)
    getattr(module, name)(0.0, z[:n].copy(), u, z[n:].copy(), m, out)
    return out


@pytest.mark.parametrize("modes", MODES)
@pytest.mark.parametrize("kind", KINDS)
def test_emitted_derivatives_in_every_mode(kind: str, modes: tuple[float, ...]) -> None:
    model = emission.emit(platform(kind, "payload", "csvs_friction", site="gear"))
    rng, module, p = np.random.default_rng(3), model.module, model.parameter_vector(PAYLOAD)
    x, u, m = rng.normal(size=len(model.state_names)), rng.normal(size=2), np.array(modes)
    n, z = len(x), np.concatenate([x, p])
    struck = np.zeros((n + 2, n)), np.zeros((n + 2, len(p)))
    module.impact_jacobian(0.0, x, u, p, m, *struck)
    there = model.derivatives(0.0, x, u, p, m)
    pairs = ((there.fx, there.fp), (there.gx, there.gp), struck)
    for name, (by_x, by_p) in zip(KERNELS, pairs, strict=True):
        rows = len(by_x)
        for k, found in enumerate(np.hstack([by_x, by_p]).T):
            h = 1e-5 * max(abs(z[k]), 1e-3)
            above, below = z.copy(), z.copy()
            above[k] += h
            below[k] -= h
            ends = [values(module, name, rows, each, u, m) for each in (above, below)]
            expected = (ends[0] - ends[1]) / (2.0 * h)
            assert found == pytest.approx(expected, rel=1e-5, abs=1e-6 * (1 + abs(found).max()))
