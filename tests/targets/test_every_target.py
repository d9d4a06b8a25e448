"""Every target computes the equations: every effect, random states, on gap edges and at rest."""

import ctypes
import importlib.util
import shutil
import subprocess
from pathlib import Path
from types import ModuleType

import mpmath
import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.symbolic.effects import EFFECTS
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.program.kernel import Kernel
from ptp_symbolic.symbolic.targets import TARGETS
from ptp_symbolic.symbolic.targets.arrays import CASADI, JAX, ArrayModule
from ptp_symbolic.symbolic.targets.c99 import C99_DOUBLE, C99_FLOAT
from ptp_symbolic.symbolic.targets.c99.language import DOUBLE, FLOAT
from ptp_symbolic.symbolic.targets.functions import KERNELS
from ptp_symbolic.symbolic.targets.octave import OCTAVE, Octave
from ptp_symbolic.symbolic.targets.printing import OPERATIONS, Language
from tests.targets.c_library import COMPILERS, compiled, pointer
from tests.targets.machines import (
    NAMES,
    PRESETS,
    Sampled,
    machines,
    module_of,
    prepared_by_module,
    program_of,
    written_by_module,
)

SEEDS = (1, 2, 3)
LARGE = (*PRESETS, "two_axes")  # most effects are in these
LANGUAGES = (DOUBLE, FLOAT, CASADI.language, JAX.language, OCTAVE)


def test_every_effect_is_in_one_of_the_machines() -> None:
    have = {e.effect for platform in machines().values() for e in platform.effects}
    assert {effect.id for effect in EFFECTS} <= have


@pytest.mark.parametrize("language", LANGUAGES, ids=lambda language: language.name)
def test_every_language_has_every_operation(language: Language) -> None:
    assert set(OPERATIONS) <= set(language.operations)


def test_targets_have_names_of_their_own() -> None:
    names = [target.name for target in TARGETS]
    assert len(set(names)) == len(names) and all(target.summary for target in TARGETS)


def exact(name: str, given: Sampled) -> tuple[list[float], list[float]]:
    """Vector field and outputs to 50 digits, from M a = forcing - friction in the modes given: rows
    of sticking rates are at rest, all others free.
    """
    equations = program_of(name).equations
    numbers = [
        (equations.state_symbols, given.x),
        ([i.symbol for i in equations.inputs], given.u),
        ([p.symbol for p in equations.parameters], given.p),
        (equations.mode_symbols, given.m),
    ]
    values = {
        symbol: sp.Float(float(value), 50)
        for symbols, own in numbers
        for symbol, value in zip(symbols, own, strict=True)
    }
    values[sp.Symbol("t", real=True)] = sp.Float(given.t, 50)

    def number(expression: sp.Expr) -> mpmath.mpf:
        nearest = expression.replace(
            lambda e: type(e).__name__ == "NearestCount",
            lambda e: e.rewrite(sp.floor),
        )
        return mpmath.mpf(sp.N(nearest.subs(values), 50))

    with mpmath.workdps(50):
        for symbol, term in equations.terms:
            values[symbol] = sp.Float(str(number(term)), 50)
        n = len(equations.rates)
        places = [place_of(q) for q in equations.coordinates]
        accelerations = [sp.Symbol(f"accel_{place}", real=True) for place in places]
        mass = mpmath.matrix(n, n)
        force = mpmath.matrix(n, 1)
        slides = {f.rate: (f, given.m[k]) for k, f in enumerate(equations.frictions)}
        for i, rate in enumerate(equations.rates):
            friction, direction = slides.get(rate, (None, 1.0))
            if direction == 0.0:
                mass[i, i], force[i] = 1, 0
                continue
            for j in range(n):
                mass[i, j] = number(equations.mass_matrix[i, j])
            force[i] = number(equations.forcing[i])
            if friction is not None:
                force[i] -= int(direction) * number(friction.level)
        rates = mpmath.lu_solve(mass, force)
        derivatives = dict(
            zip(equations.coordinates, (values[w] for w in equations.rates), strict=True)
        )
        derivatives |= {w: rates[i] for i, w in enumerate(equations.rates)}
        derivatives |= {s.symbol: number(s.derivative) for s in equations.extra_states}
        if not equations.mode_symbols:  # outputs may depend on accelerations
            values |= {a: sp.Float(str(r), 50) for a, r in zip(accelerations, rates, strict=True)}
        field = [float(derivatives[s]) for s in equations.state_symbols]
        outputs = [float(number(e)) for _, _, e in equations.outputs]
    return field, outputs


def close(found: np.ndarray, exactly: list[float]) -> bool:
    """Equal but for rounding, which is relative to the largest entry where numbers cancel."""
    scale = max(1.0, float(np.max(np.abs(exactly), initial=0.0)))
    return bool(np.max(np.abs(found - np.array(exactly)), initial=0.0) < 1e-11 * scale)


@pytest.mark.parametrize("name", NAMES)
def test_the_equations_the_module_and_c_are_one(name: str, tmp_path: Path) -> None:
    """The module is the middle of the chain: 50 digits on one side, every target on the other."""
    check_against_equations(name)
    for compiler in COMPILERS if name in LARGE else COMPILERS[:1]:
        check_c_against_module(name, compiler, tmp_path)


def check_against_equations(name: str) -> None:
    """The module computes the equations to rounding; rigid contacts, which join rows, are in
    tests/program/test_rigid_contacts.py.
    """
    whole = program_of(name)
    if whole.has_rigid_contacts:
        return
    for seed in SEEDS if len(whole.vectors.p) < 60 else SEEDS[:1]:
        given = Sampled(name, seed)
        field, outputs = exact(name, given)
        kernels = {k.name: k for k in whole.kernels}
        rates = written_by_module(name, kernels["mode_derivative"], given)["dx"]
        assert close(rates, field), name
        assert close(written_by_module(name, kernels["outputs"], given)["y"], outputs), name


