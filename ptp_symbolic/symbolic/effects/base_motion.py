"""A base that shakes: it accelerates sideways, sinusoidally."""

import math

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.mechanics.kinematics import TIME

PARAMETERS = (
    Parameter(
        "a_base",
        "m/s^2",
        0.0,
        0.0,
        1e3,
        "amplitude of the base's acceleration",
        vanishes=0.0,
        starts=(0.3,),
    ),
    Parameter("f_base", "Hz", 1.0, 1e-3, 1e3, "frequency of the base's motion", locked_to="time"),
    Parameter(
        "phi_base",
        "rad",
        0.0,
        -7.0,
        7.0,
        "phase of the base's acceleration (a sine) at time zero",
        starts=(0.0, 2.0, -2.0),
        period=2 * math.pi,
    ),
    Parameter(
        "psi_base",
        "rad",
        0.0,
        -7.0,
        7.0,
        "azimuth of the base's motion",
        starts=(0.0, 1.6),
        period=2 * math.pi,
    ),
)


def _contribute(place: Place) -> Contribution:
    amplitude, frequency, phase, azimuth = place.symbols(PARAMETERS)
    acceleration = amplitude * sp.sin(2 * sp.pi * frequency * TIME + phase)
    return Contribution(
        changes={
            "base_acceleration_x": Change(addition=acceleration * sp.cos(azimuth)),
            "base_acceleration_y": Change(addition=acceleration * sp.sin(azimuth)),
        }
    )


BASE_MOTION = Effect(
    id="base_motion",
    title="base that shakes",
    reference="inertial force in an accelerated frame; Landau and Lifshitz (1976), section 39",
    parameters=PARAMETERS,
    contribute=_contribute,
    on_axis=False,
    needs=("off_axis_mass",),
    separating_experiment="Hold the axes and log: a shaking base moves them in time, whatever the"
    " angle; an accelerometer on the base tells at once.",
    instead_on_linear="it acts on a payload that turns",
)
