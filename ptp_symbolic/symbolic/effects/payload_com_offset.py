"""A centre of mass of the payload that lies elsewhere than declared."""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

SHIFTS = tuple(
    Parameter(
        f"dc_{k}_payload",
        "m",
        0.0,
        -1.0,
        1.0,
        f"shift of the centre of mass along {k}",
        vanishes=0.0,
        starts=(0.0,),
    )
    for k in "xyz"
)


def _has(place: Place, parameter: Parameter) -> bool:
    along_axis = {"pan": "dc_z_payload", "tilt": "dc_y_payload"}.get("".join(place.axes))
    return place.base_turns or parameter.name != along_axis


def _contribute(place: Place) -> Contribution:
    return Contribution(
        changes={
            f"payload_com_{p.name[3]}": Change(addition=p.symbol) for p in SHIFTS if _has(place, p)
        }
    )


PAYLOAD_COM_OFFSET = Effect(
    id="payload_com_offset",
    title="payload centre of mass off its declared place",
    reference="thesis section 3.2.2 (mass imbalance)",
    parameters=SHIFTS,
    has=_has,
    contribute=_contribute,
    on_axis=False,
    needs=("payload_com_x",),
    separating_experiment="Hold each axis at several angles and read the holding torque; repeat"
    " with the payload turned by 180 deg about the boresight.",
    instead_on_linear="what slides has a mass alone, m_pan",
)