def check_c_against_module(name: str, compiler: str, tmp_path: Path) -> None:
    """Exported C is the module bit for bit."""
    library = ctypes.CDLL(
        str(compiled(program_of(name), "machine", C99_DOUBLE, tmp_path, compiler))
    )
    for seed in SEEDS:
        given = Sampled(name, seed)
        prepared = prepared_by_module(name, given)
        for kernel in program_of(name).kernels:
            read = given.of(kernel, prepared)
            arrays = {a: np.zeros(kernel.vectors.shape(a)) for a in kernel.written}
            arguments = [
                ctypes.c_double(given.t)
                if a == "t"
                else pointer(np.ascontiguousarray({**read, **arrays}[a], dtype=float))
                for a in kernel.arguments
            ]
            getattr(library, f"machine_{kernel.name}")(*arguments)
            for array, own in written_by_module(name, kernel, given).items():
                assert np.array_equal(arrays[array], own, equal_nan=True), (kernel.name, array)
        if program_of(name).has_modes:
            check_modes_of_c_against_module(name, library, given)


def check_modes_of_c_against_module(name: str, library: ctypes.CDLL, given: Sampled) -> None:
    """Both find the same modes of a state that moves, and of one at rest."""
    moves = [not state.startswith("omega_") for state in program_of(name).vectors.x]
    for x in (given.x, given.x * moves):
        own, found = (np.full(len(given.m), np.nan) for _ in range(2))
        module_of(name).initial_modes(given.t, x, given.u, given.p, own)
        read = map(pointer, (x, given.u, given.p, found))
        library.machine_initial_modes(ctypes.c_double(given.t), *read)
        assert np.array_equal(found, own)


@pytest.mark.parametrize("name", ["thesis-pan-servo", "two_axes"])
def test_single_precision_compiles_without_a_warning(name: str, tmp_path: Path) -> None:
    if not COMPILERS:
        pytest.skip("no C compiler on this machine")
    compiled(program_of(name), "machine", C99_FLOAT, tmp_path, COMPILERS[0])


def exported(target: ArrayModule, name: str, folder: Path) -> ModuleType:
    """The exported Python module of a machine, imported."""
    ((file, text),) = target.files(program_of(name), "machine").items()
    path = folder / file
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def kernels_of(name: str) -> dict[str, Kernel]:
    """Kernels by the name of the function that is exported of them."""
    own = {k.name: k for k in program_of(name).kernels}
    found = {function: own[kernel] for function, kernel in KERNELS.items() if kernel in own}
    return {f: k for f, k in found.items() if k.vectors.shape(k.written[0])[0] > 0}


def agree(found: np.ndarray, expected: np.ndarray) -> bool:
    """Equal but for the rounding of functions of other libraries."""
    scale = np.maximum(1.0, np.abs(expected))
    return bool(np.all((np.abs(found - expected) <= 1e-11 * scale) | np.isnan(expected)))


@pytest.mark.parametrize("name", NAMES)
def test_casadi_computes_what_the_module_does(name: str, tmp_path: Path) -> None:
    casadi = pytest.importorskip("casadi")
    module = exported(CASADI, name, tmp_path)
    for function, kernel in kernels_of(name).items():
        own = module.function(function, casadi.SX if name != "two_axes" else casadi.MX)
        for seed in SEEDS:
            given = Sampled(name, seed)
            read = given.of(kernel, np.zeros(0))
            found = np.array(own(*[read[a] for a in kernel.arguments if a in read])).ravel()
            (expected,) = written_by_module(name, kernel, given).values()
            assert agree(found, expected.ravel()), function


@pytest.mark.parametrize("name", NAMES)
def test_jax_computes_what_the_module_does(name: str, tmp_path: Path) -> None:
    pytest.importorskip("jax")
    module = exported(JAX, name, tmp_path)
    for function, kernel in kernels_of(name).items():
        given = Sampled(name, 1)
        read = given.of(kernel, np.zeros(0))
        arrays = [read[a] for a in kernel.arguments if a in read]
        found = np.asarray(getattr(module, function)(*arrays))
        (expected,) = written_by_module(name, kernel, given).values()
        assert found.dtype == np.float64 and agree(found, expected), function


@pytest.mark.parametrize("name", NAMES)
def test_octave_computes_what_the_module_does(name: str, tmp_path: Path) -> None:
    if shutil.which("octave-cli") is None:
        pytest.skip("octave is not installed")
    for file, text in Octave().files(program_of(name), "machine").items():
        (tmp_path / file).write_text(text)
    script, expected = ["addpath(pwd);"], []
    given = Sampled(name, 1)
    for function, kernel in kernels_of(name).items():
        read = given.of(kernel, np.zeros(0))
        texts = [
            f"[{'; '.join(repr(float(v)) for v in np.atleast_1d(read[a]))}]"
            for a in kernel.arguments
            if a in read
        ]
        script.append(f"printf('%.17g ', machine_{function}({', '.join(texts)})); printf('\\n');")
        (own,) = written_by_module(name, kernel, given).values()
        expected.append(own.ravel(order="F"))  # as Octave prints matrices
    (tmp_path / "all_of_them.m").write_text("\n".join(script) + "\n")
    done = subprocess.run(
        ["octave-cli", "--norc", "all_of_them.m"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[:2000]
    lines = done.stdout.strip().splitlines()
    assert len(lines) == len(expected)
    for line, own in zip(lines, expected, strict=True):
        assert agree(np.array([float(word) for word in line.split()]), own), line
