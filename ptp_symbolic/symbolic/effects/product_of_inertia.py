"""Products of inertia of the tilt body: principal axes that are not the joint axes."""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = tuple(
    Parameter(
        f"J_{pair}_tilt",
        "kg m^2",
        0.0,
        -1e4,
        1e4,
        f"element {pair} of the tilt body's inertia tensor (minus the integral of {pair} dm)",
        vanishes=0.0,
        starts=(0.0,),
    )
    for pair in ("xy", "xz", "yz")
)


def _contribute(place: Place) -> Contribution:
    return Contribution(
        changes={
            f"tilt_product_{p.name[2:4]}": Change(addition=place.parameter(p.name))
            for p in PARAMETERS
        }
    )


PRODUCT_OF_INERTIA = Effect(
    id="product_of_inertia",
    title="products of inertia of the tilt body",
    reference="thesis Table 2.2 with erratum 27: M_pt = -J_xy sin + J_yz cos",
    parameters=PARAMETERS,
    contribute=_contribute,
    on_axis=False,
    needs=("tilt_product_xy",),
    separating_experiment="Accelerate one axis at several angles with the other held by its drive"
    " and read the torque that holds it.",
    instead_on_linear="what slides has a mass alone, m_pan",
)
