"""An emitted model at run time: names, units, defaults and compiled functions.

Modules, committed or from a cache folder, are loaded after their checksum was verified.
"""

import hashlib
import importlib
import importlib.util
import math
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError, out_of_bounds, unknown
from ptp_symbolic.numeric.runtime.element_layout import contact_count
from ptp_symbolic.platform import Platform, effect_key, read_platform

FloatArray = NDArray[np.float64]

TRAILER = "# END sha256 "
COMMITTED = {
    "ideal": "thesis-ideal",
    "payload": "thesis-payload",
    "pan_drive": "thesis-pan-drive",
    "tilt_drive": "thesis-tilt-drive",
    "full": "thesis-full",
}
BOUND_SLACK = 1e-9  # relative: a search that ends on a bound may miss it by rounding


@dataclass(frozen=True)
class EffectInstance:
    """An effect of a model: id, axis, its parameters, and texts for documents.

    `members` are its nested versions, the simplest first: title, parameters, and pairs of a
    parameter and the one whose value it takes. `acts_on` are keys of effects that it cannot do
    without; where `first_leads`, what other members add to the first can only be smaller.
    """

    id: str
    axis: str | None
    parameters: tuple[str, ...]
    members: tuple[tuple[str, tuple[str, ...], tuple[tuple[str, str], ...]], ...]
    acts_on: tuple[str, ...]
    title: str
    reference: str
    separating_experiment: str
    first_leads: bool

    @property
    def key(self) -> str:
        """Id and axis in one word, e.g. ``cable_spring@pan``."""
        return effect_key(self.id, self.axis)


@dataclass(frozen=True)
class ModelParameter:
    """A parameter of a model, with the fields of `Parameter` in the effect interface; all numbers
    in `unit` (SI).
    """

    name: str
    unit: str
    default: float
    lower: float
    upper: float
    meaning: str
    vanishes: float | None = None
    starts: tuple[float, ...] = ()
    period: float | None = None
    locked_to: str | None = None


class Derivatives(NamedTuple):
    """Derivatives, in SI: of dx/dt by state fx [n, n], input fu [n, nu] and parameter fp [n, np];
    of the guards by state gx [ng, n] and parameter gp [ng, np].
    """

    fx: FloatArray
    fu: FloatArray
    fp: FloatArray
    gx: FloatArray
    gp: FloatArray


