"""The laws that every effect obeys, whatever it is, as a check for its author.

Each law takes a `Case`, an effect on a machine that has it, and raises InputError where the effect
breaks it.

Units of a model by trial: it moves the same way when kg, m, s and A are others.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import FunctionType, ModuleType
from typing import TypeVar

import numpy as np
import pint
import sympy as sp
from numba.extending import is_jitted

from ptp_symbolic.api.effect_bases import carriage_with, machine_with, machine_without
from ptp_symbolic.errors import InputError, wrong_type
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform
from ptp_symbolic.platform.units import to_si
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import active, side, slide
from ptp_symbolic.symbolic.effects import on_trial
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.program import dynamics


def unit_factor(unit: str) -> float:
    """How a number in `unit` changes when kg, m, s, A and K change; m = s^2 keeps gravity."""
    scales = {"[mass]": 3.0, "[length]": 4.0, "[time]": 2.0, "[current]": 7.0}
    scales["[temperature]"] = 5.0
    dimension = pint.get_application_registry()(unit if unit != "1" else "").to_base_units()
    factor = 1.0
    for base, exponent in dimension.dimensionality.items():
        factor *= scales[base] ** exponent
    return factor


def refuse_misfit(model: Model, effect: str, load: str, travel: str = "1") -> None:
    """Raise InputError where the units of `model` do not fit its functions; `load` is the unit of
    what acts on a joint, `travel` that of its coordinate (1 for rad).
    """
    units, rng = model.units, np.random.default_rng(2)
    names = (model.state_names, model.input_names, model.parameter_names)
    x, u = (rng.normal(size=len(n)) for n in names[:2])
    p = model.parameter_vector({q.name: q.default or q.upper * 1e-4 for q in model.parameters})
    m = np.ones(len(model.mode_names))
    scaled = [
        a * np.array([unit_factor(units[n]) for n in group])
        for a, group in zip((x, u, p), names, strict=True)
    ]
    t, later = 0.7, 0.7 * unit_factor("s")
    outputs = [unit_factor(units[name]) for name in model.output_names]
    force, apart = unit_factor(load), unit_factor(travel)
    guards = [force] * 3 * len(model.friction_rates)
    for _ in model.module.CONTACT_ANGLES:
        guards += [apart, apart, force, force]
    guards += [np.nan] * (3 * len(model.friction_rates) + 4 * len(model.contacts) - len(guards))
    rates = [unit_factor(units[n]) / unit_factor("s") for n in names[0]]
    powers = [unit_factor("J"), unit_factor("W"), unit_factor("W")]
    for function, factors, modes in (
        (model.module.mode_derivative, rates, (m,)),
        (model.module.guards, guards, (m,)),
        (model.module.energy, powers, (m,)),
        (model.module.outputs, outputs, ()),
    ):
        here, other = np.zeros((2, len(factors)))
        function(t, x, u, p, *modes, here)
        function(later, *scaled, *modes, other)
        known = np.isfinite(factors)
        wanted = (here * factors)[known]
        fits = np.isclose(other[known], wanted, rtol=1e-9, atol=1e-12)
        if not fits.all():
            raise InputError(
                f"Effect '{effect}': units do not fit {function.__name__}, entries"
                f" {np.flatnonzero(~fits).tolist()} of those known; correct a unit or the law."
            )


AnyModel = TypeVar("AnyModel", bound=Model)


def as_python(model: AnyModel) -> AnyModel:
    """`model` with functions that are not compiled, and call each other as such."""
    plain = ModuleType(model.module.__name__)
    space = vars(plain)
    space.update(vars(model.module))
    for name, function in vars(model.module).items():
        if is_jitted(function):
            space[name] = FunctionType(function.py_func.__code__, space, name)
    return replace(model, module=plain)


Expressions = dict[tuple[str, ...], sp.Expr]

POINTS = 5  # at which equations are compared
LEDGER_POINTS = 60
SIZES = (1e-3, 1.0, 30.0)  # of random states in SI
ROUNDING = 1e-10  # of an energy balance, relative to the powers in it
BEFORE_GEAR = {"K_t_pan": "N m/A", "J_motor_pan": "kg m^2"}  # they turn, on a linear axis too


@dataclass(frozen=True)
class Case:
    """An effect, and a machine that has it."""

    effect: Effect
    platform: Platform

    @cached_property
    def equations(self) -> Equations:
        """The equations of the machine."""
        return assemble(self.platform)

    @cached_property
    def model(self) -> Model:
        """The model of the machine, its functions as plain Python."""
        return as_python(emission.emit(self.platform))

    @cached_property
    def own(self) -> set[str]:
        """Names of the parameters of the effect on the machine."""
        placed = (e for e in self.equations.effects if e.effect is self.effect)
        return {name for e in placed for name in e.parameters}

    def refuse(self, wrong: object, law: str) -> None:
        """Raise InputError, with the `law`, if something is `wrong`."""
        if wrong:
            raise InputError(f"Effect '{self.effect.id}': {law}")


def parameters_are_used_and_have_units(case: Case) -> None:
    """Every declared parameter is in the equations, has a meaning and an SI unit."""
    used = {p.name: p for p in case.equations.parameters}
    for name in sorted(case.own):
        case.refuse(name not in used, f"parameter '{name}' is in no equation; use it or remove it.")
        parameter = used[name]
        case.refuse(not parameter.meaning, f"parameter '{name}' has no meaning; say what it is.")
        odd = parameter.unit != "1" and to_si(parameter.unit)[0] != 1.0
        case.refuse(odd, f"parameter '{name}' is in {parameter.unit}; give an SI unit.")


def values_lie_within_bounds(case: Case) -> None:
    """Default, starts and vanishing value of every parameter lie within its bounds."""
    for placed, place in place_effects(case.platform):
        for p in placed.parameters_at(place) if placed is case.effect else ():
            for value in (p.default, *p.starts, *(() if p.vanishes is None else (p.vanishes,))):
                case.refuse(
                    not p.lower <= value <= p.upper,
                    f"parameter '{p.name}' = {value:g} {p.unit} lies outside its bounds"
                    f" [{p.lower:g}, {p.upper:g}].",
                )


def names_follow_the_axis(case: Case) -> None:
    """Parameters and states of an effect on an axis bear its name; torques of a state come with
    what it stores.
    """
    for placed, place in place_effects(case.platform):
        if placed is not case.effect:
            continue
        added = placed.contribute(place)
        names = [p.name for p in placed.parameters_at(place)] + [s.name for s in added.states]
        odd = [n for n in names if place.axis is not None and place.axis not in n.split("_")]
        case.refuse(odd, f"{', '.join(odd)}: the name lacks the axis; end it in '_{{axis}}'.")
        given = {place.quantity(need) for need in placed.needs}
        by_others = any(torque.free_symbols & given for torque in added.torques.values())
        case.refuse(
            added.states and added.torques and added.stored == 0 and not by_others,
            "its states hold energy; declare it as `stored`.",
        )


def vanishes_where_it_says(case: Case) -> None:
    """At the vanishing values the machine is the one without the effect; elsewhere it is not."""
    if case.effect.structural:
        return
    off: dict[sp.Symbol, sp.Expr] = {
        p.symbol: sp.nsimplify(p.vanishes)
        for p in case.equations.parameters
        if p.name in case.own and p.vanishes is not None
    }
    case.refuse(not off, "give one of its parameters `vanishes`, or the effect `structural=True`.")
    case.refuse(
        not case.effect.separating_experiment,
        "say by `separating_experiment` which run tells it from others.",
    )
    bare = assemble(machine_without(case.platform, case.effect))
    known = {state.name for state in bare.extra_states}
    full = case.equations
    off |= {s.symbol: sp.Float(s.initial) for s in full.extra_states if s.name not in known}
    touching = {mode: 1 for c in full.contacts for mode in (c.active, c.side)}
    with_it, without_it = _named_expressions(full), _named_expressions(bare)
    random, changed = np.random.default_rng(8), False
    for key, expression in without_it.items():
        sides = with_it[key].subs(off).subs(touching), expression.subs(touching), with_it[key]
        symbols = sorted(set().union(*(e.free_symbols for e in sides)), key=str)
        for _ in range(POINTS):
            point = {symbol: sp.Float(random.uniform(0.1, 1.0)) for symbol in symbols}
            switched_off, alone, on = (complex(e.xreplace(point)) for e in sides)
            case.refuse(
                abs(switched_off - alone) > 1e-12 * max(1.0, abs(alone)),
                f"at its vanishing values it changes the {' '.join(key)} of the machine by"
                f" {abs(switched_off - alone):.3g}; correct `vanishes` or the law.",
            )
            changed = changed or abs(on - alone) > 1e-9 * abs(alone)
    case.refuse(not changed, "nothing in the equations depends on it; use what it contributes.")


def _named_expressions(equations: Equations) -> Expressions:
    """Everything that the equations of a machine say, by what it is."""
    found: Expressions = {}
    for i, rate in enumerate(map(str, equations.rates)):
        found["force on", rate] = equations.forcing[i]
        for j, other in enumerate(map(str, equations.rates)):
            found["mass of", rate, other] = equations.mass_matrix[i, j]
    for friction in equations.frictions:
        found["friction level of", str(friction.rate)] = friction.level
        found["breakaway of", str(friction.rate)] = friction.breakaway
    for contact in equations.contacts:
        found["separation of", contact.axis] = contact.separation
        found["half gap of", contact.axis] = contact.half_gap
    found |= {("derivative of", state.name): state.derivative for state in equations.extra_states}
    found |= {("output", name): reading for name, _, reading in equations.outputs}
    for given, delay in zip(equations.inputs, equations.delays, strict=True):
        found["delay of", given.name] = sp.Integer(0) if delay is None else delay
    ledger = equations.ledger
    found |= {("stored energy",): ledger.stored, ("dissipated power",): ledger.dissipated}
    written = {key: equations.written_out(e) for key, e in found.items()}
    return written | {("power in",): equations.written_out(ledger.power_in)}


def energy_is_accounted_for(case: Case) -> None:
    """d(stored)/dt = power in - dissipated at random states, in every mode that a machine can be
    in.
    """
    equations, random = case.equations, np.random.default_rng(11)
    solved = dynamics.solve_accelerations(equations)
    definitions = dict(solved.definitions)
    rates = dynamics.state_rates(equations, solved)
    states, ledger = equations.state_symbols, equations.ledger
    stored = equations.written_out(ledger.stored)
    flows = [sp.diff(stored, s) * r for s, r in zip(states, rates, strict=True)]
    flows.append(sp.diff(stored, TIME))
    parts = [sp.Add(*flows), ledger.power_in, ledger.dissipated, sp.Add(*map(sp.Abs, flows))]
    named = [(sp.Symbol(name, real=True), definitions[name]) for name in definitions]
    free = set().union(*(e.free_symbols for e in (*parts, *definitions.values())))
    symbols = sorted(free - {symbol for symbol, _ in named}, key=str)
    function = sp.lambdify(symbols, parts, "numpy", cse=lambda written: (named, written))
    for _ in range(LEDGER_POINTS):
        modes = random_modes(equations, random)
        values = admissible_values(equations, symbols, modes, random)
        change, supplied, dissipated, flowing = (float(v) for v in function(*values))
        size = flowing + abs(supplied) + abs(dissipated)
        lacking = change - supplied + dissipated
        case.refuse(
            abs(lacking) > ROUNDING * size,
            f"its energies do not balance: {lacking:.3g} W of {size:.3g} W come from nowhere;"
            " correct `stored` and `dissipated`.",
        )


def random_modes(equations: Equations, random: np.random.Generator) -> dict[str, float]:
    """Modes of friction and contact, and the rates that they force: a friction at rest rests."""
    modes: dict[str, float] = {}
    for friction in equations.frictions:
        direction = float(random.choice([-1.0, 0.0, 1.0]))
        modes[str(slide(friction.axis))] = direction
        if direction == 0.0:
            modes[str(friction.rate)] = 0.0
    sides = [(c.side, c.active) for c in equations.contacts if not c.rigid]
    sides += [(side(switch.name), active(switch.name)) for switch in equations.switches]
    for where, on in sides:
        modes[str(where)] = float(random.choice([-1.0, 0.0, 1.0]))
        modes[str(on)] = float(random.choice([0.0, 1.0])) * abs(modes[str(where)])
    return modes


def admissible_values(
    equations: Equations,
    symbols: Sequence[sp.Symbol],
    modes: Mapping[str, float],
    random: np.random.Generator,
) -> list[float]:
    """Random values of `symbols` in given modes, drawn until the parameters fit each other."""
    defaults = {p.name: p.default or 0.1 for p in equations.parameters}
    for _ in range(1000):
        values = []
        for name in (s.name for s in symbols):
            drawn = random.normal()
            if name in defaults:
                drawn = defaults[name] * random.uniform(0.5, 1.5)
            values.append(modes.get(name, float(drawn)))
        given = dict(zip(symbols, values, strict=True))
        if all(requirement.holds.subs(given) != sp.false for requirement in equations.requirements):
            return values
    raise InputError("No values near the defaults meet what effects `requires`; change them.")


def dissipation_only_takes(case: Case) -> None:
    """A `dissipative` effect never feeds energy: in the modes that follow from the state, the
    machine with it dissipates at least what it does with the effect switched off.
    """
    if not case.effect.dissipative:
        return
    model, random, most = case.model, np.random.default_rng(5), 0.0
    own = {p.name: p for p in model.parameters if p.vanishes is not None and p.name in case.own}
    p = model.parameter_vector({n: q.starts[0] for n, q in own.items() if q.starts})
    off = model.parameter_vector({n: float(q.vanishes or 0.0) for n, q in own.items()})
    for size in SIZES:
        for _ in range(200):
            x = size * random.normal(size=len(model.state_names))
            u = random.normal(size=len(model.input_names))
            whole, without = _dissipated(model, x, u, p), _dissipated(model, x, u, off)
            taken = whole - without if own else whole
            case.refuse(
                whole < 0.0 or taken < -1e-12 * abs(whole),
                f"it is `dissipative`, and feeds {-min(whole, taken):.3g} W at {x.tolist()};"
                " correct the sign of its torque, or leave `dissipative` out.",
            )
            most = max(most, taken)
    case.refuse(most <= 0.0, "it is `dissipative`, and takes no energy at any state.")


def _dissipated(model: Model, x: np.ndarray, u: np.ndarray, p: np.ndarray) -> float:
    modes, energies = np.zeros(len(model.mode_names)), np.zeros(3)
    model.module.initial_modes(0.0, x, u, p, modes)
    model.module.energy(0.0, x, u, p, modes, energies)
    return float(energies[2])


def other_units_give_the_same_motion(case: Case) -> None:
    """Where kg, m, s, A and K are others, all functions of the machine scale as its units say."""
    refuse_misfit(case.model, case.effect.id, "N m")


def it_fits_a_linear_joint_or_says_why_not(case: Case) -> None:
    """On a linear joint its units are those of forces; or it has `instead_on_linear`."""
    if case.effect.instead_on_linear:
        return
    model = as_python(emission.emit(carriage_with(case.effect)))
    refuse_misfit(model, case.effect.id, "N", "m")
    for name, unit in model.units.items():
        turns = name not in BEFORE_GEAR and re.search(r"N m|kg m|rad(?!/m)", unit)
        case.refuse(turns, f"'{name}' is in {unit} on a linear joint; give its linear unit.")


LAWS: tuple[Callable[[Case], None], ...] = (
    parameters_are_used_and_have_units,
    values_lie_within_bounds,
    names_follow_the_axis,
    vanishes_where_it_says,
    energy_is_accounted_for,
    dissipation_only_takes,
    other_units_give_the_same_motion,
    it_fits_a_linear_joint_or_says_why_not,
)


def check_effect(effect: Effect, platform: Platform | None = None) -> tuple[str, ...]:
    """Check that `effect` obeys the laws that every effect obeys; returns them in words.

    They are tried on `platform`, a machine that has the effect, or on a packaged one that can take
    it (None); the effect need not be in the catalogue. Raises InputError with the first law that it
    breaks, where, and what to do.

    >>> import ptp_symbolic as ptp
    >>> from ptp_symbolic.symbolic.effects.quadratic_drag import QUADRATIC_DRAG
    >>> len(ptp.check_effect(QUADRATIC_DRAG))
    8
    """
    if not isinstance(effect, Effect):
        raise wrong_type(repr(effect), effect, "an Effect")
    with on_trial(effect):
        case = Case(effect, machine_with(effect) if platform is None else platform)
        for law in LAWS:
            law(case)
    return tuple(" ".join((law.__doc__ or "").split()) for law in LAWS)
