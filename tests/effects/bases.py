"""Platforms on which effects are tried, and their ids."""

from ptp_symbolic.api.effect_bases import bases, machine_with, machine_without
from ptp_symbolic.symbolic.effects import EFFECTS

BASES = bases()
IDS = [effect.id for effect in EFFECTS]
with_effect = machine_with
without = machine_without
