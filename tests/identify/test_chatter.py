"""A gear pressed on a face that gives back all of its speed bounces for ever, once every
2 sqrt(gap / pull): a fit must not wait for that.
"""

import math

import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.constants import BOUNCES, CHATTER
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, evaluate
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("dc_motor", "pan", None),
    EffectDeclaration("backlash", "pan", None, "elastic_impact"),
)
SIGNALS = (
    SignalDeclaration("u_pan", "voltage", "V", "input", None),
    SignalDeclaration("theta_pan", "angle", "rad", "output", 7200),
)
PLATFORM = Platform("pressed", "Gear on a face", ("pan",), 9.81, EFFECTS, (), SIGNALS)
ROTOR, TORQUE, GAP, PERIOD = 0.02, 0.05, 1e-6, 1.0  # kg m^2, N m, rad, s


def evaluation(
    restitution: float, samples: int = 6, period: float = PERIOD
) -> tuple[Evaluation, int]:
    """A motor of unit ratio that a constant voltage presses against its load; and the work that
    counts for it.
    """
    model = emission.emit(PLATFORM)
    time = np.arange(samples) * period
    log = Log("pressed", time, np.full((len(time), 1), 500.0), np.zeros((len(time), 1)))
    (run,) = prepare_runs(model, PLATFORM, [log])
    given = {"J_pan": 0.05, "J_motor_pan": ROTOR, "N_pan": 1.0, "L_pan": 1e-3, "R_pan": 10.0}
    given |= {"K_t_pan": TORQUE / 50.0, "gap_pan": GAP, "e_gap_pan": restitution}
    p, none = model.parameter_vector(given), np.zeros(0, dtype=np.int64)
    return evaluate(model, run, p, run.guess, none, False, Tolerance()), run.work.samples


def test_bounces_that_never_end_end_a_simulation_of_a_fit() -> None:
    bounces = PERIOD / (2.0 * math.sqrt(2.0 * GAP / 2.0 / (TORQUE / ROTOR)))
    assert bounces > CHATTER, "a sample holds more than what counts as chatter"
    found, work = evaluation(1.0)
    assert found.failed is not None
    assert f"after {6 * CHATTER:.0f} steps" in found.failed
    assert work == 6 * CHATTER, "what takes many steps a sample uses up the allowance sooner"


@pytest.mark.parametrize("period", [1.0, 20.0])
def test_bounces_that_never_end_end_a_long_run_soon(period: float) -> None:
    """At the average of a sample alone, it would go on ten times as long."""
    samples = 10 * int(BOUNCES / CHATTER)
    found, work = evaluation(1.0, samples, period)
    assert found.failed is not None
    bounces = period / (2.0 * math.sqrt(GAP / (TORQUE / ROTOR)))
    assert BOUNCES <= work < BOUNCES + CHATTER * (1.0 + BOUNCES / (bounces - CHATTER))
    assert work < 0.2 * CHATTER * samples


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
def test_bounces_that_die_down_are_simulated_to_the_end(restitution: float) -> None:
    found, work = evaluation(restitution)
    assert found.failed is None
    assert work >= 6
