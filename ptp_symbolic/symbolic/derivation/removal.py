"""A platform without one of its effects, for the comparison with and without it."""

from dataclasses import replace

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.placement import (
    available_quantities,
    place_effects,
    readings,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect

Key = tuple[str, str | None]  # id and axis of a declared effect


def without_effect(
    platform: Platform, effect: str, axis: str | None
) -> tuple[Platform, tuple[Effect, ...]]:
    """`platform` without one effect and its parameters, and the others that went with it: those
    that need a quantity which nothing defines any more.

    Raises InputError as `place_effects` does.
    """
    placed = place_effects(platform)
    kept = [(e, p) for e, p in placed if (e.id, p.axis) != (effect, axis)]
    gone: list[Effect] = []
    while True:
        available = available_quantities(kept) | readings(platform, kept)
        stranded = [
            (e, p)
            for e, p in kept
            if any(need.format(axis=p.axis) not in available for need in e.needs)
        ]
        if not stranded:
            break
        gone += [e for e, _ in stranded]
        kept = [pair for pair in kept if pair not in stranded]
    left: set[Key] = {(e.id, p.axis) for e, p in kept}
    lost = {q.name for e, p in placed if (e.id, p.axis) not in left for q in e.parameters_at(p)}
    rest = replace(
        platform,
        effects=tuple(d for d in platform.effects if (d.effect, d.axis) in left),
        parameters=tuple(p for p in platform.parameters if p.name not in lost),
    )
    return rest, tuple(gone)
