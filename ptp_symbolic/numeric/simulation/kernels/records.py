"""What the compiled kernels share: their options, and the records that travel between them.

Kernels allocate nothing, so that numba need not count references: counting costs more than the
arithmetic of a step. They are inlined, so that a record costs nothing either.
"""

import hashlib
import re
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from numba import njit, types

KERNEL: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
# Inner kernels are called by kernels alone: from Python a call crashes, for there is no way in.
INNER = KERNEL | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
kernel = njit(**INNER)
inlined = njit(forceinline=True, **INNER)
merged = njit(inline="always", **INNER)  # for large ones: not compiled by itself as well

RUNNERS = ("hybrid.py", "fixed_runner.py", "smooth_runner.py")
# What these import of the simulation and of the layout of modes; other modules hold no kernels.
IMPORT = re.compile(
    r"^from ptp_symbolic\.(numeric\.(?:simulation|runtime\.element_layout)[\w.]*)"
    r" import (\([^)]*\)|[^\n]*)",
    re.MULTILINE,
)
SMALLEST = 1e-60
DONE, DIVERGED, CHATTERING, UNDECIDED, OUTSIDE, EXHAUSTED, TOO_FAST, STIFF = 0, 1, 2, 3, 4, 5, 6, 7
LARGEST_STATE = 1e12
TIME_RESOLUTION = 1e-12  # s
SHORTEST = 1e-11  # s
TIME, LENGTH = 0, 1
OUTPUT, EVENTS, STEPS, INSTANT, SOURCES, UNBALANCED = 0, 1, 2, 3, 4, 5

VECTOR, MATRIX = types.float64[::1], types.float64[:, ::1]
CUBE, INTEGERS = types.float64[:, :, ::1], types.int64[::1]
INTEGER_TABLE = types.int64[:, ::1]
TABLE = types.Tuple((VECTOR, MATRIX, INTEGERS, MATRIX, INTEGERS, MATRIX, INTEGERS))


class Equations(NamedTuple):
    """The emitted functions of a model, its parameters p [np], what its `prepare` makes of them,
    and where its frictions act.

    friction_rates: state index of the rate of every friction; zero_at_rest [n]: per state the
    friction that sets it to zero when it comes to rest, or -1; contacts [c, 5]: state index of the
    rates at the gear output and at the joint; 0 for a sprung contact, 1 for rigid bodies, 2 for
    rigid bodies whose joint sticks in the gap; 1 while such a joint is pressed, see `pressed`; 1
    while strikes do not bounce, see `fixed_runner`.
    """

    derivative: Any
    linearize: Any
    guards: Any
    energy: Any
    p: Any
    prepared: Any
    friction_rates: Any
    zero_at_rest: Any
    impacts: Any
    impact_jacobian: Any
    contacts: Any


class Inputs(NamedTuple):
    """Inputs as an InputTable; `held`: zero-order hold, with jumps at stops only.

    cursor [nu]: pieces found last; u [nu]: the values asked for last; ahead [nu]: values, or slopes
    per s, at another time.
    """

    table: Any
    cursor: Any
    held: Any
    u: Any
    ahead: Any


class Step(NamedTuple):
    """What is known at the start of a step, what an attempt found, and its dense output.

    Rows have a width w of n rounded up to a multiple of LANES (see `lanes`), zero beyond n. slope,
    by_time [w]: dx/dt at the start and its partial derivative by time; stage, k [8, w]; end [n];
    dense [5, w]: coefficients of the state by powers of the fraction of the step; fx [n, n], fu
    [n, nu], fp [n, np] (no rows without tangents) at the start; inverse of the matrix of the
    implicit stages, also by columns [n, w], with no tangents without the sampled states, and its
    pivots `order` [n]; point, right, added [w]: scratch.
    """

    slope: Any
    by_time: Any
    stage: Any
    k: Any
    end: Any
    dense: Any
    fx: Any
    fu: Any
    fp: Any
    inverse: Any
    columns: Any
    order: Any
    point: Any
    right: Any
    added: Any


class Watch(NamedTuple):
    """Guards g, modes m and m_before, and the event function of every element.

    at_start, at_middle, at_end [elements + limits] belong to the step, limits of the domain last;
    gx, gp, by_x [n], by_p [np]: the Jacobians of guards, the gradient of an event function; strike
    [c (n + 2)], strike_x, strike_p: as `impacts` writes them, and their Jacobians; lost [1]: energy
    in J that impacts have taken; energies [2, 3]: two ledgers to compare; limited [limits]: index
    of every state with bounds [limits, 2]; before, after [n]: dx/dt at an event; m_kept, trial [n]:
    modes, and dx/dt in others tried instead.
    """

    g: Any
    m: Any
    m_before: Any
    at_start: Any
    at_middle: Any
    at_end: Any
    gx: Any
    gp: Any
    by_x: Any
    by_p: Any
    before: Any
    after: Any
    strike: Any
    strike_x: Any
    strike_p: Any
    lost: Any
    energies: Any
    limited: Any
    bounds: Any
    m_kept: Any
    trial: Any


