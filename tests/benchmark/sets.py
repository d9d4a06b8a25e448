"""Make a set of the catalogue: draw the machine, size what it hides, record, write.

A machine that absorbs an effect at every sane size is drawn anew, a few times.
"""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit

from tests.benchmark import deviations
from tests.benchmark.effects import Numbers, Scene, Shape
from tests.benchmark.entry import OF_STRUCTURES, Entry, Planted
from tests.benchmark.logs import write_logs
from tests.benchmark.machine import Machine, Recording, Run, angle_floor
from tests.benchmark.machines import MACHINES
from tests.benchmark.sizing import AbsorbedError, Yardstick
from tests.benchmark.structures import (
    SHAFT,
    SMALL_DEVIATIONS,
    STRUCTURES,
    VISIBLE_FLOORS,
    Structure,
)
from tests.benchmark.unlisted import DECLARED_VALUE, LISTED_SINCE, UNLISTED, shape_of

MOST_DRAWS = 6
LEAST_LEVEL = 0.6  # of the level asked for, where a limit cuts the size
DECLARED_ERRORS = (0.03, 0.4)  # least and most relative error of a wrong declared value
MOST_INPUT_NOISE = {True: 0.01, False: 0.01}  # V where voltage-driven, N m else


@dataclass
class Hidden:
    """What a set hides: all parameters, those to be told, and a record per effect; of structures
    also what they are called, each with axis and level, and what may be named beside them.
    """

    values: Numbers = field(default_factory=dict)
    told: Numbers = field(default_factory=dict)
    records: list[dict[str, Any]] = field(default_factory=list)
    named: list[tuple[str, str | None, float]] = field(default_factory=list)
    allowed: list[str] = field(default_factory=list)


def generate(entry: Entry, folder: Path) -> dict[str, Any]:
    """Write platform.toml, train/*.csv, validate/*.csv and truth.json; returns the truth.

    Raises AbsorbedError if no machine that was drawn shows the effects at a sane size.
    """
    machine = MACHINES[entry.machine]
    for draw in range(MOST_DRAWS):
        try:
            return _make(entry, machine, draw, folder)
        except AbsorbedError as absorbed:
            reason = absorbed
    raise AbsorbedError(f"{entry.id}: {reason}")


def _make(entry: Entry, machine: Machine, draw: int, folder: Path) -> dict[str, Any]:
    """One try with the machine of one draw."""
    variation = entry.variation
    values = machine.draw(np.random.default_rng([entry.seed, 2, draw]), variation)
    runs = machine.runs(np.random.default_rng([entry.seed, 3, draw]), values, variation)
    training = [machine.record(values, run) for run in runs if run.path.startswith("train/")]
    yardstick = Yardstick(machine, values, training, variation)
    noise = 0.0
    if variation.input_noise:
        rng = np.random.default_rng([entry.seed, 4])
        most = MOST_INPUT_NOISE[machine.voltage_driven]
        noise = yardstick.widen_by_input_noise(rng, variation.input_noise, most)
    hidden = _hide(entry, machine, yardstick, draw)
    true = {**values, **hidden.values}
    recordings = _record(machine, true, runs)
    trained = recordings[: len(training)]
    truth = _truth(entry, machine, yardstick, hidden, noise)
    truth["response_floors"] = yardstick.against(trained, true) if hidden.values else 0.0
    truth["draw"] = draw
    write_logs(folder, machine, true, recordings, variation, noise, entry.seed)
    _write_platform(folder, machine, entry, values, noise)
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
    return truth


def _record(machine: Machine, values: Numbers, runs: Sequence[Run]) -> list[Recording]:
    """All runs as the machine makes them."""
    return [machine.record(values, run) for run in runs]


def _hide(entry: Entry, machine: Machine, yardstick: Yardstick, draw: int) -> Hidden:
    """The hidden parameters, sized on the machine without them."""
    deviate = any(planted.effect == SMALL_DEVIATIONS for planted in entry.planted)
    if entry.kind == "slightly_wrong" or deviate:
        rng = np.random.default_rng([entry.seed, 5, draw])
        values, record = deviations.scaled(machine, yardstick, rng)
        return Hidden(values, {}, [record])
    hidden = Hidden()
    for number, planted in enumerate(entry.planted):
        rng = np.random.default_rng([entry.seed, 5, draw, number])
        axis = planted.axis or machine.axes[0]
        scene = Scene(
            machine,
            yardstick.values,
            axis,
            *_extremes(yardstick, machine.axes.index(axis)),
            rng,
            _reach(yardstick, machine.axes.index(axis)),
        )
        if planted.effect in STRUCTURES:
            _hide_structure(hidden, planted, STRUCTURES[planted.effect](scene), yardstick, entry)
            continue
        shape = shape_of(planted.effect, scene)
        size, record = _size(planted, shape, yardstick, entry.variation.period)
        parameters = shape.values(size)
        hidden.values |= parameters
        hidden.told |= {k: v for k, v in parameters.items() if k not in shape.untold}
        hidden.records.append(record)
        hidden.named.append((planted.effect, planted.axis, record["level"]))
    return hidden


