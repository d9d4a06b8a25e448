"""The equations that the report prints are those that the emitted module computes.

The LaTeX of the document is read back and evaluated at random states; the module is run as it is
emitted, without compilation.
"""

import re
from functools import cache, cached_property
from typing import Any

import numpy as np
import pytest
import sympy as sp
from sympy import symbols as symbols_of

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.platform import AXES, Platform, preset_names, read_platform
from ptp_symbolic.report.derivation.results import equations_of_motion
from ptp_symbolic.report.derivation.symbols import symbols
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.removal import without_effect
from ptp_symbolic.symbolic.documents.latex import latex_lines, symbol_latex
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from tests.effects.bases import IDS
from tests.effects.plain_python import as_python
from tests.report.latex_reading import Reader, equations_in, symbol
from tests.report.sections import law_of, section

STATES = 4
TIME = 0.37


def test_a_product_too_long_for_a_line_is_broken_between_its_factors() -> None:
    x, y, z = (symbols_of(f"{letter}1:8") for letter in "xyz")
    angles = sp.Add(*(a * sp.cos(n * x[0]) for n, a in enumerate(y)))
    law = sp.exp(-sum(a**2 for a in z) / x[1]) * sp.Max(0, angles) * (x[2] + z[0] * sp.sin(y[1]))
    expression = x[3] + law * sp.exp(-angles / z[1])
    numbers = {s: 0.3 + 0.1 * n for n, s in enumerate((*x, *y, *z))}
    reader = Reader({symbol(symbol_latex(str(s))): v for s, v in numbers.items()}, {})
    lines = latex_lines(expression)
    assert len(lines) > 2
    assert reader.evaluate(" ".join(lines)) == pytest.approx(float(expression.subs(numbers)))


class Machine:
    """A platform, its printed equations of motion and table of symbols, and its emitted module."""

    def __init__(self, platform: Platform) -> None:
        self.platform = platform
        self.equations = assemble(platform)
        self.printed = equations_in(equations_of_motion(self.equations))
        table = symbols(self.equations, platform)
        self.known = {symbol(s) for s in re.findall(r"^\$([^$]+)\$ &", table, re.MULTILINE)}

    @cached_property
    def module(self) -> dict[str, Any]:
        """The emitted module, its functions as plain Python."""
        return vars(as_python(emission.emit(self.platform)).module)

    def names(self) -> list[str]:
        e: Equations = self.equations
        states, modes = (list(map(str, s)) for s in (e.state_symbols, e.mode_symbols))
        return [*states, *modes, *(i.name for i in e.inputs), *(p.name for p in e.parameters)]

    def derivative(self, values: dict[str, float]) -> dict[str, float]:
        """Rates of change of all states by name, as the module computes them."""
        names = self.module
        x, u, m = (
            np.array([values[n] for n in names[key]])
            for key in ("STATE_NAMES", "INPUT_NAMES", "MODE_NAMES")
        )
        p = np.array([values[parameter.name] for parameter in self.equations.parameters])
        dx = np.zeros(len(x))
        names["mode_derivative"](TIME, x, u, p, m, dx)
        return dict(zip(names["STATE_NAMES"], dx, strict=True))

    def reader(self, values: dict[str, float]) -> Reader:
        """The printed definitions, with the values of what the table of symbols explains."""
        given = {symbol(symbol_latex(n)): values[n] for n in self.names()}
        return Reader(
            {s: v for s, v in given.items() if s in self.known} | {"t": TIME}, self.printed
        )

    def torques(self, values: dict[str, float]) -> list[float]:
        """M a on every row, with the printed M and the accelerations of the module."""
        read, rates = self.reader(values), self.equations.rates
        change = self.derivative(values)
        places = [
            [f"M_{{\\mathrm{{{min(i, j) + 1},{max(i, j) + 1}}}}}" for j in range(len(rates))]
            for i in range(len(rates))
        ]
        return [
            sum(
                read.value(place) * change[str(rate)]
                for place, rate in zip(row, rates, strict=True)
                if place in self.printed  # what is zero is not
            )
            for row in places
        ]


