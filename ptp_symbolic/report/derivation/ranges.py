"""At which values, and over which range, the law of an effect is drawn and its power judged."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.laws import Law
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.mechanics import kinematics

FloatArray = NDArray[np.float64]
RATES = {of(a) for of in (kinematics.rate, kinematics.gear_rate) for a in kinematics.AXES}
SCALES = 4.0  # range on either side, in the smallest parameter of the variable's unit
USUAL = {  # half a range where no parameter says how far, in the unit
    "rad": np.pi,
    "m": 0.1,
    "rad/s": 1.0,
    "m/s": 1.0,
    "V": 24.0,
    "A": 2.0,
    "K": 20.0,
    "s": 1.0,
    "N m": 1.0,
    "N": 10.0,
}
USUAL_TWIST = 0.01  # rad, of a shaft without play
UNITS = {  # of symbols that are no state, input or parameter, by the start of their name
    "theta": "rad",
    "omega": "rad/s",
    "twist_rate": "rad/s",
    "twist": "rad",
    "transmitted_torque": "N m",
    "shaft_torque": "N m",
    "t": "s",
    "u": "V",
    "i": "A",
}


@dataclass(frozen=True)
class Setting:
    """Values of all parameters by symbol, the parameters of the machine, and of the effect those
    that vanish as declared and so have a start of a search instead.
    """

    values: Mapping[sp.Symbol, float]
    parameters: tuple[Parameter, ...]
    replaced: tuple[Parameter, ...]


def setting(law: Law, equations: Equations) -> Setting:
    """The declared values; where the effect vanishes at them, those from which a search starts."""
    values = {p.symbol: p.default for p in equations.parameters}
    own = law.effect.parameters_at(law.place)
    switching = [p for p in own if p.vanishes is not None and p.symbol in values]
    off = bool(switching) and all(values[p.symbol] == p.vanishes for p in switching)
    replaced = tuple(p for p in switching if p.starts) if off else ()
    values |= {p.symbol: p.starts[-1] for p in replaced}
    return Setting(values, equations.parameters, replaced)


def unit_of(symbol: sp.Symbol, equations: Equations) -> str:
    """The unit of a state, input, parameter or quantity; empty where it is not known."""
    name = str(symbol)
    known = {s.name: s.unit for s in equations.extra_states}
    known |= {given.name: given.unit for given in equations.inputs}
    known |= {p.name: p.unit for p in equations.parameters}
    if name in known:
        return known[name]
    longest = sorted((w for w in UNITS if f"{name}_".startswith(f"{w}_")), key=len)
    return equations.unit(UNITS[longest[-1]]) if longest else ""


def extent(
    variable: sp.Symbol, expression: sp.Expr, given: Setting, equations: Equations
) -> tuple[float, float]:
    """Over which values of `variable` to draw `expression`: within the limits of the state; else
    around the parameters that are measured against it; else two of its periods; else a usual range.
    """
    for limit in equations.limits:
        if limit.state == variable:
            ends = (
                equations.written_out(e).xreplace(_exact(given)) for e in (limit.lower, limit.upper)
            )
            lower, upper = (float(sp.re(sp.N(end))) for end in ends)
            margin = 1e-3 * (upper - lower)
            return lower + margin, upper - margin
    if str(variable).startswith("twist_") and not str(variable).startswith("twist_rate_"):
        return _twists(variable, given, equations)
    unit = unit_of(variable, equations)
    beside = [p for p in given.parameters if p.unit == unit and p.symbol in expression.free_symbols]
    scales = [given.values[p.symbol] for p in beside if p.lower >= 0.0]
    centres = [given.values[p.symbol] for p in beside if p.lower < 0.0]
    centre = centres[0] if len(centres) == 1 else 0.0
    half = SCALES * min(scales) if scales and min(scales) > 0.0 else USUAL.get(unit, 1.0)
    if not scales and (period := _period(variable, expression, given)):
        half = period
    return (0.0, half) if unit == "s" else (centre - half, centre + half)


def _twists(variable: sp.Symbol, given: Setting, equations: Equations) -> tuple[float, float]:
    """The twists of a shaft that are drawn: as far as its gap is wide, or a usual range."""
    gaps = [c.half_gap for c in equations.contacts if str(variable) == f"twist_{c.axis}"]
    widths = [abs(float(sp.N(gap.xreplace(_exact(given))))) for gap in gaps]
    half = SCALES * widths[0] if widths and widths[0] > 0.0 else USUAL_TWIST
    return -half, half


def _exact(given: Setting) -> dict[sp.Symbol, sp.Expr]:
    return {symbol: sp.Float(value) for symbol, value in given.values.items()}


def _period(variable: sp.Symbol, expression: sp.Expr, given: Setting) -> float:
    """The longest period of the waves of `variable` in `expression`; 0 where there is none."""
    waves = [wave.args[0] for wave in expression.atoms(sp.sin, sp.cos) if wave.has(variable)]
    slopes = [sp.diff(phase, variable).xreplace(_exact(given)) for phase in waves]
    if not slopes or any(slope.free_symbols for slope in slopes):
        return 0.0
    return 2.0 * np.pi / min(abs(float(slope)) for slope in slopes)


def evaluated(
    expression: sp.Expr, points: Mapping[sp.Symbol, FloatArray], given: Setting
) -> FloatArray:
    """`expression` [n] at `points`, other symbols at zero."""
    number = expression.rewrite(sp.floor).xreplace(_exact(given))
    number = number.xreplace({s: sp.Integer(0) for s in number.free_symbols - points.keys()})
    function = sp.lambdify(list(points), number, "numpy")
    with np.errstate(all="ignore"):
        found = np.asarray(function(*points.values()), dtype=np.float64)
    return np.broadcast_to(found, next(iter(points.values())).shape)
