"""Planted and found: every effect that can be searched for, hidden in made logs, comes out by name.

The logs are made by the fixed-step method, which shares neither events nor linear algebra with the
one that fits, and are rounded to encoder counts. Effects that no machine below can show say so.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic import loop
from ptp_symbolic.derivation.placement import place_effects
from ptp_symbolic.diagnosis_run import diagnose_platform
from ptp_symbolic.effects import EFFECTS
from ptp_symbolic.effects.effect import Effect
from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.simulation.inputs import table
from ptp_symbolic.simulation.run import simulate
from tests.independent import pan_logs

PLATFORMS = Path(__file__).parents[1] / "platforms"
MACHINES = ("fieldlog_pan", "fieldlog_two_axis")
COUNT = 2.0 * math.pi / 7200
PERIOD, STEP = 0.005, 1e-4
HEADER = "time [s],pan_voltage [V],pan_current [A],pan_angle [rad]"
ABSORBED = {"payload_com_offset"}  # on a level pan axis it is moment of inertia and nothing else
SEARCHED = [effect for effect in EFFECTS if not effect.structural]
RUNS = ("train/crawl", "train/multisine_1", "train/ramp_crawl", "train/staircase", "train/step_cw",
        "validate/crawl_cw", "validate/multisine_2", "validate/trapezoid_cw")  # fmt: skip


def without(platform: Platform, effect: Effect) -> Platform:
    """`platform` without `effect` and its parameters."""
    own = {
        q.name for e, place in place_effects(platform) if e is effect for q in e.parameters(place)
    }
    return replace(
        platform,
        effects=tuple(d for d in platform.effects if d.effect != effect.id),
        parameters=tuple(p for p in platform.parameters if p.name not in own),
    )


def machine_for(effect: Effect) -> tuple[Platform, Platform] | None:
    """The first machine that runs without `effect`, and the same machine with it."""
    for name in MACHINES:
        bare = without(read_platform(PLATFORMS / f"{name}.toml"), effect)
        try:
            found = [d for d in loop.candidate_effects(bare) if d.effect == effect.id]
        except InputError:
            continue
        if found:
            return bare, replace(bare, effects=(*bare.effects, found[0]))
    return None


def write_runs(platform: Platform, planted: EffectDeclaration, folder: Path) -> None:
    """Logs of `platform`, which carries the planted effect at the first of its finite starts."""
    model = loop.emit(platform)
    own = next(e for e in model.effects if e.key.partition("@")[0] == planted.effect)
    values = {
        p.name: p.starts[-1] for p in model.parameters if p.name in own.parameters and p.starts
    }
    values |= {d.name: d.value for d in platform.parameters}
    rng = np.random.default_rng(11)
    for run, voltage in pan_logs.profiles(rng).items():
        if run not in RUNS:
            continue
        t = PERIOD * np.arange(len(voltage))
        found = simulate(
            model, t, {"u_pan": table(t, voltage, "hold")}, values, method="fixed_step", step=STEP
        )
        reading = np.rint(found["theta_pan"] / COUNT) * COUNT
        current = found["i_pan"] + 0.004 * rng.standard_normal(len(t))
        columns = zip(t, voltage, current, reading, strict=True)
        rows = [f"{a:.4f},{b:.5f},{c:.5f},{d:.7f}" for a, b, c, d in columns]
        path = folder / f"{run}.csv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join([HEADER, *rows, ""]))


@pytest.mark.long
@pytest.mark.parametrize("effect", SEARCHED, ids=lambda effect: effect.id)
def test_planted_effect_is_found(effect: Effect, tmp_path: Path) -> None:
    machine = machine_for(effect)
    if machine is None or "u_pan" not in {s.signal for s in machine[0].signals}:
        pytest.skip("no voltage-driven machine of these tests can show it")
    bare, full = machine
    write_runs(full, full.effects[-1], tmp_path)
    found = diagnose_platform(bare, [tmp_path / "train"], [tmp_path / "validate"]).summary
    named = {a["effect"] for a in found["added"]}
    group = {k.partition("@")[0] for a in found["added"] for k in a["confusable_with"]}
    invisible = {c["effect"] for c in found["not_visible"]}
    unseen = effect.id in invisible or effect.id in ABSORBED
    assert effect.id in named | group or (not named and unseen), found["summary"]
