"""The energy ledger closes to a millionth of what went through, however stiff the machine."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numba import njit

import ptp_symbolic
from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, multisine, step, table
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import read_platform
from tests.simulation.block import block

PAN_AXIS = Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml"
TIMES = np.arange(0.0, 1.0, 5e-3)
SIGNALS = {
    "step": step(0.0, 24.0, 0.25),
    "multisine": multisine([12.0, 5.0], [0.8, 2.1]),
    "samples": table(TIMES, 12.0 * np.sin(5.0 * TIMES) + 3.0 * np.sin(31.0 * TIMES), "hold"),
    "square": table(TIMES[::20], 12.0 * (-1.0) ** np.arange(len(TIMES[::20])), "hold"),
}


def missing(found: Trajectory) -> float:
    """What the ledger misses, per energy that went through."""
    gap = found.stored - found.stored[0] - found.supplied + found.dissipated
    return float(np.abs(gap).max() / max(np.abs(found.dissipated).max(), found.supplied.max()))


@pytest.fixture(scope="module")
def everything() -> tuple[Model, dict[str, float]]:
    """The pan axis of the logs with every effect that it can have, and each of them at work."""
    base = read_platform(PAN_AXIS)
    more = {e.effect: e for e in variants.candidate_effects(base)}
    given = {e.effect for e in base.effects}
    added = tuple(e for name, e in more.items() if name not in given)
    model = emission.emit(replace(base, effects=(*base.effects, *added)))
    at_work = {
        p.name: p.starts[0] for p in model.parameters if p.starts and p.default == p.vanishes
    }
    assert len(model.parameters) > 50 and len(at_work) > 15
    return model, at_work


@pytest.mark.parametrize("inductance", [None, 1e-4, 1e-6, 1e-9])
@pytest.mark.parametrize("name", SIGNALS)
def test_windings_of_any_stiffness(name: str, inductance: float | None) -> None:
    """Resistance over inductance up to 1e10 per second: transients that steps leap over."""
    for kind, axes in {"pan_drive": ("pan",), "full": ("pan", "tilt")}.items():
        model = ptp_symbolic.load(kind)
        stiff = {} if inductance is None else {f"L_{axis}": inductance for axis in axes}
        inputs = {f"u_{axis}": SIGNALS[name] for axis in axes}
        found = ptp_symbolic.simulate(model, 1.0, inputs, stiff)
        assert missing(found) <= 1e-6
        assert np.diff(found.dissipated).min() >= -1e-12


@pytest.mark.parametrize("name", SIGNALS)
def test_everything_switched_on(everything, name: str, figure) -> None:
    model, at_work = everything
    for inductance in (6.9e-3, 1e-7):
        parameters = {**at_work, "L_pan": inductance}
        found = ptp_symbolic.simulate(model, 1.0, {"u_pan": SIGNALS[name]}, parameters)
        assert figure("missing in the ledger, of throughput", missing(found)) <= 1e-6
        assert figure("least dissipation, J", np.diff(found.dissipated).min()) >= -1e-12


@pytest.mark.parametrize("method", ["rosenbrock", "runge_kutta"])
def test_a_stribeck_peak_as_narrow_as_a_wall(method: str) -> None:
    """Friction leaps within a millionth of a radian per second, where a reversal ends a step."""
    found = ptp_symbolic.simulate(
        ptp_symbolic.load("pan_drive"),
        1.0,
        {"u_pan": SIGNALS["square"]},
        {"v_s_pan": 1e-6},
        method=method,
    )
    assert len(found.events) > 10
    assert missing(found) <= 1e-6


@njit(error_model="numpy", nogil=True)
def energy_that_forgets_the_input(t, x, u, p, m, e):
    e[0] = 0.5 * p[0] * x[1] ** 2 + 0.5 * p[1] * x[0] ** 2 + 0.25 * p[4] * x[0] ** 4
    e[1] = 0.0
    e[2] = m[0] * p[2] * x[1]


def test_energies_that_do_not_balance_do_not_stop_a_run() -> None:
    sound, wrong = block(), block()
    vars(wrong.module)["energy"] = energy_that_forgets_the_input
    inputs = {"tau_pan": constant(2.0)}
    one, other = (ptp_symbolic.simulate(body, 5.0, inputs) for body in (sound, wrong))
    assert missing(one) <= 1e-6 < missing(other)
    assert other["theta_pan"] == pytest.approx(one["theta_pan"], abs=1e-8)
    assert other.steps < one.steps + 5000
