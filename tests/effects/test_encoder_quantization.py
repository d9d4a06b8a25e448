"""Encoder that counts: a staircase of whole counts, nearest to the angle."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

BODY = EffectDeclaration("rigid_bodies", None, None)
COUNTER = EffectDeclaration("encoder_quantization", "pan", None)
DISC = EffectDeclaration("encoder_eccentricity", "pan", None)
COUNT = 2 * math.pi / 7200


def counted(*effects: EffectDeclaration) -> Model:
    return emission.emit(
        Platform("counts", "Counted angle", ("pan",), 9.81, (BODY, *effects), (), ())
    )


def reading(model: Model, angle: float, **values: float) -> float:
    y = np.zeros(1)
    x, p = np.array([angle, 0.3]), model.parameter_vector(values)
    model.module.outputs(0.0, x, np.zeros(1), p, y)
    return float(y[0])


@pytest.fixture(scope="module")
def model() -> Model:
    return counted(COUNTER)


def test_default_is_the_encoder_of_table_5_7() -> None:
    platform = Platform("counts", "", ("pan",), 9.81, (BODY, COUNTER), (), ())
    (count,) = [p for p in assemble(platform).parameters if p.name == "q_count_pan"]
    assert count.default == pytest.approx(COUNT, rel=1e-15)


def test_the_reading_steps_half_way_between_counts(model: Model) -> None:
    for whole in (-7201, -3, -1, 0, 1, 2, 3600):
        for part in (-0.499, -0.2, 0.0, 0.3, 0.499):
            seen = reading(model, (whole + part) * COUNT, q_count_pan=COUNT)
            assert seen == pytest.approx(whole * COUNT, abs=1e-12)


def test_error_is_spread_evenly_over_a_count(model: Model) -> None:
    """At most half a count, rms count/sqrt(12)."""
    angles = np.linspace(-1.0, 1.0, 20001)
    error = np.array([reading(model, a, q_count_pan=0.01) - a for a in angles])
    assert np.max(np.abs(error)) <= 0.005 * (1 + 1e-9)
    assert np.sqrt(np.mean(error**2)) == pytest.approx(0.01 / math.sqrt(12), rel=1e-3)


@pytest.mark.parametrize("effects", [(COUNTER, DISC), (DISC, COUNTER)])
def test_it_counts_what_the_disc_shows(effects: tuple[EffectDeclaration, ...]) -> None:
    """The disc turns first, the counter reads it: a whole count, in whatever order declared."""
    seen = reading(counted(*effects), 1.0, q_count_pan=0.01, e_sin_pan=0.05)
    assert seen == pytest.approx(1.04, abs=1e-12)


def test_the_motion_knows_nothing_of_it(model: Model) -> None:
    found = simulate(model, 0.1, {"tau_pan": constant(1.0)}, {"J_pan": 0.5, "q_count_pan": 0.1})
    assert found["theta_pan"] == pytest.approx(found.t**2, abs=1e-12)
