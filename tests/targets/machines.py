"""Machines that have every effect between them, and their programs."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.api.effect_bases import bases, machine_with
from ptp_symbolic.models import variants
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.effects import EFFECTS
from ptp_symbolic.symbolic.program.kernel import Kernel
from ptp_symbolic.symbolic.program.program import Program, program
from ptp_symbolic.symbolic.targets.numba.module import written
from tests.effects.plain_python import module_as_python

FloatArray = NDArray[np.float64]
PRESETS = ("thesis-pan-servo", "thesis-tilt-drive")


def _everything() -> Platform:
    """Two axes with friction and all effects that a diagnosis may add to them."""
    base = next(b for b in bases() if b.name == "two_axes")
    return replace(base, effects=(*base.effects, *variants.candidate_effects(base)))


@cache
def machines() -> dict[str, Platform]:
    """Platforms by name; every effect is in one of them."""
    found = {name: read_platform(name) for name in PRESETS}
    found["two_axes"] = _everything()
    have = {e.effect for platform in found.values() for e in platform.effects}
    for effect in EFFECTS:
        if effect.id not in have:
            found[effect.id] = machine_with(effect)
            have |= {e.effect for e in found[effect.id].effects}
    return found


NAMES = tuple(machines())


@cache
def program_of(name: str) -> Program:
    """The program of a machine."""
    return program(assemble(machines()[name]))


@cache
def module_of(name: str) -> ModuleType:
    """The emitted module of a machine, run as plain Python."""
    return module_as_python(written(program_of(name)))


class Sampled:
    """Random arguments of the kernels of a machine: states, inputs, modes; parameters as declared,
    those at zero drawn.
    """

    def __init__(self, name: str, seed: int) -> None:
        whole, rng = program_of(name), np.random.default_rng(seed)
        sizes = {a: len(getattr(whole.vectors, a)) for a in "xum"}
        self.t = float(rng.uniform(0.0, 2.0))
        self.x = rng.normal(0.0, 0.3, sizes["x"])
        self.further = rng.normal(0.0, 0.3, 8)
        self.u = rng.normal(0.0, 1.0, sizes["u"])
        values = np.array([float(p.default) for p in whole.equations.parameters])
        drawn = rng.uniform(0.1, 0.9, len(values))
        bounds = [(p.lower, p.upper) for p in whole.equations.parameters]
        inside = [
            lo + d * (min(hi, lo + 1.0) - lo) for d, (lo, hi) in zip(drawn, bounds, strict=True)
        ]
        self.p = np.where(values == 0.0, inside, values)
        signs = rng.integers(-1, 2, sizes["m"]).astype(float)
        frictions = len(whole.equations.frictions)
        signs[frictions + 1 :: 2] = np.abs(signs[frictions + 1 :: 2])  # active or not
        self.m = signs

    def of(self, kernel: Kernel, prepared: FloatArray) -> dict[str, FloatArray | float]:
        """Arguments of a kernel that it reads, by name."""
        states = np.concatenate([self.x, self.further])[: kernel.vectors.shape("x")[0]]
        given = {"t": self.t, "x": states, "u": self.u, "p": self.p, "m": self.m, "c": prepared}
        return {a: given[a] for a in kernel.arguments if a not in kernel.written}


def written_by_module(name: str, kernel: Kernel, given: Sampled) -> dict[str, FloatArray]:
    """What the emitted module writes for a kernel, by array."""
    module, whole = module_of(name), program_of(name)
    prepared = np.zeros(max(len(whole.vectors.c), 1))
    module.prepare(given.p, prepared)
    read = given.of(kernel, prepared)
    arrays = {a: np.zeros(kernel.vectors.shape(a)) for a in kernel.written}
    getattr(module, kernel.name)(*[{**read, **arrays}[a] for a in kernel.arguments])
    return arrays


def prepared_by_module(name: str, given: Sampled) -> FloatArray:
    """What `prepare` of the emitted module writes."""
    prepared = np.zeros(max(len(program_of(name).vectors.c), 1))
    module_of(name).prepare(given.p, prepared)
    return prepared


def folder_of(tmp: Path, name: str) -> Path:
    """A folder for the files of a machine."""
    folder = tmp / name.replace("-", "_")
    folder.mkdir(parents=True, exist_ok=True)
    return folder
