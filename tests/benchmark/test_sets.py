"""What a set is made of: noise, stalls, sizes, files; the same bytes every time."""

import csv
import dataclasses
import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from tests.benchmark import references
from tests.benchmark.catalogue import catalogue
from tests.benchmark.effects import Scene, constant_torque, encoder_eccentricity
from tests.benchmark.entry import Entry
from tests.benchmark.logs import encoder_noise
from tests.benchmark.machine import hold_in_stalls, random_walk, stalls
from tests.benchmark.machines import MACHINES
from tests.benchmark.sets import generate
from tests.benchmark.sizing import Yardstick, rms
from tests.benchmark.variation import Variation

QUICK = Variation(counts=65_536, period=0.01, current=False)


def first(machine: str, kind: str) -> Entry:
    """The first entry of a machine and kind, at 100 Hz so that it is quick."""
    entry = next(e for e in catalogue() if (e.machine, e.kind) == (machine, kind))
    return dataclasses.replace(entry, variation=dataclasses.replace(entry.variation, period=0.01))


def yardstick(name: str, variation: Variation) -> Yardstick:
    """The yardstick of a machine with nothing hidden."""
    machine, rng = MACHINES[name], np.random.default_rng(3)
    values = machine.draw(rng, variation)
    runs = machine.runs(rng, values, variation)
    training = [machine.record(values, run) for run in runs if run.path.startswith("train/")]
    return Yardstick(machine, values, training, variation)


def test_coloured_noise_has_the_stated_size_and_pole() -> None:
    variation = dataclasses.replace(
        QUICK, noise_kind="coloured", noise_counts=3.0, noise_pole=0.9, counts=7_200
    )
    rng = np.random.default_rng(0)
    noise = encoder_noise(rng, 400_000, variation) * 7_200 / (2 * math.pi)
    assert np.std(noise) == pytest.approx(3.0, rel=0.02)
    assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(0.9, abs=0.003)
    starts = [encoder_noise(rng, 2, variation)[0] for _ in range(4000)]
    assert np.std(starts) * 7_200 / (2 * math.pi) == pytest.approx(3.0, rel=0.05)


def test_a_gust_forgets_itself_in_its_correlation_time() -> None:
    gust = random_walk(np.random.default_rng(0), 400_000, 0.01, 0.5)
    assert np.std(gust) == pytest.approx(1.0, rel=0.03)
    assert np.corrcoef(gust[50:], gust[:-50])[0, 1] == pytest.approx(math.exp(-1.0), abs=0.02)


def test_a_stall_drops_rows_and_holds_the_command() -> None:
    kept = stalls(np.random.default_rng(0), 2000, 0.02)
    assert kept[0]
    assert 0.01 < np.mean(~kept) <= 0.02
    command = np.arange(2000.0)
    held = hold_in_stalls(command, kept)
    assert np.all(held[kept] == command[kept])
    assert np.all(np.diff(held)[~kept[1:]] == 0.0)


def test_references_keep_within_their_reach_and_rate() -> None:
    t = np.arange(800) * 0.01
    wave = references.waves(t, np.random.default_rng(0), 2.7, 1.5)
    assert np.max(np.abs(wave)) <= 2.7 + 1e-12
    assert np.max(np.abs(np.gradient(wave, 0.01))) <= 1.5 + 1e-12
    creep = references.creeps(t, -2.7, 2.7, (0.1, 0.8, 0.3))
    assert (creep[0], creep[-1]) == pytest.approx((-2.7, 2.7), abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("name", ["pan_drive", "direct_drive"])
def test_changes_of_parameters_and_starts_are_not_visible(name: str) -> None:
    measure = yardstick(name, QUICK)
    hidden = {"J_pan": measure.values["J_pan"] * 1.01, "F_c_pan": measure.values["F_c_pan"] * 1.002}
    change, _ = measure.change(hidden)
    raw = [
        measure.machine.readings(
            measure.values, measure.machine.replay({**measure.values, **hidden}, one), QUICK
        )
        - measure.machine.readings(measure.values, one.states, QUICK)
        for one in measure.recordings
    ]
    before = rms(np.vstack(raw)) / measure.floors[0]
    assert before > 0.5
    assert measure.largest(change) < 0.1 * before


@pytest.mark.long
def test_at_the_threshold_response_and_torque_are_as_defined() -> None:
    measure = yardstick("direct_drive", QUICK)
    scene = Scene(measure.machine, measure.values, "pan", 1.0, 1.0, np.random.default_rng(0))
    for shape, torque in ((constant_torque(scene), True), (encoder_eccentricity(scene), False)):
        size = measure.threshold(shape)
        seen = measure.seen(shape.values(size), torque)
        assert seen.floors >= 4.5
        if torque:
            assert min(seen.floors / 5.0, seen.share / 0.05) == pytest.approx(1.0, abs=0.1)
        else:
            assert seen.floors == pytest.approx(5.0, rel=0.1)


@pytest.mark.parametrize(("name", "kind"), [("direct_drive", "pair"), ("pan_drive", "single")])
def test_a_set_is_the_same_to_the_byte_and_complete(tmp_path: Path, name: str, kind: str) -> None:
    entry = first(name, kind)
    truth = generate(entry, tmp_path / "a")
    generate(entry, tmp_path / "b")
    files = sorted(file.relative_to(tmp_path / "a") for file in (tmp_path / "a").rglob("*.*"))
    assert len(files) >= 6
    for file in files:
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes(), file
    assert json.loads((tmp_path / "a" / "truth.json").read_text())["id"] == entry.id
    assert truth["effects"] == [planted.effect for planted in entry.planted]
    platform = tomllib.loads((tmp_path / "a" / "platform.toml").read_text())
    columns = {signal["column"] for signal in platform["signals"].values()}
    with next((tmp_path / "a" / "train").glob("*.csv")).open() as log:
        header = next(csv.reader(log))
    assert {name.partition(" ")[0] for name in header} == {"time", *columns}
    free = [name for name, one in platform["parameters"].items() if "start" in one]
    assert set(free) <= set(truth["parameters"])
