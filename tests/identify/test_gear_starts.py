"""A gear that runs out of true begins in its gap, wherever its error puts the faces."""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.evaluate import start_state
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import read_platform

PLATFORM = Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml"
HALF_GAP = np.radians(1.49) / 2.0


@pytest.mark.long
def test_the_place_in_a_gap_is_that_of_the_twist_a_gear_error_included() -> None:
    """The gear leads the joint by its angle and its transmission error, g sin(angle) and so on; at
    place 1 it is half the gap, but for the change of the error over the gap. Tangents are those of
    differences.
    """
    platform = read_platform(PLATFORM)
    model = emission.emit(variants.with_candidates(platform))
    t = np.arange(100) * 0.005
    log = Log("rest", t, np.zeros((100, 1)), np.tile([0.0, 0.3], (100, 1)))
    (run,) = prepare_runs(model, platform, (log,))
    names = ("g_sin_pan", "g_cos_pan", "gap_pan")
    columns = np.array([model.parameter_names.index(name) for name in names])
    gear, joint = model.module.CONTACT_ANGLES[0]

    def begun(place: float, sine: float, cosine: float, gap: float) -> tuple[float, np.ndarray]:
        p = model.parameter_vector({"g_sin_pan": sine, "g_cos_pan": cosine, "gap_pan": gap})
        z = np.array([place if u.contact is not None else 0.0 for u in run.unknowns])
        x, s = start_state(model, run, p, z, columns)
        error = sine * np.sin(x[gear]) + cosine * np.cos(x[gear])
        assert x[gear] + error - x[joint] == pytest.approx(place * 0.5 * gap, rel=0.02, abs=1e-7)
        return float(x[gear]), s[gear]

    at = (0.02, 0.013, 2.0 * HALF_GAP)
    for place in (-1.0, 0.0, 1.0):
        _, slope = begun(place, *at)
        for k in range(3):
            ends = []
            for way in (1.0, -1.0):
                shifted = list(at)
                shifted[k] += way * 1e-5
                ends.append(begun(place, *shifted)[0])
            assert slope[k] == pytest.approx((ends[0] - ends[1]) / 2e-5, abs=2e-3)