class Tangents(NamedTuple):
    """Derivatives of the state: first by the parameters `columns`, then by others.

    s [n * ns] row by row, and the same as `table` [n, ns], ns rounded up to a multiple of LANES;
    delay_column [nu]: per input the column of its delay, or -1; k [8, n * ns], point, right, along
    [n * ns]: stages; fx [3, n, n], by [3, n * ns], matrix [n, n], fu, fp: the variational equation
    along the step.
    """

    s: Any
    table: Any
    columns: Any
    delay_column: Any
    k: Any
    point: Any
    right: Any
    along: Any
    fx: Any
    by: Any
    matrix: Any
    fu: Any
    fp: Any


class Record(NamedTuple):
    """Results at `times` [k] in s: x [k, n], s [k, n, ns], ledger [k, 3] in J (or no rows), events
    [c, 3].

    totals [3]: work so far in J; powers [4, 3]: stored energy in J, power in and dissipated power
    in W over the step; clock [2]: time and next step length in s; counts [6]: outputs, events,
    steps, instant events, the stamp of the sources that the runner was compiled from, steps whose
    ledger would not close.
    """

    times: Any
    x: Any
    s: Any
    ledger: Any
    events: Any
    totals: Any
    powers: Any
    clock: Any
    counts: Any


_V, _M, _C, _I = VECTOR, MATRIX, CUBE, INTEGERS
MACHINE_TYPES = (
    _I,  # addresses of the emitted functions
    _V,  # parameters
    _V,  # what is prepared of them
    _I,  # state index of the rate of every friction
    _I,  # per state the friction that zeroes it when it comes to rest, or -1
    INTEGER_TABLE,
    TABLE,
    _I,  # cursor [nu]
    types.boolean,  # inputs are constant between stops
)
_INT = types.int64
EQUATIONS_TYPE = types.Tuple((*[_INT] * 4, _V, _V, _I, _I, _INT, _INT, INTEGER_TABLE))
INPUTS_TYPE = types.Tuple((TABLE, _I, types.boolean, _V, _V))
STEP_TYPE = types.Tuple((_V, _V, _M, _M, _V, _M, _M, _M, _M, _M, _M, _I, _V, _V, _V))
WATCH_TYPE = types.Tuple(
    (_V, _V, _V, _V, _V, _V, _M, _M, _V, _V, _V, _V, _V, _M, _M, _V, _M, _I, _M, _V, _V)
)
TANGENTS_TYPE = types.Tuple((_V, _M, _I, _I, _M, _V, _V, _V, _C, _M, _M, _M, _M))
RECORD_TYPE = types.Tuple((_V, _M, _C, _M, _M, _V, _M, _V, _I))
RUN_TYPES = (
    *MACHINE_TYPES,
    _M,  # inputs: now, ahead, before [3, nu]
    _V,  # x, changed in place
    _V,  # stops, the first is the start
    _V,  # rtol, largest step, most steps
    _V,  # atol
    STEP_TYPE,
    WATCH_TYPE,
    TANGENTS_TYPE,
    RECORD_TYPE,
)


@lru_cache(maxsize=1)
def source_stamp() -> int:
    """A number that changes with any source of the kernels: the runners, and what these import.

    numba keeps a compiled function until its own file changes; a runner that holds this number
    is compiled anew when a kernel in another file has changed.
    """
    digest = hashlib.sha256()
    for path in sorted(kernel_sources(Path(__file__).parents[3])):
        digest.update(path.read_bytes())
    return int.from_bytes(digest.digest()[:7], "big")


def kernel_sources(package: Path) -> set[Path]:
    """Files of the `package` ptp_symbolic whose functions and numbers are compiled into runners."""
    found: set[Path] = set()
    wanted = [package / "numeric/simulation" / runner for runner in RUNNERS]
    while wanted:
        path = wanted.pop()
        if path in found or not path.is_file():
            continue
        found.add(path)
        for module, names in IMPORT.findall(path.read_text(encoding="utf-8")):
            place = package.joinpath(*module.split("."))
            modules = [place / name for name in re.findall(r"\w+", names)]
            wanted += [module.with_suffix(".py") for module in (place, *modules)]
    return found


@inlined
def equations_at(functions, p, prepared, friction_rates, zero_at_rest, contacts):
    """Equations of the model whose emitted functions have the addresses `functions` [6]."""
    derivative, linearize, guards, energy, impacts, impact_jacobian = (
        functions[0],
        functions[1],
        functions[2],
        functions[3],
        functions[4],
        functions[5],
    )
    return Equations(
        derivative,
        linearize,
        guards,
        energy,
        p,
        prepared,
        friction_rates,
        zero_at_rest,
        impacts,
        impact_jacobian,
        contacts,
    )


@inlined
def copy(source, target):
    """Copy a vector."""
    for i in range(len(target)):
        target[i] = source[i]


@inlined
def clear(target):
    """Set a vector to zero."""
    for i in range(len(target)):
        target[i] = 0.0


@inlined
def copy_matrix(source, target):
    """Copy a matrix."""
    for i in range(target.shape[0]):
        for j in range(target.shape[1]):
            target[i, j] = source[i, j]


@inlined
def flush(values):
    """Set denormal numbers of a vector to zero: they slow every loop."""
    for i in range(len(values)):
        values[i] = values[i] if abs(values[i]) >= SMALLEST else 0.0
