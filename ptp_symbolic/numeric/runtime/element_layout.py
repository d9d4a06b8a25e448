"""Where frictions, contacts and switches stand among modes and guards of an emitted module.

Modes: one per friction, then side and activity per contact, then the same per switch. Guards: per
friction what holds it, breakaway forward and backward; per contact the separation, half the gap,
the torque at the upper and at the lower face; switches as contacts.
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
    """Index of the first guard of a contact, or how many guards so many contacts make in all."""
    return GUARDS_PER_FRICTION * frictions + GUARDS_PER_CONTACT * contact


@register_jitable
def contact_modes(frictions: int, contact: int) -> int:
    """Index of the side of a contact among the modes; its activity follows."""
    return frictions + MODES_PER_CONTACT * contact


@register_jitable
def contact_count(frictions: int, modes: int) -> int:
    """How many contacts and switches so many modes hold."""
    return (modes - frictions) // MODES_PER_CONTACT
