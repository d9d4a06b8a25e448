"""A pan body whose centre of mass is off the pan axis.

It matters where gravity or an acceleration of the base acts across the pan axis; on a level base at
rest it only adds to the inertia about the axis: `J_pan` is about the centre of mass. The height of
the centre of mass above the tilt axis matters where the base turns. A known mass goes with a free
offset, or the other way round: only their product acts.
"""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

OFFSETS = tuple(
    Parameter(
        f"c_{k}_pan",
        "m",
        0.0,
        -10.0,
        10.0,
        f"{k} of the pan body's centre of mass",
        vanishes=0.0,
        starts=(0.05 if k == "x" else 0.0,),
    )
    for k in "xyz"
)
MASS = Parameter("m_pan_body", "kg", 1.0, 0.0, 1e5, "mass of the pan body")


def _has(place: Place, parameter: Parameter) -> bool:
    """The height matters on a base that turns alone."""
    return place.base_turns or parameter.name != "c_z_pan"


def _contribute(place: Place) -> Contribution:
    changes = {
        f"pan_body_com_{p.name[2]}": Change(addition=p.symbol) for p in OFFSETS if _has(place, p)
    }
    return Contribution(changes={"pan_body_mass": Change(addition=MASS.symbol), **changes})


PAN_COM_OFFSET = Effect(
    id="pan_com_offset",
    title="centre of mass of the pan body off its axis",
    reference="Goldstein, Poole and Safko (2002), section 5.3: theorem of parallel axes",
    parameters=(*OFFSETS, MASS),
    has=_has,
    contribute=_contribute,
    on_axis=False,
    declared_only=True,
    needs=("pan_body_mass",),
    separating_experiment="Lean the base by a known angle and let the pan axis swing: it rests"
    " where the centre of mass is lowest.",
    instead_on_linear="what slides has a mass alone, m_pan",
)
