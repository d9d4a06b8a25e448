"""Emitted modules without what is switched off, for machines that are simulated many times.

A model with every candidate effect computes all of them, most of which vanish in any one fit. Its
module is written anew here with these parameters as constants: what they multiply goes, and what
nothing uses then (partial evaluation: Jones, Gomard and Sestoft, 1993). States, inputs, parameters
and modes stay where they are, and where all numbers are finite results are the same to the last
bit, but for the sign of a zero: a simulation may take either of the two.
"""

import ast
import hashlib
import math
import operator
import threading
from collections import Counter
from collections.abc import Callable, Mapping, Set
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.atomic_files import write_text_if_changed
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.compiled import EMITTED
from ptp_symbolic.numeric.runtime.model import TRAILER, load_module
from ptp_symbolic.numeric.simulation.kernels.calls import (
    IMPACT_SIGNATURES,
    SIGNATURES,
    addresses,
    compiled_addresses,
    output_addresses,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

WORTH = 1_000_000  # steps; they take as long as functions to compile, a few seconds
MOST = 0.8  # of these, for which functions are made
OF_LEDGER = ("energy",)  # which no simulation of a fit calls: it is not compiled
OPERATIONS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
BY_PARAMETER = ("fp", "gp", "yp")  # derivatives, a column for each parameter


class Functions(NamedTuple):
    """Addresses of `addresses` [6] and of `output_addresses` [2]."""

    motion: IntArray
    outputs: IntArray


@dataclass(eq=False)
class Specialised:
    """The functions of an emitted module that leave out what simulations do not need: bits of a
    number (see `unneeded`), by which they are `known`.
    """

    module: ModuleType
    known: dict[int, Functions] = field(default_factory=dict)
    simulated: Counter[int] = field(default_factory=Counter)
    _last: tuple[tuple[bytes, bytes], int] = ((b"", b""), 0)
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)

    @cached_property
    def vanishes(self) -> FloatArray:
        """The values [np] at which parameters vanish; not a number where they do not."""
        values = {row[0]: row[1] for row in self.module.SEARCH}
        found = [values.get(row[0]) for row in self.module.PARAMETERS]
        return np.array([np.nan if value is None else value for value in found], dtype=np.float64)

    def unneeded(self, p: FloatArray, columns: IntArray) -> int:
        """A bit for every parameter that vanishes at p [np], and one for every derivative by a
        parameter, that is by none of the `columns` [nc] by which derivatives may be asked for.
        """
        key = p.tobytes(), columns.tobytes()
        last, found = self._last  # the same for all runs of an iteration
        if key == last:
            return found
        bits = np.ones((2, len(p)), dtype=np.bool_)
        bits[:, columns] = False
        bits[0] &= p == self.vanishes
        found = int.from_bytes(np.packbits(bits).tobytes(), "big")
        self._last = key, found
        return found

    def without(self, unneeded: int, tangents: bool) -> Functions:
        """Of the known functions those that leave out the most of `unneeded`, and nothing else."""
        fit = [known for known in list(self.known) if known | unneeded == unneeded]
        if fit:
            return self.known[max(fit, key=int.bit_count)]
        return Functions(addresses(self.module, tangents), output_addresses(self.module))

    def note(self, unneeded: int, samples: int) -> None:
        """Note that so much was simulated. Once the module's own functions have been at work for
        long enough, others are made that serve most of what they were asked for; where these would
        leave out less than half, they serve what was asked for most.
        """
        if unneeded.bit_count() < len(self.vanishes) or any(
            known | unneeded == unneeded for known in list(self.known)
        ):
            return
        with self._lock:
            self.simulated[unneeded] += samples
            whole = self.simulated.total()
            if whole < WORTH:
                return
            found = shared = self.simulated.most_common(1)[0][0]
            covered = 0
            for each, own in self.simulated.most_common():
                if covered >= MOST * whole:
                    break
                covered, shared = covered + own, shared & each
            if shared.bit_count() >= len(self.vanishes):
                found = shared
            self.simulated.clear()
        if module := self._emitted_without(found):
            motion = compiled_addresses(module, SIGNATURES | IMPACT_SIGNATURES, OF_LEDGER)
            self.known[found] = Functions(motion, output_addresses(module))

    def _emitted_without(self, unneeded: int) -> ModuleType | None:
        """The module without what is unneeded; None where it is none of a user, or no more can be
        written beside it.
        """
        source, count = Path(str(self.module.__file__)), len(self.vanishes)
        if not source.stem.startswith(EMITTED):
            return None
        whole = -(-2 * count // 8)
        packed = np.frombuffer(unneeded.to_bytes(whole, "big"), dtype=np.uint8)
        off, unasked = np.unpackbits(packed, count=2 * count).reshape(2, count).astype(np.bool_)
        text = specialised_text(
            source.read_text("utf-8").partition(TRAILER)[0],
            {int(k): float(self.vanishes[k]) for k in np.flatnonzero(off)},
            set(np.flatnonzero(unasked).tolist()),
        )
        digest = hashlib.sha256(text.encode()).hexdigest()
        path = source.with_name(f"{EMITTED}{digest[:16]}.py")
        try:
            write_text_if_changed(path, f"{text}{TRAILER}{digest}\n")
            return load_module(path, path.stem).module
        except InputError:
            return None


@lru_cache(maxsize=256)
def specialised(module: ModuleType) -> Specialised:
    """What is specialised of an emitted module."""
    return Specialised(module)


def specialised_text(text: str, off: Mapping[int, float], unasked: Set[int]) -> str:
    """The text of an emitted module with the values of parameters that are `off`, by index, and
    without derivatives by those that are `unasked`.
    """
    tree = ast.parse(text)
    returned: dict[str, dict[int, float]] = {}
    for one in tree.body:
        if isinstance(one, ast.FunctionDef):
            returned[one.name] = _specialise(one, off, unasked, returned)
    return f"{ast.unparse(ast.fix_missing_locations(tree))}\n\n\n"


def _specialise(
    function: ast.FunctionDef,
    off: Mapping[int, float],
    unasked: Set[int],
    returned: Mapping[str, dict[int, float]],
) -> dict[int, float]:
    """Specialise a function in place; the constants among the entries that it returns. `returned`
    are those of the functions before it.
    """
    stores = Counter(
        n.id for n in ast.walk(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)
    )
    entries = {"p": off, "c": returned.get("constants", {})}
    fold = _Fold({}, dict(entries))
    body: list[ast.stmt] = []
    for statement in function.body:
        if not isinstance(statement, ast.Assign):
            body.append(fold.visit(statement))
            continue
        for target, expression in _pairs(statement):
            found = fold.visit(expression)
            is_name = isinstance(target, ast.Name) and stores[target.id] == 1
            if is_name and isinstance(found, ast.Call) and isinstance(found.func, ast.Name):
                fold.entries[target.id] = returned.get(found.func.id, {})
            if is_name and (value := _number(found)) is not None:
                fold.constants[target.id] = value
            elif not _is_column_of(target, unasked):
                body.append(ast.Assign([target], found))
    function.body = _used(body, stores) or [ast.Pass()]
    last = function.body[-1]
    if not isinstance(last, ast.Return) or not isinstance(last.value, ast.Tuple):
        return {}
    values = {k: _number(entry) for k, entry in enumerate(last.value.elts)}
    return {k: value for k, value in values.items() if value is not None}


def _pairs(statement: ast.Assign) -> list[tuple[Any, ast.expr]]:
    """Targets and values of an assignment, one by one where a tuple is assigned to another."""
    target, value = statement.targets[0], statement.value
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        return list(zip(target.elts, value.elts, strict=True))
    return [(target, value)]


def _is_column_of(target: ast.expr, unasked: Set[int]) -> bool:
    """Whether a target is a derivative by a parameter that is `unasked`."""
    if not isinstance(target, ast.Subscript) or not isinstance(target.value, ast.Name):
        return False
    if target.value.id not in BY_PARAMETER or not isinstance(target.slice, ast.Tuple):
        return False
    column = target.slice.elts[1]
    return isinstance(column, ast.Constant) and column.value in unasked


def _used(body: list[ast.stmt], stores: Mapping[str, int]) -> list[ast.stmt]:
    """The statements without assignments to names that nothing after them uses."""
    used: set[str] = set()
    kept: list[ast.stmt] = []
    for statement in reversed(body):
        target = statement.targets[0] if isinstance(statement, ast.Assign) else None
        if isinstance(target, ast.Name) and stores[target.id] == 1 and target.id not in used:
            continue
        used |= {n.id for n in ast.walk(statement) if isinstance(n, ast.Name)}
        kept.append(statement)
    return kept[::-1]


def _number(node: ast.AST) -> float | None:
    """The value of a number; None where the node is none."""
    is_number = isinstance(node, ast.Constant) and type(node.value) in (int, float)
    return node.value if is_number else None  # type: ignore[attr-defined]


class _Fold(ast.NodeTransformer):
    """Puts `constants` by name, and by the array and index of `entries`, into expressions, and
    leaves out what changes nothing then.
    """

    def __init__(
        self, constants: dict[str, float], entries: dict[str, Mapping[int, float]]
    ) -> None:
        self.constants, self.entries = constants, entries

    def visit_Name(self, node: ast.Name) -> ast.expr:
        known = isinstance(node.ctx, ast.Load) and node.id in self.constants
        return ast.Constant(self.constants[node.id]) if known else node

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        if isinstance(node.ctx, ast.Load) and isinstance(node.value, ast.Name):
            index = node.slice.value if isinstance(node.slice, ast.Constant) else None
            found = self.entries.get(node.value.id, {})
            if isinstance(index, int) and index in found:
                return ast.Constant(found[index])
        return node

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        return _computed(self.generic_visit(node), [node.operand])

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        return _computed(self.generic_visit(node), [node.left, *node.comparators])

    def visit_Call(self, node: ast.Call) -> ast.expr:
        node.args = [self.visit(argument) for argument in node.args]
        is_math = isinstance(node.func, ast.Attribute)
        return _computed(node, node.args) if is_math and node.args else node

    def visit_IfExp(self, node: ast.IfExp) -> ast.expr:
        self.generic_visit(node)
        if isinstance(node.test, ast.Constant):
            return node.body if node.test.value else node.orelse
        return node.body if ast.dump(node.body) == ast.dump(node.orelse) else node

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        left, right = node.left, node.right
        known = _number(left), _number(right)
        match node.op:
            case ast.Mult() if known[0] == 0.0 or known[1] == 0.0:
                return ast.Constant(0.0)
            case ast.Div() if known[0] == 0.0 and known[1] != 0.0:
                return ast.Constant(0.0)
            case ast.Mult() | ast.Div() if known[1] == 1.0:
                return left
            case ast.Add() | ast.Sub() if known[1] == 0.0:
                return left
            case ast.Mult() if known[0] == 1.0:
                return right
            case ast.Add() if known[0] == 0.0:
                return right
            case ast.Sub() if known[0] == 0.0:
                return _computed(ast.UnaryOp(ast.USub(), right), [right])
        return _computed(node, [left, right])


def _computed(node: Any, operands: list[ast.expr]) -> ast.expr:
    """The value of an expression of numbers; the expression where it is none, or has none."""
    values = [_number(one) for one in operands]
    if None in values:
        return node
    try:
        value = _operation(node)(*values)
    except (ArithmeticError, KeyError, TypeError, ValueError):
        return node
    return ast.Constant(value) if isinstance(value, bool | int | float) else node


def _operation(node: ast.expr) -> Callable[..., Any]:
    """What an expression does with its operands. Raises KeyError where it is none of OPERATIONS."""
    match node:
        case ast.Call(func=ast.Attribute(value=ast.Name(id="math"), attr=name)):
            return getattr(math, name)
        case ast.Compare(ops=[one]) | ast.BinOp(op=one) | ast.UnaryOp(op=one):
            return OPERATIONS[type(one)]
    raise KeyError(type(node).__name__)