def random_values(equations: Equations, seed: int) -> dict[str, float]:
    """Parameters near their values, none at zero; states that slide, within reach of a linkage."""
    random = np.random.default_rng(seed)
    starts = {}
    for law in equations.effects:
        starts |= {
            p.name.format(axis=law.axis): p.starts[-1] for p in law.effect.parameters if p.starts
        }
    values = {}
    for p in equations.parameters:
        value = p.default or starts.get(p.name) or min(0.1, p.upper)
        values[p.name] = value * random.uniform(0.9, 1.1)
    for symbol_ in equations.state_symbols:
        values[str(symbol_)] = random.uniform(0.05, 0.2) * random.choice([-1.0, 1.0])
    for given in equations.inputs:
        values[given.name] = random.uniform(0.5, 1.0) * random.choice([-1.0, 1.0])
    for friction in equations.frictions:
        values[f"slide_{friction.axis}"] = float(np.sign(values[str(friction.rate)]))
    for name in (*(c.axis for c in equations.contacts), *(s.name for s in equations.switches)):
        values[f"side_{name}"] = random.choice([-1.0, 1.0])
        values[f"active_{name}"] = random.choice([0.0, 1.0])
    for contact in equations.contacts:
        if contact.rigid:  # apart: joined, their rows are not those that are printed
            values[f"active_{contact.axis}"] = 0.0
            values[f"side_{contact.axis}"] = 0.0
    return values


@cache
def machine_with(effect: str) -> Machine:
    return Machine(law_of(effect)[1])


def check(machine: Machine) -> None:
    rates = machine.equations.rates
    for seed in range(STATES):
        values = random_values(machine.equations, seed)
        read, change = machine.reader(values), machine.derivative(values)
        torques = [read.value(symbol(symbol_latex(f"f_{place_of(rate)}"))) for rate in rates]
        np.testing.assert_allclose(torques, machine.torques(values), rtol=1e-9, atol=1e-11)
        for state in machine.equations.extra_states:
            left = re.sub(r"^(\\?\w+?)(_|$)", r"\\dot{\1}\2", symbol(symbol_latex(state.name)))
            if left in machine.printed:
                assert read.value(left) == pytest.approx(change[state.name], rel=1e-9), left


@pytest.mark.parametrize("name", preset_names())
def test_printed_mass_matrix_and_torques_are_those_of_the_module(name: str) -> None:
    check(Machine(read_platform(name)))


@pytest.mark.parametrize("effect", IDS)
def test_printed_equations_with_every_effect_are_those_of_its_module(effect: str) -> None:
    check(machine_with(effect))


@pytest.mark.parametrize("effect", IDS)
def test_what_an_effect_is_said_to_add_is_what_the_equations_without_it_lack(effect: str) -> None:
    """By name: a friction or shaft torque that has changed itself is printed anew."""
    machine = machine_with(effect)
    law = law_of(effect)[0]
    try:
        other = Machine(without_effect(machine.platform, effect, law.axis)[0])
    except InputError:
        pytest.skip("the machine cannot do without it")
    added = equations_in(section(effect))
    compared = [left for left in machine.printed if rf"\Delta{left}" in added]
    for seed in range(STATES):
        values = random_values(other.equations, seed) | random_values(machine.equations, seed)
        definitions = {**other.printed, **machine.printed}
        given = {**other.reader(values).values, **machine.reader(values).values}
        for left in compared:
            before, after, printed = (
                Reader(given, definitions).evaluate(text)
                for text in (other.printed[left], machine.printed[left], added[rf"\Delta{left}"])
            )
            scale = max(abs(before), abs(after))
            assert printed == pytest.approx(after - before, rel=1e-8, abs=1e-12 * scale), left


def test_the_torque_in_the_law_of_an_effect_is_what_it_adds_to_its_row() -> None:
    """Of all effects that have one, those of drives and shafts apart, which add more."""
    told = []
    for effect in IDS:
        machine = machine_with(effect)
        law = law_of(effect)[0]
        own = law.contribution
        places = {*map(place_of, own.torques)} if own.torques else {law.axis} & set(AXES)
        if own.drives or not (own.torques or own.potential):
            continue
        printed = equations_in(section(effect))
        for place in places:
            torque, added = (symbol(symbol_latex(f"{letter}_{place}")) for letter in "Tf")
            reader = machine.reader(random_values(machine.equations, 1))
            found, lacking = (reader.evaluate(printed[t]) for t in (torque, rf"\Delta{added}"))
            assert found == pytest.approx(lacking, rel=1e-9, abs=1e-12), effect
        told.append(effect)
    assert len(told) > 5


def test_a_sign_that_is_printed_wrong_is_found() -> None:
    machine = Machine(read_platform("thesis-payload"))
    left = symbol(symbol_latex("f_tilt"))
    machine.printed[left] = machine.printed[left].replace("-", "+", 1)
    with pytest.raises(AssertionError):
        check(machine)


def test_a_symbol_that_no_table_explains_is_found() -> None:
    machine = Machine(read_platform("thesis-payload"))
    machine.known.remove(symbol(symbol_latex("c_x_payload")))
    with pytest.raises(KeyError, match="neither in the table of symbols nor defined"):
        check(machine)
