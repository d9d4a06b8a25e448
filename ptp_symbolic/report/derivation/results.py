"""The equations of motion of the whole machine, with friction, contact and states."""

from collections.abc import Sequence
from itertools import groupby

from ptp_symbolic.report.latex_text import numbered
from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.documents.statements import (
    RELATIONS,
    Statement,
    statements,
)
from ptp_symbolic.symbolic.effect_interface.place import active, slide

EQUATIONS = "Equations of motion"  # the section in which every statement of a machine stands


def equations_of_motion(equations: Equations) -> str:
    """Section with mass matrix, torques, modes, states and signals of the whole machine."""
    found = statements(equations)
    sums = [s for s in found if s.sums and s.right != 0]
    parts = [rf"\section{{{EQUATIONS}}}", r"$M(q)\,\dot\omega = f$, with", _displayed(sums)]
    for friction in equations.frictions:
        rate, direction = (symbol_latex(str(s)) for s in (friction.rate, slide(friction.axis)))
        parts.append(
            rf"Dry friction acts on ${rate}$ against the direction ${direction}=\pm1$ of sliding;"
            rf" at rest, ${direction}=0$, it takes up the {equations.worded('torque')} that acts,"
            " up to breakaway:"
        )
        parts.append(
            _displayed([s for s in found if s.key[:2] == ("friction", str(friction.rate))])
        )
    for contact in equations.contacts:
        own = [s for s in found if s.key[:2] == ("contact", contact.axis)]
        parts += [_contact(contact), _displayed(own)]
    for switch in equations.switches:
        on = symbol_latex(str(active(switch.name)))
        words = (
            rf"${on}=1$ from where the deviation reaches the threshold, of either sign, until what"
            r" drives it changes sign; it is ready again between the thresholds:"
        )
        parts += [words, _displayed([s for s in found if s.key[:2] == ("switch", switch.name)])]
    for words, kinds in (
        ("The functions named in these equations are", ("term",)),
        ("Drives and effects have states of their own:", ("state",)),
        (
            "Constant in between, and updated at the instants $t_k$ from the values before them:",
            ("sampler",),
        ),
        ("Delayed inputs, and sensor readings:", ("input", "output")),
    ):
        own = [s for s in found if s.key[0] in kinds]
        if own:
            parts += [words, _displayed(own)]
    return "\n".join(parts)


def _displayed(rows: Sequence[Statement]) -> str:
    """Statements one below another, each with its own relation."""
    groups = groupby(rows, key=lambda s: s.relation)
    return "".join(
        numbered([(s.left_latex, s.right) for s in group], RELATIONS[relation][0])
        for relation, group in groups
    )


def _contact(contact: Contact) -> str:
    if contact.restitution is None:
        return rf"The shaft of the {contact.axis} axis has a dead zone; it cannot pull:"
    stuck = ", where the joint sticks" if contact.holds else ""
    return (
        rf"Gear output and joint of the {contact.axis} axis are rigid; they cross a gap{stuck},"
        " strike with this restitution, and turn as one body while in contact:"
    )
