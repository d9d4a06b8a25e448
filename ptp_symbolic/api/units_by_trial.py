"""Units of a model by trial: it moves the same way when kg, m, s and A are others."""

import numpy as np
import pint

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import Model


def unit_factor(unit: str) -> float:
    """How a number in `unit` changes when kg, m, s, A and K change; m = s^2 keeps gravity."""
    scales = {"[mass]": 3.0, "[length]": 4.0, "[time]": 2.0, "[current]": 7.0}
    scales["[temperature]"] = 5.0
    dimension = pint.get_application_registry()(unit if unit != "1" else "").to_base_units()
    factor = 1.0
    for base, exponent in dimension.dimensionality.items():
        factor *= scales[base] ** exponent
    return factor


def refuse_misfit(model: Model, effect: str, load: str, travel: str = "1") -> None:
    """Raise InputError where the units of `model` do not fit its functions; `load` is the unit of
    what acts on a joint, `travel` that of its coordinate (1 for rad).
    """
    units, rng = model.units, np.random.default_rng(2)
    names = (model.state_names, model.input_names, model.parameter_names)
    x, u = (rng.normal(size=len(n)) for n in names[:2])
    p = model.parameter_vector({q.name: q.default or q.upper * 1e-4 for q in model.parameters})
    m = np.ones(len(model.mode_names))
    scaled = [
        a * np.array([unit_factor(units[n]) for n in group])
        for a, group in zip((x, u, p), names, strict=True)
    ]
    t, later = 0.7, 0.7 * unit_factor("s")
    outputs = [unit_factor(units[name]) for name in model.output_names]
    force, apart = unit_factor(load), unit_factor(travel)
    guards = [force] * 3 * len(model.friction_rates)
    for _ in model.module.CONTACT_ANGLES:
        guards += [apart, apart, force, force]
    guards += [np.nan] * (3 * len(model.friction_rates) + 4 * len(model.contacts) - len(guards))
    rates = [unit_factor(units[n]) / unit_factor("s") for n in names[0]]
    powers = [unit_factor("J"), unit_factor("W"), unit_factor("W")]
    for function, factors, modes in (
        (model.module.mode_derivative, rates, (m,)),
        (model.module.guards, guards, (m,)),
        (model.module.energy, powers, (m,)),
        (model.module.outputs, outputs, ()),
    ):
        here, other = np.zeros((2, len(factors)))
        function(t, x, u, p, *modes, here)
        function(later, *scaled, *modes, other)
        known = np.isfinite(factors)
        wanted = (here * factors)[known]
        fits = np.isclose(other[known], wanted, rtol=1e-9, atol=1e-12)
        if not fits.all():
            raise InputError(
                f"Effect '{effect}': units do not fit {function.__name__}, entries"
                f" {np.flatnonzero(~fits).tolist()} of those known; correct a unit or the law."
            )
