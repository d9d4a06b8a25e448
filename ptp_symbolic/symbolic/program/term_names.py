"""Words for the entries that kernels write, so that their shared terms can be named after them."""

from collections.abc import Mapping

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.effect_interface.place import active
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.program.sharing import Vocabulary

SAMPLER_WORDS = ("period", "offset", "phase")


def vocabulary(equations: Equations) -> Vocabulary:
    """Names for the shared terms of the kernels of `equations`."""
    switched = [contact.active for contact in equations.contacts]
    switched += [active(switch.name) for switch in equations.switches]
    switches = frozenset(switched)
    signs = frozenset(equations.mode_symbols) - switches
    return Vocabulary(_targets(equations), equations.quantities, signs, switches)


def _targets(equations: Equations) -> dict[str, str]:
    """Words by target: ``accel_pan`` for ``dx[2]``, ``accel_pan_by_b_pan`` for ``fp[2, 4]``."""
    rates = _numbered("dx", [_rate(s, equations) for s in equations.state_symbols])
    guards = _numbered("g", _guards(equations))
    readings = _numbered("y", [f"reading_{name}" for name, _, _ in equations.outputs])
    energy = _numbered("e", ["stored", "power_in", "dissipated"])
    columns = {
        "x": [str(s) for s in equations.state_symbols],
        "u": [i.name for i in equations.inputs],
        "p": [p.name for p in equations.parameters],
    }
    strikes = _numbered("strike", _strikes(equations))
    margins = _numbered("margin", [f"requirement_{k}" for k in range(len(equations.requirements))])
    bounds = {
        f"bounds[{k}, {side}]": f"{word}_{limit.state}"
        for k, limit in enumerate(equations.limits)
        for side, word in enumerate(("lowest", "highest"))
    }
    timing = [f"{w}_{k}" for k in range(len(equations.samplers)) for w in SAMPLER_WORDS]
    sampled = _numbered("z", [*timing, *(f"next_{state}" for _, state, _ in equations.updates)])
    further = {state.name for state in equations.extra_states}
    places = [place_of(rate) for rate in equations.rates]
    masses = {
        f"M[{i}, {j}]": f"mass_{one}" if i == j else f"mass_{places[min(i, j)]}_{places[max(i, j)]}"
        for i, one in enumerate(places)
        for j in range(len(places))
    }
    weights = _numbered("G", [f"gravity_torque_{place}" for place in places])
    lacking = [f"torque_{place}" for place in places]
    lacking += [f"rate_of_{s}" for s in map(str, equations.state_symbols) if s in further]
    errors = _numbered("r", lacking)
    words = {
        **rates,
        **errors,
        **masses,
        **weights,
        **guards,
        **readings,
        **energy,
        **strikes,
        **margins,
        **bounds,
        **sampled,
    }
    for letter, names in columns.items():
        words |= _derivatives("f", letter, rates, names)
        words |= _derivatives("g", letter, guards, names)
        words |= _derivatives("y", letter, readings, names)
        words |= _derivatives("z", letter, sampled, names)
        words |= _derivatives("strike", letter, strikes, names)
    return words


def _numbered(array: str, words: list[str]) -> dict[str, str]:
    return {f"{array}[{index}]": word for index, word in enumerate(words)}


def _derivatives(
    array: str, letter: str, rows: Mapping[str, str], names: list[str]
) -> dict[str, str]:
    return {
        f"{array}{letter}[{i}, {j}]": f"{row}_by_{name}"
        for i, row in enumerate(rows.values())
        for j, name in enumerate(names)
    }


def _rate(state: sp.Symbol, equations: Equations) -> str:
    """The time derivative of a state in words."""
    if state in equations.rates:
        return f"accel_{place_of(state)}"
    return f"rate_of_{state}"


def _guards(equations: Equations) -> list[str]:
    words = []
    for friction in equations.frictions:
        words += [f"{word}_{friction.axis}" for word in ("holding", "forward", "backward")]
    for contact in equations.contacts:
        words += [f"{word}_{contact.axis}" for word in ("separation", "half_gap", "upper", "lower")]
    for switch in equations.switches:
        words += [f"{word}_{switch.name}" for word in ("deviation", "threshold", "up", "down")]
    return words


def _strikes(equations: Equations) -> list[str]:
    words = []
    for contact in equations.contacts:
        words += [f"strike_{contact.axis}_on_{state}" for state in equations.state_symbols]
        words += [f"restitution_{contact.axis}", f"strike_energy_{contact.axis}"]
    return words
