"""Functions of emitted modules that find the modes of a state, and those of lanes."""

import re
from collections.abc import Iterator, Sequence
from importlib import resources

from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.numba.literals import (
    COMPILED,
    INNER_WIDTH,
    filled,
    function_text,
    tuple_text,
    unpacking_text,
)
from ptp_symbolic.symbolic.targets.printing import Language

MARK = "# copied from here on\n"
CONSTANTS = re.compile(r"^[A-Z_]+, .*$", re.MULTILINE)
RULE = re.compile(r"^def (\w+)", re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+|(?:\.\d+)?e-?\d+)")
DERIVATIVE = '"""Write the time derivative of the state into dx{}."""'
MODES = '"""Write the modes that a state implies into m; see MODE_NAMES."""'
IMPLIED = (
    '"""Return the modes that a state implies, in the order of MODE_NAMES: contact from the'
    '\nseparation, sticking from the holding torque.\n"""'
)
STATE = ("t", "x", "u", "p")
GUARDS_OF_FRICTION, GUARDS_OF_CONTACT = 3, 4


def mode_functions_text(whole: Program, language: Language) -> str:
    """The functions that find the modes of a state, as text."""
    if not whole.has_modes:
        leaving = ['"""Leave m alone: this model has no modes."""', "return"]
        rows = [DERIVATIVE.format(""), "mode_derivative(t, x, u, p, (), dx)"]
        functions = [
            function_text(COMPILED, "initial_modes", (*STATE, "m"), leaving),
            function_text(COMPILED, "state_derivative", (*STATE, "dx"), rows),
        ]
        return "\n\n\n".join(functions)
    entries = [f"m[{k}]" for k in range(len(whole.vectors.m))]
    found = [MODES, tuple_text("", entries, INNER_WIDTH, " = implied_modes(t, x, u, p)")]
    rows = [
        DERIVATIVE.format(", in the modes that the state implies"),
        "mode_derivative(t, x, u, p, implied_modes(t, x, u, p), dx)",
    ]
    implied = list(_implied_modes(whole, language))
    functions = [
        *_rules("\n".join(implied), language),
        function_text(COMPILED, "implied_modes", STATE, implied),
        function_text(COMPILED, "initial_modes", (*STATE, "m"), found),
        function_text(COMPILED, "state_derivative", (*STATE, "dx"), rows),
    ]
    return "\n\n\n".join(functions)


def with_modes(arguments: Sequence[str], modes: Sequence[str]) -> list[str]:
    """Arguments of a part that kernels call: modes one by one, so that none needs an array."""
    return [each for a in arguments for each in (modes if a == "m" else (a,))]


def lane_functions_text() -> str:
    """The functions that a derivative of several states at once calls, as text."""
    return _source("lanes.py").partition(MARK)[2].strip()


def _implied_modes(whole: Program, language: Language) -> Iterator[str]:
    """The lines of `implied_modes`: contacts of the state, frictions of its rates, then what holds
    in these modes.
    """
    modes, states = whole.vectors.m, whole.vectors.x
    frictions = len(whole.layout.friction_rates)
    rates = [states[k] for k in whole.layout.friction_rates]
    slides, contacts = (
        modes[:frictions],
        list(zip(modes[frictions::2], modes[frictions + 1 :: 2], strict=True)),
    )
    rigid = whole.layout.rigid_contacts or ((0, 0, 0),) * len(contacts)
    used = {*whole.layout.friction_rates, *(k for a, b, rule in rigid if rule for k in (a, b))}

    def evaluated(given: Sequence[str]) -> str:
        return filled(f"g = guard_values({', '.join((*STATE, *given))})", INNER_WIDTH)

    yield IMPLIED
    yield from unpacking_text([(states[k], "x", k) for k in sorted(used)], INNER_WIDTH)
    if contacts:
        yield evaluated([language.numeral(0.0)] * len(modes))
    for k, ((side, active), (gear, joint, rule)) in enumerate(zip(contacts, rigid, strict=True)):
        at = GUARDS_OF_FRICTION * frictions + GUARDS_OF_CONTACT * k
        given = f"g[{at}], g[{at + 1}], g[{at + 2}], g[{at + 3}]"
        if rule:
            given = f"g[{at}], g[{at + 1}], {states[gear]}, {states[joint]}"
        yield f"{side}, {active} = {'meeting' if rule else 'touching'}({given})"
    if slides:
        signs = ", ".join(f"np.sign({rate})" for rate in rates)
        yield filled(f"{', '.join(slides)} = {signs}", INNER_WIDTH)
    if any(rule for _, _, rule in rigid):
        yield evaluated(modes)
    for k, ((side, active), (_, _, rule)) in enumerate(zip(contacts, rigid, strict=True)):
        at = GUARDS_OF_FRICTION * frictions + GUARDS_OF_CONTACT * k
        if rule:
            yield f"{active} = pushing({side}, {active}, g[{at + 2}], g[{at + 3}])"
    if slides:
        yield evaluated(modes)
    for k, own in enumerate(slides):
        at = GUARDS_OF_FRICTION * k
        yield f"{own} = breaking_away({own}, g[{at}], g[{at + 1}], g[{at + 2}])"
    yield tuple_text("return ", modes, INNER_WIDTH)


def _rules(calls: str, language: Language) -> Iterator[str]:
    """The rules that are called, with numbers of the language."""
    head, *rules = _source("rules.py").strip().split("\n\n\n")
    for rule in rules:
        (name,) = RULE.findall(rule)
        if f"{name}(" in calls:
            needed = [line for line in CONSTANTS.findall(head) if line.split(",")[0] in rule]
            text = "\n\n\n".join([*needed, rule])
            yield NUMBER.sub(lambda found: language.number.format(found[0]), text)


def _source(file: str) -> str:
    own = resources.files("ptp_symbolic.symbolic.targets.numba.mode_functions")
    return (own / file).read_text()