@dataclass(frozen=True)
class Model:
    """The equations of one machine, compiled on first use; `declared` are its name, its title, and
    default, lower and upper bound of every parameter where they are not those of the module.

    `state_derivative(t, x, u, p, dx)` writes dx/dt in place; `rhs(t, x, u, p)` returns it. Arrays
    are float64 in the order of `state_names` [n], `input_names` [nu] and `parameter_names` [np],
    in the SI units of `units`. In models with friction or backlash the modes follow from the
    state: resting friction holds as long as it can. `platform` is the machine that they were
    derived from, None where nobody said it.
    """

    module: ModuleType
    declared: tuple[str, str, Mapping[str, tuple[float, float, float]]] | None = None
    platform: Platform | None = field(default=None, compare=False, repr=False)

    @cached_property
    def evidence_parts(self) -> tuple[str, object]:
        """What everything that is computed by it depends on: its text, and what is declared."""
        return Path(str(self.module.__file__)).read_text("utf-8"), self.declared

    @cached_property
    def name(self) -> str:
        """Name of the model."""
        return str(self.module.NAME) if self.declared is None else self.declared[0]

    @cached_property
    def title(self) -> str:
        """One line that says what the model is."""
        return str(self.module.TITLE) if self.declared is None else self.declared[1]

    @cached_property
    def state_names(self) -> tuple[str, ...]:
        """Names [n] of the states."""
        return tuple(self.module.STATE_NAMES)

    @cached_property
    def input_names(self) -> tuple[str, ...]:
        """Names [nu] of the inputs."""
        return tuple(self.module.INPUT_NAMES)

    @cached_property
    def output_names(self) -> tuple[str, ...]:
        """Names [ny] of the signals that can be measured."""
        return tuple(self.module.OUTPUT_NAMES)

    @cached_property
    def parameters(self) -> tuple[ModelParameter, ...]:
        """The parameters [np] with unit, default, bounds and where they vanish."""
        search = {row[0]: row[1:] for row in self.module.SEARCH}
        own = {} if self.declared is None else self.declared[2]
        rows = (
            (name, unit, *own.get(name, (default, lower, upper)), meaning, *search.get(name, ()))
            for name, unit, default, lower, upper, meaning in self.module.PARAMETERS
        )
        return tuple(ModelParameter(*row) for row in rows)

    @cached_property
    def parameter_names(self) -> tuple[str, ...]:
        """Names [np] of the parameters."""
        return tuple(p.name for p in self.parameters)

    @cached_property
    def defaults(self) -> dict[str, float]:
        """Default of every parameter, SI."""
        return {p.name: p.default for p in self.parameters}

    @cached_property
    def mode_names(self) -> tuple[str, ...]:
        """Names of the modes: directions of friction, sides and activity of contacts."""
        return tuple(self.module.MODE_NAMES)

    @cached_property
    def effects(self) -> tuple[EffectInstance, ...]:
        """The effects in the equations."""
        return tuple(EffectInstance(*row) for row in self.module.EFFECTS)

    @cached_property
    def units(self) -> dict[str, str]:
        """SI unit, by name, of every state, input, output and parameter."""
        m = self.module
        names = (*m.STATE_NAMES, *m.INPUT_NAMES, *m.OUTPUT_NAMES, *self.parameter_names)
        units = (
            *m.STATE_UNITS,
            *m.INPUT_UNITS,
            *m.OUTPUT_UNITS,
            *(p.unit for p in self.parameters),
        )
        return dict(zip(names, units, strict=True))

    def is_linear(self, axis: str) -> bool:
        """Whether the joint of `axis` slides (m, N) and does not turn (rad, N m)."""
        return self.units[f"theta_{axis}"] == "m"

    @cached_property
    def friction_rates(self) -> NDArray[np.int64]:
        """State index [f] of the rate on which every friction acts."""
        return np.array(self.module.FRICTION_RATES, dtype=np.int64)

    @cached_property
    def zero_at_rest(self) -> NDArray[np.int64]:
        """Per state [n] the friction that sets it to zero when it comes to rest, or -1."""
        return np.array(self.module.ZERO_AT_REST, dtype=np.int64)

    @cached_property
    def contacts(self) -> NDArray[np.int64]:
        """Per contact [c, 3]: state index of the rates at the gear output and at the joint; 0 where
        it is sprung, 1 where rigid bodies strike, 2 where the joint sticks in the gap as well.
        Switches of effects follow, as sprung ones.

        A module whose contacts are all sprung does not list them.
        """
        elements = contact_count(len(self.friction_rates), len(self.mode_names))
        sprung = np.zeros((elements, 3), dtype=np.int64)
        return np.asarray(vars(self.module).get("RIGID_CONTACTS", sprung))

    @cached_property
    def input_delays(self) -> NDArray[np.int64]:
        """Per input [nu] the index of the parameter that is its delay in s, or -1."""
        return np.array(self.module.INPUT_DELAYS, dtype=np.int64)

    @cached_property
    def sampler_periods(self) -> tuple[tuple[str, ...], ...]:
        """Per sampler the names of the parameters that its period in s follows from."""
        return tuple(self.module.SAMPLERS)

    @cached_property
    def sampled(self) -> NDArray[np.int64]:
        """Sampler and state index [r, 2] of every state that a sampler sets (zero-order hold)."""
        return np.array(self.module.SAMPLED, dtype=np.int64).reshape(-1, 2)

    @property
    def moving(self) -> int:
        """Number of states with a differential equation; those that samplers set come last."""
        return len(self.state_names) - len(set(self.sampled[:, 1]))

    @cached_property
    def _idle(self) -> dict[str, list[tuple[int, float]]]:
        """Index and vanishing value of the parameters that leave a state without influence."""
        off = {p.name: (k, float(p.vanishes or 0.0)) for k, p in enumerate(self.parameters)}
        return {
            state: [off[name] for name in names]
            for state, names in vars(self.module).get("IDLE_STATES", ())
        }

    def acting(self, p: FloatArray, columns: NDArray[np.int64]) -> int:
        """Number of states, from the first on, that may act on anything at p [np], or on the
        derivatives by the parameters `columns` [nc]: states of effects at their vanishing values
        come last.
        """
        count = len(self.state_names)
        if len(self.sampled) or not self._idle:
            return count
        asked = set(columns.tolist())
        while count and (off := self._idle.get(self.state_names[count - 1])):
            if any(k in asked or p[k] != value for k, value in off):
                break
            count -= 1
        return count

    @cached_property
    def limits(self) -> tuple[tuple[str, str], ...]:
        """State and meaning of every limit of the domain in which the equations hold."""
        return tuple(self.module.DOMAIN)

    def domain(self, p: FloatArray) -> FloatArray:
        """Bounds [k, 2] of the states of `limits` in their units, lower and upper, at p [np]."""
        bounds = np.empty((len(self.limits), 2))
        self.module.domain(p, bounds)
        return bounds

    def refuse_impossible(self, p: FloatArray, given: Collection[str] | None = None) -> None:
        """Raise InputError when parameters p [np] break a relation that the machine needs.

        With the names of those that were `given`, the message calls the others default.
        """
        if not self.module.REQUIREMENTS:
            return
        margin = np.zeros(len(self.module.REQUIREMENTS))
        self.module.margins(p, margin)
        values = dict(zip(self.parameter_names, p, strict=True))
        for (names, rule, strict), by in zip(self.module.REQUIREMENTS, margin, strict=True):
            if not (by > 0.0 if strict else by >= 0.0):
                said = ", ".join(
                    f"{n} = {values[n]:g} {self.units[n]}"
                    f"{'' if given is None or n in given else ' (default)'}"
                    for n in names
                )
                raise InputError(f"Impossible {said}: {rule}.")

    @cached_property
    def state_derivative(self) -> Callable[..., None]:
        """The jitted in-place function f(t, x [n], u [nu], p [np], dx [n]), for loops of your own.

        Nothing is checked: all must be contiguous float64 arrays of the right length, or it reads
        and writes beyond them. `rhs` checks.
        """
        return self.module.state_derivative

    def rhs(self, t: float, x: ArrayLike, u: ArrayLike, p: ArrayLike) -> FloatArray:
        """Return dx/dt [n] at time t in s, state x [n], input u [nu], parameters p [np].

        Raises InputError for arrays of another shape.
        """
        dx = np.empty(len(self.state_names))
        self.state_derivative(
            float(t),
            _vector("State x", x, self.state_names, ""),
            _vector("Input u", u, self.input_names, ""),
            _vector("Parameters p", p, self.parameter_names, "; parameter_vector() makes them"),
            dx,
        )
        return dx

    def parameter_vector(self, values: Mapping[str, float] | None = None) -> FloatArray:
        """Return the parameters [np] in SI: defaults, replaced by `values`.

        Raises InputError for a name that the model does not have and for a value that is not finite
        or outside the bounds of its parameter.
        """
        if not values:
            return self._default_vector.copy()
        for name in values:
            if name not in self.defaults:
                raise unknown("parameter", name, self.parameter_names)
        for p in self.parameters:
            if p.name in values:
                _refuse_out_of_bounds(p, values[p.name])
        return np.array([values.get(n, d) for n, d in self.defaults.items()], dtype=np.float64)

    def derivatives(
        self, t: float, x: FloatArray, u: FloatArray, p: FloatArray, m: FloatArray
    ) -> Derivatives:
        """Derivatives of dx/dt and of the guards at t in s, x [n], u [nu], p [np], modes m [nm]."""
        n, guards = len(x), 3 * len(self.friction_rates) + 4 * len(self.contacts)
        shapes = ((n, n), (n, len(u)), (n, len(p)), (guards, n), (guards, len(p)))
        found = Derivatives(*map(np.zeros, shapes))
        self.module.linearize(t, x, u, p, m, *found)
        return found

    @cached_property
    def _default_vector(self) -> FloatArray:
        return np.array(list(self.defaults.values()), dtype=np.float64)

    def prepared(self, p: FloatArray) -> FloatArray:
        """Return the subexpressions of p [np] alone that `prepared_derivative` takes."""
        c = np.zeros(self.module.PREPARED)
        self.module.prepare(p, c)
        return c


