"""Hidden structures: what a set tells of them, the commands that show them, their figures."""

import dataclasses
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from tests.benchmark.catalogue import catalogue
from tests.benchmark.delays import DelayedVariation
from tests.benchmark.entry import Entry, Planted
from tests.benchmark.machines import MACHINES
from tests.benchmark.rigid_pan_machine import RIGID_PAN, switching
from tests.benchmark.score import score
from tests.benchmark.sets import generate
from tests.benchmark.table import Result, structure_rows
from tests.benchmark.variation import Variation

PLAIN = Variation(counts=65_536, period=0.01, current=False)


def hidden(machine: str, kind: str, *planted: Planted, variation: Variation = PLAIN) -> Entry:
    """An entry at 100 Hz, so that it is quick."""
    return Entry("x", machine, kind, planted, 77, variation, "build")


def test_a_visible_shaft_beside_a_gap_is_told_and_a_stiff_one_is_allowed(tmp_path: Path) -> None:
    gap = Planted("backlash", "pan", math.radians(1.0))
    truth = generate(hidden("rigid_pan", "structure", gap), tmp_path / "gap")
    assert (truth["effects"], truth["allowed"]) == (["backlash"], ["shaft_compliance@pan"])
    assert truth["hidden"]["k_shaft_pan"] >= 2e4
    assert "gap_pan" in truth["parameters"]
    assert "k_shaft_pan" not in truth["parameters"]
    platform = tomllib.loads((tmp_path / "gap" / "platform.toml").read_text())
    named = {one["effect"] for one in platform["effects"]}
    assert not named & {"shaft_compliance", "backlash"}
    assert not {"k_shaft_pan", "d_shaft_pan", "gap_pan"} & set(platform["parameters"])
    soft = Planted("shaft_compliance", "tilt", 60.0)
    truth = generate(hidden("tilt_servo", "structure", soft), tmp_path / "shaft")
    assert truth["parameters"]["k_shaft_tilt"] == 60.0
    assert truth["response_floors"] > 5.0
    assert truth["planted"][0]["response_floors"] == pytest.approx(5.0 * truth["level"][0])


@pytest.mark.parametrize("kind", ["", "known", "free"])
@pytest.mark.parametrize("name", ["rigid_pan", "direct_drive"])
def test_delays_are_true_and_declared(name: str, kind: str) -> None:
    variation = DelayedVariation(**dataclasses.asdict(PLAIN), delays=kind)
    machine = MACHINES[name]
    values = machine.draw(np.random.default_rng(1), variation)
    platform = machine.declared(values, variation)
    declared = platform["parameters"].get("t_delay_pan", {})
    assert ("t_delay_pan" in values) == bool(kind)
    assert ("t_delay_pan" in machine.free(variation)) == (kind == "free")
    assert set(declared) == {"": set(), "known": {"value"}, "free": {"start", "bounds"}}[kind]
    assert {"effect": "input_delay", "axis": "pan"} in platform["effects"] or not kind


def test_switching_is_of_unit_size_with_the_holds_asked_for() -> None:
    time = 0.001 * np.arange(8000)
    wave = switching(np.random.default_rng(2), time)
    assert set(np.unique(wave)) == {-1.0, 0.0, 1.0}
    holds = np.diff(time[1:][np.diff(wave) != 0.0])
    assert 0.014 <= holds.min() < holds.max() <= 0.182


def test_commands_stay_within_the_supply() -> None:
    rng = np.random.default_rng(3)
    runs = RIGID_PAN.runs(rng, RIGID_PAN.draw(rng, PLAIN), PLAIN)
    assert len(runs) == 8
    assert max(np.abs(run.command).max() for run in runs) <= 24.0


def result(kind: str, named: str | None, floors: float = 9.0, **others: object) -> Result:
    """A set with a gap, or with nothing, and what was said of it."""
    effects = [] if kind == "structure_null" else ["backlash"]
    planted = [{"effect": "backlash", "response_floors": floors}] if effects else []
    truth = {"kind": kind, "effects": effects, "axes": ["pan"] * len(effects), "hidden": {}}
    truth |= {"planted": planted, "small_deviations": False, "allowed": []} | others
    added = [{"effect": named, "axis": "pan", "confusable_with": [], "parameters": {}}]
    diagnosis = {"verdict": "explained" if named else "nothing_missing"}
    diagnosis["added"] = added if named else []
    return Result(truth, diagnosis, {"wall_s": 1.0, "peak_mb": 1.0}, score(truth, diagnosis))


def test_figures_of_structures_tell_visible_ones_from_faint_ones_and_from_none() -> None:
    results = [
        result("structure", "backlash"),
        result("structure", None),
        result("structure", None, floors=2.0),
        result("structure_pair", "backlash"),
        result("structure_null", None),
        result("structure_null", "cogging", small_deviations=True),
        result("perfect", None),
    ]
    rows = {row["name"]: row for row in structure_rows(results)}
    counts = {name: (row["count"], row["right"]["hits"]) for name, row in rows.items()}
    assert counts == {
        "backlash": (2, 1),
        "backlash and a term": (1, 1),
        "all alone": (2, 1),
        "all with a term": (1, 1),
        "too faint": (1, 0),
        "null, perfect": (1, 1),
        "null, small deviations": (1, 0),
    }
    assert rows["null, small deviations"]["wrong"]["hits"] == 1
    assert structure_rows([result("perfect", None)]) == []


def test_machines_that_lack_nothing_come_with_every_kind_of_delay_and_little_noise() -> None:
    nulls = [entry for entry in catalogue() if entry.kind == "structure_null"]
    kinds = {entry.variation.delays for entry in nulls}  # type: ignore[attr-defined]
    assert kinds == {"", "known", "free"}
    assert all(entry.variation.noise_counts <= 3.0 for entry in nulls)
