"""Every equation of a machine as a statement: what it is in words, its left and its right side."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.documents.latex import (
    latex_lines,
    latex_of,
    mathml_lines,
    mathml_of,
    plain_text_of,
    rate_latex,
)
from ptp_symbolic.symbolic.effect_interface.contribution import Friction, Sampler, Switch
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics.kinematics import TIME, place_of
from ptp_symbolic.symbolic.simplify.readable import readable
from ptp_symbolic.symbolic.symbols import ZERO, real

MANY_TERMS = 8  # of a sum that is printed once and named after
RELATIONS = {
    "=": ("=", "=", "="),
    "<=": (r"\le", "<=", "≤"),
    "->": (r"\;\to\;", "->", "→"),
}


@dataclass(frozen=True)
class Statement:
    """One equation; `part` says where it belongs: "friction", "contact", "" for anything else.

    `name` says in words what is on the left. `sums`: effects add to it, so that what one of them
    adds is of interest. Statements of two machines are about the same where `key` is.
    """

    key: tuple[str, ...]
    name: str
    left: sp.Expr
    right: sp.Expr
    relation: str = "="
    sums: bool = False
    part: str = ""

    @property
    def left_latex(self) -> str:
        """The left side in LaTeX; a rate of change with a dot."""
        if isinstance(self.left, sp.Derivative):
            return rate_latex(str(self.left.expr))
        return latex_of(self.left)

    @property
    def latex(self) -> str:
        """The equation in LaTeX, over several lines where it is long."""
        return aligned(f"{self.left_latex} {RELATIONS[self.relation][0]}", self.right)

    @property
    def text(self) -> str:
        """The equation as one line of text, names as in the emitted module."""
        sign = RELATIONS[self.relation][1]
        return f"{plain_text_of(self.left)} {sign} {plain_text_of(readable(self.right))}"

    @property
    def mathml(self) -> str:
        """The equation as MathML, a line of text for every piece that may stand on its own line."""
        left = f"<mrow>{mathml_of(self.left)}<mo>{RELATIONS[self.relation][2]}</mo></mrow>"
        return "\n".join([left, *mathml_lines(self.right)])


def aligned(left: str, right: sp.Expr) -> str:
    """LaTeX of `left` followed by the lines of `right`."""
    first, *more = latex_lines(right)
    if not more:
        return f"{left} {first}"
    rows = [f"{left}{{}}& {first}", *(f"& {line}" for line in more)]
    return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"


def statements(equations: Equations) -> list[Statement]:
    """All statements of a machine, those of the joints first; torques of shafts by their names."""
    return [
        replace(
            s,
            name=equations.worded(s.name),
            right=tidy(by_name(s.right, equations, s.left)),
        )
        for s in _written_out(equations)
    ]


def by_name(expression: sp.Expr, equations: Equations, defined: sp.Expr = ZERO) -> sp.Expr:
    """`expression` with friction, what shafts transmit and long sums of torques by their names,
    however they are written.

    The right side of what is `defined` keeps its own torque written out.
    """
    torques: dict[sp.Expr, sp.Expr] = _sums_of_torques(equations)
    torques |= {sliding(f): sp.expand(f.level) for f in equations.frictions}
    torques |= {shaft_torque(c): sp.expand(c.torque) for c in equations.contacts if not c.rigid}
    torques.pop(defined, None)
    pushing = {c.active * shaft_torque(c): c.active * c.torque for c in equations.contacts}
    torques |= {name: sp.expand(e) for name, e in pushing.items() if e != 0}
    names: dict[sp.Expr, sp.Expr] = {}
    for part in expression.atoms(sp.Add) if torques else ():
        written = sp.expand(part)
        for symbol, torque in torques.items():
            names |= {part: symbol} if written == torque else {}
            names |= {part: -symbol} if written == -torque else {}
    return expression.xreplace(names)


def _sums_of_torques(equations: Equations) -> dict[sp.Expr, sp.Expr]:
    """The torques on the rates, friction left out, as `_joints` names them; those of many terms."""
    frictions = {friction.rate: friction for friction in equations.frictions}
    found = {}
    for rate, torque in zip(equations.rates, equations.forcing, strict=True):
        if len(sp.Add.make_args(torque)) >= MANY_TERMS:
            name = real(f"f_{place_of(rate)}")
            if rate in frictions:
                name += slide(frictions[rate].axis) * sliding(frictions[rate])
            found[name] = sp.expand(torque)
    return found


def tidy(expression: sp.Expr) -> sp.Expr:
    """A sum with the numbers of every term in front."""
    return sp.Add(*map(sp.factor_terms, sp.Add.make_args(expression)))


def _written_out(equations: Equations) -> list[Statement]:
    return [
        *_joints(equations),
        *(s for friction in equations.frictions for s in friction_statements(friction)),
        *(s for contact in equations.contacts for s in _contact(contact)),
        *(s for switch in equations.switches for s in _switch(switch)),
        *(
            Statement(("term", str(symbol)), f"{symbol}, by its name in the others", symbol, term)
            for symbol, term in equations.terms
        ),
        *_states(equations),
        *(s for k, sampler in enumerate(equations.samplers) for s in _sampler(k, sampler)),
        *_signals(equations),
    ]


def with_definitions(shown: Sequence[Statement], found: Sequence[Statement]) -> list[Statement]:
    """`shown`, followed by those of `found` that say what the names in them stand for."""
    rows, by_name = list(shown), {s.left: s for s in found if s.left.is_Symbol}
    for row in rows:
        for symbol in sorted(row.right.free_symbols, key=str):
            meant = by_name.get(symbol)
            if meant is not None and meant not in rows:
                rows.append(meant)
    return rows


def sliding(friction: Friction) -> sp.Symbol:
    """The name of a friction torque while sliding."""
    return real(f"F_sliding_{place_of(friction.rate)}")


def shaft_torque(contact: Contact) -> sp.Symbol:
    """The name of what a shaft transmits while it touches a face."""
    return real(f"T_shaft_{contact.axis}")


def _joints(equations: Equations) -> Iterator[Statement]:
    rates = equations.rates
    for i, rate in enumerate(rates):
        for j in range(i, len(rates)):
            symbol = real(f"M_{i + 1}_{j + 1}")
            name = f"entry {i + 1}, {j + 1} of the mass matrix"
            entry = equations.mass_matrix[i, j]
            yield Statement(("mass", str(rate), str(rates[j])), name, symbol, entry, sums=True)
    frictions = {friction.rate: friction for friction in equations.frictions}
    for i, rate in enumerate(rates):
        torque = equations.forcing[i]
        if rate in frictions:
            torque -= slide(frictions[rate].axis) * sliding(frictions[rate])
        symbol = real(f"f_{place_of(rate)}")
        yield Statement(("torque", str(rate)), f"the torque on {rate}", symbol, torque, sums=True)


def friction_statements(friction: Friction) -> list[Statement]:
    """The law of a dry friction: sliding, sticking, and where it breaks away."""
    at, key = place_of(friction.rate), ("friction", str(friction.rate))
    direction = slide(friction.axis)
    stuck, broken = (real(f"F_{w}_{at}") for w in ("sticking", "breakaway"))
    return [
        Statement(
            (*key, "sliding"),
            f"sliding: the friction torque against the motion, {direction} = ±1",
            sliding(friction),
            friction.level,
            part="friction",
        ),
        Statement(
            (*key, "sticking"),
            f"sticking: at {friction.rate} = 0 and {direction} = 0 friction"
            " takes up the torque that acts, as long as",
            sp.Abs(stuck),
            broken,
            "<=",
            part="friction",
        ),
        Statement(
            (*key, "breakaway"),
            f"breakaway: the torque up to which it holds against a start in direction {direction}",
            broken,
            friction.breakaway,
            part="friction",
        ),
    ]


def _contact(contact: Contact) -> Iterator[Statement]:
    axis, key = contact.axis, ("contact", contact.axis)
    gap = real(f"half_gap_{axis}")
    apart = real(f"separation_{axis}")
    yield Statement(
        (*key, "gap"), f"half of the gap in the {axis} drive", gap, contact.half_gap, part="contact"
    )
    yield Statement(
        (*key, "angle"),
        f"the angle across the gap of {axis}",
        apart,
        contact.separation,
        part="contact",
    )
    if contact.restitution is None:
        name = f"the torque that the shaft of {axis} transmits at a face"
        yield Statement(
            (*key, "torque"), name, shaft_torque(contact), contact.torque, part="contact"
        )
    else:
        bounce = real(f"e_{axis}")
        name = f"the coefficient of restitution of a strike in {axis}"
        yield Statement((*key, "strike"), name, bounce, contact.restitution, part="contact")


def _switch(switch: Switch) -> Iterator[Statement]:
    for word, name, value in (
        ("deviation", "what is compared with its threshold", switch.deviation),
        ("threshold", "the threshold, of either sign, at which it switches on", switch.threshold),
        ("drive", "what drives it on: it goes off where this changes sign", switch.drive),
    ):
        yield Statement(
            ("switch", switch.name, word),
            f"switch {switch.name}: {name}",
            real(f"{word}_{switch.name}"),
            value,
            part="contact",
        )


def _states(equations: Equations) -> Iterator[Statement]:
    sampled = {symbol for _, symbol, _ in equations.updates}
    for state in equations.extra_states:
        symbol = state.symbol
        if symbol not in sampled:
            name = f"the rate of change of {state.name} ({state.meaning})"
            yield Statement(("state", state.name), name, rate_of(symbol), state.derivative)


def rate_of(symbol: sp.Symbol) -> sp.Expr:
    """The time derivative of a state, to be printed."""
    return sp.Derivative(symbol, TIME, evaluate=False)


def _sampler(number: int, sampler: Sampler) -> Iterator[Statement]:
    key = ("sampler", str(number))
    start = real("k") + sampler.phase
    instants = real("t_k")
    yield Statement(
        (*key, "instants"),
        "the sampling instants",
        instants,
        sampler.offset + start * sampler.period,
    )
    for symbol, term in sampler.terms.items():
        yield Statement((*key, str(symbol)), f"{symbol}, by its name in the others", symbol, term)
    for symbol, value in sampler.updates.items():
        yield Statement((*key, str(symbol)), f"{symbol} from there on", symbol, value)


def _signals(equations: Equations) -> Iterator[Statement]:
    for given, delay in zip(equations.inputs, equations.delays, strict=True):
        if delay is not None:
            late = sp.Function(given.name)(TIME - delay)
            symbol = real(f"{given.name}_acting")
            yield Statement(("input", given.name), f"{given.name} as it acts", symbol, late)
    for name, _, reading in equations.outputs:
        if reading != real(name):
            symbol = real(f"{name}_measured")
            yield Statement(("output", name), f"what the sensor of {name} shows", symbol, reading)
