"""Frames and symbols of the derivation report: what every letter means, in which unit."""

from collections.abc import Iterator

from ptp_symbolic.platform import ParameterDeclaration, Platform
from ptp_symbolic.report.derivation.named_functions import meaning_of
from ptp_symbolic.report.latex_text import displayed, escaped, table, unit_latex
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.latex import latex_of, symbol_latex
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import active, side, slide
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.simplify.readable import readable

PAN = r"The pan frame turns about the $z$ axis of the base by $\theta_{\mathrm{pan}}$"
TILT = r"the tilt frame turns about the $y$ axis of the {base} by $\theta_{{\mathrm{{tilt}}}}$"
BORESIGHT = (
    r" The boresight is the $x$ axis of the tilt frame, and a positive tilt angle lowers it."
)
BODY_RATES = (
    r" The body rates of the tilt body are $(-\omega_{\mathrm{pan}}\sin\theta_{\mathrm{tilt}},\;"
    r"\omega_{\mathrm{tilt}},\;\omega_{\mathrm{pan}}\cos\theta_{\mathrm{tilt}})$ (thesis Eq.~3.1)."
)
SLIDE = (
    r"The pan body slides along the horizontal $x$ axis of the base, without turning; its position"
    r" is $\theta_{\mathrm{pan}}$."
)
CATALOGUE = "default of the catalogue"


def frames(equations: Equations) -> str:
    """The frames that this platform has, and gravity in its base."""
    if equations.rigid.sliding:
        text = SLIDE
    elif equations.axes == ("pan",):
        text = f"{PAN}; the boresight is its $x$ axis."
    elif equations.axes == ("tilt",):
        base = TILT.format(base=r"base, which is level,")
        text = f"{base[:1].upper()}{base[1:]}.{BORESIGHT}"
    else:
        text = f"{PAN}; {TILT.format(base='pan frame')}. {_crossing(equations)}{BORESIGHT}"
        text += BODY_RATES
    gravity = displayed(rf"\mathbf{{g}} = {latex_of(equations.rigid.gravity.applyfunc(readable))}")
    unit = unit_latex("m/s^2")
    return rf"\section{{Frames and signs}}{text} Gravity in the base frame, in {unit}, is{gravity}"


def _crossing(equations: Equations) -> str:
    """Where the axes cross, or how far the second lies from the first."""
    offset = equations.rigid.offset("tilt")
    if not any(offset):
        return "The axes cross in the origin."
    return (
        rf"The origin of the tilt frame, on the tilt axis, lies at ${latex_of(offset.T)}$ m in the"
        " pan frame, whose origin is on the pan axis."
    )


def symbols(equations: Equations, platform: Platform) -> str:
    """Tables of the parameters, and of states, inputs, modes and named functions."""
    declared = {d.name: d for d in platform.parameters}
    rows = [
        [
            f"${symbol_latex(p.name)}$",
            escaped(p.meaning),
            unit_latex(p.unit),
            f"{p.default:.6g}",
            _origin(p, declared.get(p.name)),
        ]
        for p in equations.parameters
    ]
    others = [
        [f"${symbol_latex(name)}$", meaning, unit_latex(unit), kind]
        for name, meaning, unit, kind in _variables(equations)
    ]
    return (
        r"\section{Symbols} Parameters:"
        + table("lL{60mm}lrl", ["symbol", "meaning", "unit", "value", ""], rows)
        + r"\par\noindent Variables:\nopagebreak"
        + table("lL{78mm}ll", ["symbol", "meaning", "unit", ""], others)
    )


def _origin(parameter: Parameter, declaration: ParameterDeclaration | None) -> str:
    """Where the value of a parameter comes from."""
    if declaration is None:
        return CATALOGUE
    if declaration.same_as is not None:
        return f"same as ${symbol_latex(declaration.same_as)}$"
    return "free, start value" if declaration.free else "known"


def _variables(equations: Equations) -> Iterator[tuple[str, str, str, str]]:
    """Name, meaning as LaTeX, unit and kind of every symbol that is no parameter."""
    meanings = {s.name: (escaped(s.meaning), s.unit) for s in equations.extra_states}
    for symbol in equations.state_symbols:
        name = str(symbol)
        meaning, unit = meanings.get(name) or _joint_state(name)
        yield name, equations.worded(meaning), equations.unit(unit), "state"
    for given in equations.inputs:
        yield given.name, escaped(given.meaning), given.unit, "input"
    for friction in equations.frictions:
        rate = symbol_latex(str(friction.rate))
        meaning = rf"direction in which the friction on ${rate}$ slides: $-1$, $1$, at rest 0"
        yield str(slide(friction.axis)), meaning, "1", "mode"
    for contact in equations.contacts:
        face = f"face of the gap in the {contact.axis} drive that is touched: $-1$, $1$, none 0"
        yield str(contact.side), face, "1", "mode"
        transmits = equations.worded("1 while this face transmits torque, else 0")
        yield str(contact.active), transmits, "1", "mode"
    for switch in equations.switches:
        name = escaped(switch.name)
        beyond = f"threshold that {name} is beyond: the lower $-1$, the upper $1$, none 0"
        yield str(side(switch.name)), beyond, "1", "mode"
        yield str(active(switch.name)), f"1 while {name} is on, else 0", "1", "mode"
    yield from _torques(equations)
    for symbol, _ in equations.terms:
        meaning, unit = meaning_of(str(symbol))
        yield str(symbol), meaning, unit, "function"


def _torques(equations: Equations) -> Iterator[tuple[str, str, str, str]]:
    """What the equations of friction and contact name beside states and functions."""
    unit = equations.unit("N m")
    for friction in equations.frictions:
        at, rate = place_of(friction.rate), symbol_latex(str(friction.rate))
        for word, meaning in (
            ("sliding", rf"friction torque on ${rate}$ while it slides"),
            ("sticking", rf"torque that friction has to take up for ${rate}$ to stay at zero"),
            ("breakaway", rf"largest torque that friction takes up at ${rate}=0$"),
            ("ahead", rf"breakaway on ${rate}$ in the positive direction"),
            ("back", rf"breakaway on ${rate}$ in the negative direction"),
            ("friction", rf"torque that friction on ${rate}$ takes up"),
            ("limit", "most that it can take up, at rest or sliding"),
        ):
            yield f"F_{word}_{at}", equations.worded(meaning), unit, "torque"
    for contact in equations.contacts:
        axis, length = contact.axis, equations.unit("rad")
        turned = equations.worded("angle of the gear output ahead of the joint")
        yield f"separation_{axis}", f"{turned}, {axis} axis", length, "function"
        yield f"half_gap_{axis}", f"half of the gap in the {axis} drive", length, "function"
        if not contact.rigid:
            meaning = f"torque of the {axis} shaft at a face"
            yield f"T_shaft_{axis}", equations.worded(meaning), unit, "torque"
        meaning = f"torque that the {axis} drive transmits to the joint"
        yield f"T_transmitted_{axis}", equations.worded(meaning), unit, "torque"


def _joint_state(name: str) -> tuple[str, str]:
    """Meaning and unit of an angle or a rate, from its name."""
    letter, *place = name.split("_")
    where = f"{place[-1]} gear output" if place[0] == "gear" else f"{place[-1]} joint"
    return (
        (f"angle of the {where}", "rad") if letter == "theta" else (f"rate of the {where}", "rad/s")
    )