def _refuse_out_of_bounds(p: ModelParameter, value: float) -> None:
    below, above = BOUND_SLACK * abs(p.lower), BOUND_SLACK * abs(p.upper)
    if not p.lower - below <= value <= p.upper + above or not math.isfinite(value):
        raise out_of_bounds(p.name, value, p.unit, p.lower, p.upper)


def _vector(what: str, given: ArrayLike, names: Sequence[str], hint: str) -> FloatArray:
    array = np.asarray(given, dtype=np.float64)
    if array.shape != (len(names),):
        raise InputError(
            f"{what} has shape {array.shape}; give [{len(names)}]: {', '.join(names)}{hint}."
        )
    return np.ascontiguousarray(array)


def generated_folder() -> Path:
    """Folder of the committed modules."""
    return Path(next(iter(importlib.import_module("ptp_symbolic.generated").__path__)))


def model_names() -> tuple[str, ...]:
    """Names of the committed models."""
    return tuple(sorted(p.stem for p in generated_folder().glob("*.py") if p.stem != "__init__"))


def load_model(name: str) -> Model:
    """Load a committed model by name.

    Raises InputError for an unknown name or a module whose text does not fit its checksum.
    """
    if name not in model_names():
        raise unknown("model", name, model_names())
    found = load_module(generated_folder() / f"{name}.py", f"ptp_symbolic.generated.{name}")
    preset = COMMITTED.get(name)
    return found if preset is None else replace(found, platform=_preset(preset))