def _hide_structure(
    hidden: Hidden, planted: Planted, shape: Structure, yardstick: Yardstick, entry: Entry
) -> None:
    """Add a structure in the size that is asked for, in its own unit or in thresholds."""
    if shape.natural:
        seen = yardstick.seen(shape.values(planted.level), False)
        size, level = planted.level, seen.floors / VISIBLE_FLOORS
        record: dict[str, Any] = {"effect": planted.effect, "axis": planted.axis, "level": level}
        record |= {"size": size, "response_floors": seen.floors}
    else:
        size, record = _size(planted, shape, yardstick, entry.variation.period)
    parameters = shape.values(size)
    effects, allowed, told = list(shape.effects), list(shape.allowed), list(shape.told)
    shaft = {k: v for k, v in parameters.items() if k.startswith(("k_shaft_", "d_shaft_"))}
    if "backlash" in effects and shaft:
        alone = record["shaft_floors"] = yardstick.seen(shaft, False).floors
        if alone < 1.0 and SHAFT in effects:
            effects.remove(SHAFT)
            allowed.append(SHAFT)
        elif alone >= VISIBLE_FLOORS and SHAFT in allowed:
            effects.append(SHAFT)
            allowed.remove(SHAFT)
    if SHAFT in effects:
        told += ["k_shaft", "d_shaft"]
    elif shaft:
        told = [letters for letters in told if not letters.endswith("_shaft")]
    names = {f"{letters}_{planted.axis}" for letters in told}
    hidden.values |= parameters
    hidden.told |= {name: value for name, value in parameters.items() if name in names}
    hidden.records.append(record)
    hidden.named += [(effect, planted.axis, record["level"]) for effect in effects]
    hidden.allowed += [f"{effect}@{planted.axis}" for effect in allowed]


def _reach(yardstick: Yardstick, joint: int) -> tuple[float, float]:
    """Least and largest angle of a joint in rad in the training runs."""
    machine, made = yardstick.machine, yardstick.recordings
    read = [machine.readings(yardstick.values, one.states, yardstick.variation) for one in made]
    angles = np.concatenate([columns[:, joint] for columns in read])
    return float(angles.min()), float(angles.max())


def _extremes(yardstick: Yardstick, joint: int) -> tuple[float, float]:
    """Largest command, and largest rate of a joint in rad/s, in the training runs."""
    peak, fastest = 0.0, 0.0
    for made in yardstick.recordings:
        read = yardstick.machine.readings(yardstick.values, made.states, yardstick.variation)
        rate = np.abs(np.diff(read[:, joint])) / made.run.period
        peak = max(peak, float(np.max(np.abs(made.inputs[:, joint]))))
        fastest = max(fastest, float(np.max(rate)))
    return peak, fastest


def _size(
    planted: Planted, shape: Shape | Structure, yardstick: Yardstick, period: float
) -> tuple[float, dict[str, Any]]:
    """The size that the level asks for, cut at the limit, and what is to be told of it."""
    threshold = yardstick.threshold(shape)
    size = min(planted.level * threshold, shape.limit)
    if planted.effect.startswith(DECLARED_VALUE):
        size = min(max(size, DECLARED_ERRORS[0]), DECLARED_ERRORS[1])
    elif size < LEAST_LEVEL * planted.level * threshold:
        raise AbsorbedError(f"level {size / threshold:.2f} at the limit {shape.limit:.3g}")
    if planted.effect == "input_delay":
        size = _between_samples(size, period)
    seen = yardstick.seen(shape.values(size), shape.torque)
    record = {
        "effect": planted.effect,
        "axis": planted.axis,
        "level_asked": planted.level,
        "level": size / threshold,
        "threshold": threshold,
        "size": size,
        "response_floors": seen.floors,
        "torque_share": seen.share,
    }
    return size, record


def _between_samples(delay: float, period: float) -> float:
    """A delay in s that is no multiple of the sampling period: a tenth of it away at least."""
    whole, part = divmod(delay / period, 1.0)
    return (whole + min(max(part, 0.1), 0.9)) * period if delay > 0.1 * period else delay


def _truth(
    entry: Entry, machine: Machine, yardstick: Yardstick, hidden: Hidden, noise: float
) -> dict[str, Any]:
    """What truth.json tells, but for the response."""
    variation = entry.variation
    listed = [planted for planted in entry.planted if planted.effect not in UNLISTED]
    free = machine.free(variation)
    truth = {
        "id": entry.id,
        "machine": entry.machine,
        "kind": entry.kind,
        "half": entry.half,
        "seed": entry.seed,
        "effects": [planted.effect for planted in listed],
        "axes": [planted.axis for planted in listed],
        "unlisted": [one.effect for one in entry.planted if one.effect in UNLISTED],
        "level": [
            record["level"]
            for record in hidden.records
            if record.get("effect") in {planted.effect for planted in listed}
        ],
        "floor": angle_floor(variation),
        "floor_widening": yardstick.widening.tolist(),
        "parameters": {name: yardstick.values[name] for name in free} | hidden.told,
        "hidden": hidden.values,
        "planted": hidden.records,
        "input_noise": noise,
        "variation": asdict(variation),
    }
    now_listed = [one for one in entry.planted if one.effect in LISTED_SINCE]
    if now_listed:
        truth["allowed"] = [f"{LISTED_SINCE[one.effect]}@{one.axis}" for one in now_listed]
    if entry.kind in OF_STRUCTURES:
        truth["effects"] = [effect for effect, _, _ in hidden.named]
        truth["axes"] = [axis for _, axis, _ in hidden.named]
        truth["level"] = [level for _, _, level in hidden.named]
        truth["allowed"] = hidden.allowed
        truth["small_deviations"] = any(one.effect == SMALL_DEVIATIONS for one in entry.planted)
    return truth


def _write_platform(
    folder: Path, machine: Machine, entry: Entry, values: Numbers, noise: float
) -> None:
    """The platform as declared, with the noise of its inputs where that is known."""
    platform = machine.declared(values, entry.variation)
    for signal in platform["signals"].values():
        if signal["role"] == "input" and entry.variation.declared_input_noise and noise > 0.0:
            signal["noise"] = noise
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "platform.toml").write_text(tomlkit.dumps(platform))
