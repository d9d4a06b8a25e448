"""A platform made into a model: derived, emitted, loaded."""

from dataclasses import replace

from ptp_symbolic.models.module_cache import emitted
from ptp_symbolic.numeric.runtime.model import Model, load_module
from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import parameters_of, place_effects
from ptp_symbolic.symbolic.targets.numba.module import module_text


def emit(platform: Platform) -> Model:
    """Derive, emit and load the model of `platform`; modules are kept by their mathematics.

    Machines that differ in their numbers alone share a module, which is compiled once. What nobody
    declares has the catalogue's value here: `ptp_symbolic.load` refuses that, a set of candidates
    needs it. Raises InputError when no machine with its parameters can exist.
    """
    equations = possible_equations(platform)
    path = emitted(equations, parameters_of(place_effects(platform)))
    own = {p.name: (p.default, p.lower, p.upper) for p in equations.parameters}
    declared = (platform.name, platform.title, own)
    return replace(load_module(path, path.stem), declared=declared, platform=platform)


def module_of(platform: Platform) -> str:
    """Text of the module of `platform`, with its own title and parameters.

    Raises InputError when no machine with its parameters can exist.
    """
    return module_text(possible_equations(platform))


def possible_equations(platform: Platform) -> Equations:
    """The equations of `platform`; raises InputError where no machine has its parameters."""
    equations = assemble(platform)
    refuse_impossible(equations, platform)
    return equations
