"""The printed section of every effect, made once for all tests."""

from functools import cache

from ptp_symbolic.platform import Platform
from ptp_symbolic.report.derivation.effects import effect_section
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.laws import Law, laws
from ptp_symbolic.symbolic.effects import EFFECTS
from tests.effects.bases import with_effect


@cache
def law_of(effect: str) -> tuple[Law, Platform, Equations]:
    """The law of an effect on a platform that has it."""
    platform = with_effect(next(e for e in EFFECTS if e.id == effect))
    law = next(law for law in laws(platform) if law.effect.id == effect)
    return law, platform, assemble(platform)


@cache
def section(effect: str) -> str:
    """Its section in the report."""
    return effect_section(*law_of(effect))
