"""Shared terms: what they compute is what was asked for, with few functions."""

import math

import pytest
import sympy as sp

from ptp_symbolic.symbolic.program.sharing import Vocabulary, share

Q, N = sp.symbols("q n", real=True)


@pytest.mark.parametrize("angle", [Q, N * Q])
@pytest.mark.parametrize("function", [sp.sin, sp.cos])
def test_multiples_of_an_angle_need_no_functions_of_their_own(
    angle: sp.Expr, function: type[sp.Function]
) -> None:
    wanted = sp.Add(*(k * function(k * angle) for k in (1, 2, 3)))
    lines = share((), [("out", wanted)], Vocabulary())
    functions = set().union(*(e.atoms(sp.sin, sp.cos) for _, e in lines))
    assert {f.func for f in functions} <= {sp.sin, sp.cos}
    assert len(functions) <= 2
    values: dict[sp.Basic, float] = {Q: 0.7, N: 24.0}
    for name, expression in lines:
        values[sp.Symbol(name, real=True)] = float(expression.subs(values))
    own = {sp.sin: math.sin, sp.cos: math.cos}[function]
    at = 0.7 if angle == Q else 24.0 * 0.7
    assert values[sp.Symbol("out", real=True)] == pytest.approx(
        sum(k * own(k * at) for k in (1, 2, 3)), rel=1e-12
    )


def test_an_angle_that_stands_alone_stays() -> None:
    lines = share((), [("out", sp.sin(2 * Q) + sp.cos(3 * N))], Vocabulary())
    assert set().union(*(e.atoms(sp.sin, sp.cos) for _, e in lines)) == {
        sp.sin(2 * Q),
        sp.cos(3 * N),
    }


SIGN, ON = sp.symbols("slide side_on", real=True)


@pytest.mark.parametrize(
    ("power", "same"), [(SIGN**3, SIGN), (SIGN**4, SIGN**2), (SIGN**2, SIGN**2), (ON**2, ON)]
)
def test_powers_of_modes_are_reduced(power: sp.Expr, same: sp.Expr) -> None:
    words = Vocabulary(signs=frozenset({SIGN}), switches=frozenset({ON}))
    assert share((), [("out", N * power)], words) == [("out", N * same)]


def test_a_definition_that_only_renames_leaves_no_line() -> None:
    mass = sp.Symbol("mass", real=True)
    assert share([("mass", N)], [("out", Q / mass)], Vocabulary()) == [("out", Q / N)]


def test_a_shared_term_takes_the_name_that_it_is_known_under() -> None:
    twist = sp.exp(-(Q**2)) * N
    words = Vocabulary(meanings=[("twist", twist)])
    lines = share((), [("one", twist + 1), ("two", twist + Q)], words)
    known = sp.Symbol("twist", real=True)
    assert lines == [("twist", twist), ("one", known + 1), ("two", known + Q)]


A, B, C = sp.symbols("a b c", real=True)


def computed(lines: list[tuple[str, sp.Expr]], values: dict[sp.Basic, float]) -> dict[str, float]:
    """What the lines compute in turn."""
    found = dict(values)
    for name, expression in lines:
        found[sp.Symbol(name, real=True)] = float(expression.subs(found))
    return {name: found[sp.Symbol(name, real=True)] for name, _ in lines}


def test_a_difference_and_its_negative_are_one_term() -> None:
    wanted = [("one", sp.exp(A - B)), ("two", sp.sqrt(B - A) * C), ("three", (2 * A - 2 * B) * C)]
    lines = share((), wanted, Vocabulary())
    assert len([e for _, e in lines if e.has(sp.Add)]) == 1
    found = computed(lines, {A: 0.3, B: 0.7, C: 1.5})
    assert found["one"] == pytest.approx(math.exp(-0.4), rel=1e-14)
    assert found["two"] == pytest.approx(math.sqrt(0.4) * 1.5, rel=1e-14)
    assert found["three"] == pytest.approx(-1.2, rel=1e-14)


def test_a_definition_that_is_the_negative_of_another_leaves_no_line() -> None:
    first, second = sp.symbols("first second", real=True)
    given = [("first", A * B), ("second", -A * B)]
    lines = share(given, [("one", first + C), ("two", second * C)], Vocabulary())
    assert lines == [("first", A * B), ("one", first + C), ("two", -first * C)]


def test_powers_of_a_root_need_one_root_and_no_power() -> None:
    inside = A + B
    wanted = [("one", sp.sqrt(inside)), ("two", C * inside ** sp.Rational(-3, 2))]
    lines = share((), wanted, Vocabulary())
    roots = [p for _, e in lines for p in e.atoms(sp.Pow) if p.exp.is_Rational and p.exp.q == 2]
    assert roots == [sp.sqrt(inside)]
    found = computed(lines, {A: 0.3, B: 0.7, C: 1.5})
    assert (found["one"], found["two"]) == (pytest.approx(1.0), pytest.approx(1.5))


@pytest.mark.parametrize(
    ("term", "name"),
    [
        (A * B, "a_b"),
        (2 * A / B, "twice_a_per_b"),
        (A - B, "a_minus_b"),
        (1 + A * B, "one_plus_a_b"),
        (A**-2, "a_inverse_sq"),
        (sp.exp(-A), "exp_minus_a"),
        (sp.Abs(A * B), "abs_a_b"),
    ],
)
def test_a_shared_term_is_called_what_it_is(term: sp.Expr, name: str) -> None:
    lines = share((), [("one", sp.sin(term)), ("two", sp.cos(term))], Vocabulary())
    assert name in [target for target, _ in lines]
