"""Cogging: the motor prefers certain angles."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.harmonics import harmonic_members
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter, harmonics
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO

OF_SINE = "cogging torque that goes with the sine of the gear output's angle"
OF_COSINE = "cogging torque that goes with the cosine"
OF_CYCLES = "cogging cycles per turn of the gear output"
AMPLITUDES = harmonics(
    Parameter("T_sin_{axis}", "N m", 0.0, -1e4, 1e4, OF_SINE, vanishes=0.0, starts=(0.2,)),
    Parameter("T_cos_{axis}", "N m", 0.0, -1e4, 1e4, OF_COSINE, vanishes=0.0, starts=(0.2,)),
)
LINEAR = {"unit": "rad/m", "meaning": "wave number of the cogging: 2 pi over its length"}
CYCLES = Parameter("n_cog_{axis}", "1", 60.0, 0.5, 1e5, OF_CYCLES, locked_to="angle", linear=LINEAR)


def _contribute(place: Place) -> Contribution:
    cycles = place.parameter(CYCLES.name)
    potential = ZERO
    for order, pair in enumerate(AMPLITUDES, start=1):
        sine, cosine = place.symbols(pair)
        waves = order * cycles
        phase = waves * place.gear_angle
        potential += sine * sp.cos(phase) / waves - cosine * sp.sin(phase) / waves
    return Contribution(potential=potential)


COGGING = Effect(
    id="cogging",
    title="cogging of the motor",
    reference="Hanselman (2003), section 6: cogging as a position-dependent potential",
    parameters=(*(p for pair in AMPLITUDES for p in pair), CYCLES),
    contribute=_contribute,
    members=harmonic_members(AMPLITUDES, (CYCLES.name,)),
    separating_experiment="Turn the unpowered motor by hand or repeat at two loads: cogging stays,"
    " a transmission error grows with the load.",
)
