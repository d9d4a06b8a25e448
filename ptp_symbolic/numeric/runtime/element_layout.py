"""Where frictions, contacts and switches stand among modes and guards of an emitted module.

Modes: one per friction, then side and activity per contact, then the same per switch. Guards: per
friction the holding torque (Lagrange multiplier of sticking) and the breakaway torque forward and
backward, in N m; per contact separation and half gap in rad, torque at the upper and at the lower
face in N m (of rigid faces that approach: a rate in rad/s); switches as contacts.
"""

from numba.extending import register_jitable

GUARDS_PER_FRICTION = 3
GUARDS_PER_CONTACT = 4
MODES_PER_CONTACT = 2


@register_jitable
def friction_guards(friction: int) -> int:
    """Index of the first guard of a friction."""
    return GUARDS_PER_FRICTION * friction


@register_jitable
def contact_guards(frictions: int, contact: int) -> int:
    """Index of the first guard of a contact; of so many contacts, the number of guards in all."""
    return GUARDS_PER_FRICTION * frictions + GUARDS_PER_CONTACT * contact


@register_jitable
def contact_modes(frictions: int, contact: int) -> int:
    """Index of the side of a contact among the modes; its activity follows."""
    return frictions + MODES_PER_CONTACT * contact


@register_jitable
def contact_count(frictions: int, modes: int) -> int:
    """Number of contacts and switches among `modes` modes, of which `frictions` are frictions."""
    return (modes - frictions) // MODES_PER_CONTACT
