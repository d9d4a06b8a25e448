"""Energy and power of an effect, and whether it only dissipates, from its expressions."""

from dataclasses import dataclass

import numpy as np
import sympy as sp

from ptp_symbolic.report.derivation.loops import loop
from ptp_symbolic.report.derivation.ranges import (
    RATES,
    FloatArray,
    Setting,
    evaluated,
    extent,
    setting,
)
from ptp_symbolic.report.latex_text import numbered
from ptp_symbolic.symbolic.derivation.equations import Equations, Ledger
from ptp_symbolic.symbolic.documents.laws import Law
from ptp_symbolic.symbolic.documents.statements import by_name
from ptp_symbolic.symbolic.effect_interface.contribution import Switch
from ptp_symbolic.symbolic.effect_interface.place import active, side, slide
from ptp_symbolic.symbolic.symbols import real

SAMPLES = 4000
MOST_TERMS = 30  # of an energy or power that is printed with one effect
ROUNDING = 1e-9


@dataclass(frozen=True)
class Judgement:
    """Whether an effect `only_dissipates`, None where its power is identically zero; `proved` for
    all values within the bounds of the parameters, else at sampled states of this machine.
    """

    only_dissipates: bool | None
    proved: bool


def power(law: Law, difference: Ledger | None, equations: Equations) -> str:
    """What the effect stores and takes; `difference` is the ledger of the machine with it minus
    that without, if there is one.
    """
    opening = "Its own energy and power are"
    ledger = law.ledger
    if _is_empty(ledger):
        ledger, opening = law.changed_ledger, "With it, what it acts on stores and takes"
    if _is_empty(ledger) and difference is not None:
        ledger, opening = difference, "It adds to the energy and power of the machine"
        if _terms(ledger) > MOST_TERMS:
            return "What it adds to the energy and power of the machine is in their ledger, below."
    modes = set(equations.mode_symbols)
    if _is_empty(ledger) or (ledger is difference and modes & _symbols(ledger)):
        return "It neither stores energy nor takes any: its power is that of what it acts on."
    names = ("E", r"P_{\mathrm{in}}", r"P_{\mathrm{diss}}")
    named = zip(names, ledger.parts, strict=True)
    rows = [(name, by_name(e, equations)) for name, e in named if e != 0]
    return f"{opening}{numbered(rows)}{_words(judged(law, ledger, equations))}"


def _is_empty(ledger: Ledger) -> bool:
    return all(part == 0 for part in ledger.parts)


def _terms(ledger: Ledger) -> int:
    return max(len(sp.Add.make_args(part)) for part in ledger.parts)


def _symbols(ledger: Ledger) -> set[sp.Symbol]:
    return set().union(*(part.free_symbols for part in ledger.parts))


def _words(found: Judgement) -> str:
    if found.only_dissipates is None:
        return "It is conservative: what it takes it gives back."
    where = (
        "for all values of the parameters within their bounds"
        if found.proved
        else "at all sampled states, with the values of this machine"
    )
    if found.only_dissipates:
        return rf"It only dissipates: $P_\mathrm{{diss}} - P_\mathrm{{in}} \ge 0$ {where}."
    return (
        r"It may feed energy: $P_\mathrm{diss} - P_\mathrm{in}$ is negative at some of the sampled"
        " states."
    )


def judged(law: Law, ledger: Ledger, equations: Equations) -> Judgement:
    """Whether dissipated less incoming power is never negative."""
    net = sp.expand(ledger.dissipated - ledger.power_in)
    if net == 0:
        return Judgement(None, True)
    given = setting(law, equations)
    cases = _cases(net, law, equations)
    if all(_nonnegative(case, given) for case in cases):
        return Judgement(True, True)
    values = np.concatenate([_sampled(case, law, given, equations) for case in cases])
    rounding = ROUNDING * max(float(np.abs(values).max()), 1e-300)
    return Judgement(bool((values >= -rounding).all()), False)


def _cases(net: sp.Expr, law: Law, equations: Equations) -> list[sp.Expr]:
    """`net` in both directions of sliding, in which the rate has the sign of the direction."""
    cases = [net]
    for friction in [after for _, after in law.frictions] or equations.frictions:
        direction = slide(friction.axis)
        if net.has(direction):
            speed = sp.Symbol(f"{friction.rate}", nonnegative=True)
            cases = [
                case.subs({friction.rate: sign * speed, direction: sign})
                for case in cases
                for sign in (-1, 1)
            ]
    return cases


def _nonnegative(net: sp.Expr, given: Setting) -> bool:
    """Whether `net` is never negative for parameters within their bounds, as far as SymPy sees."""
    signed = {
        p.symbol: sp.Symbol(p.name, positive=True)
        if p.lower > 0.0
        else sp.Symbol(p.name, nonnegative=True)
        for p in given.parameters
        if p.lower >= 0.0
    }
    return bool(
        net.xreplace(signed).is_nonnegative or sp.factor(net).xreplace(signed).is_nonnegative
    )


def _sampled(net: sp.Expr, law: Law, given: Setting, equations: Equations) -> FloatArray:
    """`net` [n] in W at random states, or along a loop of the states of the effect."""
    own = law.contribution
    twisting = real(f"twist_rate_{law.axis}")
    rates = sorted(net.free_symbols & {twisting, *RATES}, key=str)
    states = tuple(s for s in own.states if net.has(s.symbol))
    if states and len(rates) == 1:
        found = loop(states, own.switches, rates[0], given)
        if found is not None:
            return evaluated(net, found.points, given)
    random = np.random.default_rng(1)
    switches = [s for s in own.switches if net.has(side(s.name)) or net.has(active(s.name))]
    drawn = {*net.free_symbols}
    for switch in switches:
        drawn |= set().union(*(e.free_symbols for e in _conditions(switch)))
    points = {
        symbol: random.uniform(*_range(symbol, net, given, equations), SAMPLES)
        for symbol in sorted(drawn - given.values.keys(), key=str)
    }
    for switch in switches:
        points |= _modes(switch, points, given)
    return evaluated(net, points, given) if points else np.zeros(1)


def _conditions(switch: Switch) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    return switch.deviation, switch.threshold, switch.drive


def _modes(
    switch: Switch, points: dict[sp.Symbol, FloatArray], given: Setting
) -> dict[sp.Symbol, FloatArray]:
    """The modes [n] of a switch at `points`: on beyond its threshold while it is driven there."""
    deviation, threshold, drive = (
        np.broadcast_to(evaluated(e, points, given), SAMPLES) for e in _conditions(switch)
    )
    beyond = np.where(np.abs(deviation) > threshold, np.sign(deviation), 0.0)
    return {
        side(switch.name): beyond,
        active(switch.name): np.where(beyond * drive > 0.0, 1.0, 0.0),
    }


def _range(
    symbol: sp.Symbol, net: sp.Expr, given: Setting, equations: Equations
) -> tuple[float, float]:
    lower, upper = extent(real(str(symbol)), net, given, equations)
    return (max(lower, 0.0), upper) if symbol.is_nonnegative else (lower, upper)