@lru_cache(maxsize=len(COMMITTED))
def _preset(name: str) -> Platform:
    return read_platform(name)


def load_module(path: Path, import_name: str) -> Model:
    """Load the emitted module at `path` under `import_name` (one name per module).

    Raises InputError when the text of the module does not fit its checksum or cannot be imported.
    """
    from ptp_symbolic.numeric.runtime import compiled  # noqa: F401

    verify(path)
    if import_name in sys.modules:
        return Model(sys.modules[import_name])
    loader = _FromSource(import_name, str(path))
    spec = importlib.util.spec_from_loader(import_name, loader)
    if spec is None:
        raise InputError(f"{path} cannot be imported; regenerate it.")
    module: ModuleType = importlib.util.module_from_spec(spec)
    sys.modules[import_name] = module
    try:
        loader.exec_module(module)
    except BaseException:
        del sys.modules[import_name]
        raise
    return Model(module)


class _FromSource(SourceFileLoader):
    """Runs the text whose checksum was verified: bytecode beside it may be another's."""

    def get_code(self, fullname: str) -> CodeType:
        """The code of the text, compiled anew."""
        path = self.get_filename(fullname)
        return self.source_to_code(self.get_data(path), path)


def verify(path: Path) -> None:
    """Raise InputError unless the last line of `path` is the SHA-256 of everything above it."""
    above, found, digest = path.read_bytes().rpartition(TRAILER.encode())
    if not found or hashlib.sha256(above).hexdigest().encode() != digest.strip():
        raise InputError(
            f"{path.name} does not fit its checksum: it was edited or truncated; run"
            " 'ptp-symbolic regenerate'."
        )
