"""Free play between gear output and load, of four kinds.

The usual one is a dead zone in the twist of a flexible shaft. The others join gear output and load
rigidly, without a shaft between: a massless shaft has no speed of its own that could reverse, so
restitution is a matter of rigid faces. Assumed: faces strike in no time, and dry friction, which
is finite, does not take part in a strike.
"""

from dataclasses import replace

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, Play
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO

LINEAR = {"default": 1e-4, "starts": (2e-5, 1e-4)}
STARTS = (0.005, 0.02, 0.05)  # rad
FACES = "whole gap between the two faces"
GAP = Parameter("gap_{axis}", "rad", 0.026005, 0.0, 1.0, FACES, 0.0, STARTS, linear=LINEAR)
OPEN_LINEAR = {**LINEAR, "lower": 1e-7}
OPEN_GAP = replace(GAP, lower=1e-6, vanishes=None, linear=OPEN_LINEAR)
RESTITUTION = Parameter(
    "e_gap_{axis}", "1", 0.5, 0.0, 1.0, "restitution: speed apart after a strike, per speed before"
)
MOTOR = "rotor_inertia"  # where a torque drives the axis
LEANING = ("constant_torque", "cable_spring")  # a small one decides on which face a gear lies
EXPERIMENT = (
    "Reverse slowly with and without a known preload torque on the joint: backlash disappears under"
    " preload, presliding does not."
)


def _contribute(place: Place) -> Contribution:
    half = place.parameter("gap_{axis}") / 2
    return Contribution(changes={f"half_gap_{place.axis}": Change(addition=half)})


def _kind(
    kind: str, title: str, reference: str, bounces: bool = False, holds: bool = False
) -> Effect:
    given = (OPEN_GAP, RESTITUTION) if bounces else (OPEN_GAP,)

    def contribute(place: Place) -> Contribution:
        half = place.parameter("gap_{axis}") / 2
        restitution = place.parameter(RESTITUTION.name) if bounces else ZERO
        return Contribution(plays=(Play(place.own_axis, half, restitution, holds),))

    return Effect(
        id="backlash",
        kind=kind,
        title=title,
        reference=reference,
        parameters=given,
        contribute=contribute,
        structural=True,
        splits_axis=True,
        structure=Structure(along_with=(MOTOR,), beside=LEANING) if bounces else None,
        separating_experiment=EXPERIMENT,
    )


BACKLASH = Effect(
    id="backlash",
    kind="dead_zone",
    title="backlash",
    reference="thesis Eq. 2.16 (dead zone), Table 5.7; contact that cannot pull",
    parameters=(GAP,),
    contribute=_contribute,
    needs=("half_gap_{axis}",),
    structure=Structure(along_with=("shaft_compliance", MOTOR), beside=LEANING),
    separating_experiment=EXPERIMENT,
    kinds=(
        _kind("elastic_impact", "backlash with elastic impact", "Newton's restitution", True),
        _kind(
            "hysteresis_friction", "backlash, load held by friction", "thesis Eq. 2.17", holds=True
        ),
        _kind("hysteresis_inertia", "backlash, load coasting", "thesis Eq. 2.18, erratum 29"),
    ),
)
