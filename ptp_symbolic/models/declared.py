"""What a platform declares of a model: free parameters, known values, signals."""

from collections.abc import Collection
from dataclasses import replace

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform, naming_file
from ptp_symbolic.platform.units import compatible
from ptp_symbolic.symbolic.derivation.contributions import sensors_on
from ptp_symbolic.symbolic.derivation.placement import place_effects


def free_parameters(platform: Platform, model: Model) -> tuple[FreeParameter, ...]:
    """The parameters that `platform` leaves to be fitted, as far as `model` has them."""
    own = {p.name: p for p in model.parameters}
    ties: dict[str, list[str]] = {}
    for declaration in platform.parameters:
        if declaration.same_as is not None and declaration.name in own:
            ties.setdefault(declaration.same_as, []).append(declaration.name)
    return tuple(
        replace(
            free_parameter(
                d.name,
                d.value,
                own[d.name].lower if d.lower is None else d.lower,
                own[d.name].upper if d.upper is None else d.upper,
                own[d.name].period,
                tuple(ties.get(d.name, ())),
            ),
            declared_start=d.value,
        )
        for d in platform.parameters
        if d.free and d.name in own
    )


def known_values(platform: Platform, model: Model) -> dict[str, tuple[float, float | None]]:
    """Values of the parameters that `platform` declares as known and `model` has, each with the
    most by which it may be off, where the platform says so.
    """
    own = set(model.parameter_names)
    return {
        d.name: (d.value, d.uncertainty)
        for d in platform.parameters
        if not d.free and d.same_as is None and d.name in own
    }


def _refuse_other_role(role: str, name: str, model: Model, outputs: Collection[str]) -> None:
    """Raise InputError for an input that is declared as an output, or the other way round."""
    other = "output" if role == "input" else "input"
    if name in (outputs if role == "input" else model.input_names):
        raise InputError(
            f"Signal '{name}' is an {other} of this platform, but declared as an {role}; write"
            f' role = "{other}".'
        )


def refuse_unknown_signals(platform: Platform, model: Model) -> None:
    """Raise InputError for a signal of `platform` that `model` does not have, or in another unit.

    An input more than the model takes is let be, unless one that it takes is missing.
    """
    inputs, outputs = (
        [s.signal for s in platform.signals if s.role == r] for r in ("input", "output")
    )
    complete = set(model.input_names) <= set(inputs)
    placed = place_effects(platform)
    contributions = [e.contribution_at(place) for e, place in placed]
    sensors = sensors_on(platform.axes, contributions, platform.linear_axes)
    choices = dict.fromkeys((*model.output_names, *(s.name for s in sensors)))
    with naming_file(platform):
        for role, given, known in (
            ("input", () if complete else inputs, model.input_names),
            ("output", outputs, tuple(choices)),
        ):
            for name in given:
                if name not in known:
                    _refuse_other_role(role, name, model, choices)
                    raise unknown(f"{role} signal", name, known)
        for signal in platform.signals:
            unit = model.units.get(signal.signal, signal.unit)
            if not compatible(signal.unit, unit):
                raise InputError(
                    f"Signal '{signal.signal}' is declared in '{signal.unit}', but it has the unit"
                    f" '{unit}'; correct its unit."
                )
