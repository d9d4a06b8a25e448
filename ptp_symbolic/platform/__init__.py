"""The declared machine as plain data: read from TOML, checked, written back."""

from ptp_symbolic.platform.declaration import (
    AXES,
    INTERPOLATIONS,
    JOINTS,
    SITES,
    STANDARD_GRAVITY,
    Clock,
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    SignalDeclaration,
    effect_key,
    interpolation_of,
    naming_file,
)
from ptp_symbolic.platform.reader import platform_file, preset_names, read_platform
from ptp_symbolic.platform.writer import platform_text

__all__ = [
    "AXES",
    "INTERPOLATIONS",
    "JOINTS",
    "SITES",
    "STANDARD_GRAVITY",
    "Clock",
    "EffectDeclaration",
    "ParameterDeclaration",
    "Platform",
    "SignalDeclaration",
    "effect_key",
    "interpolation_of",
    "naming_file",
    "platform_file",
    "platform_text",
    "preset_names",
    "read_platform",
]
