"""A machine as an object: its equations as numbers and as formulas, simulated and linearised."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.api.display import Displayed, Table
from ptp_symbolic.api.linearization import Linearization
from ptp_symbolic.api.values import Values, input_vector, parameter_vector, state_vector
from ptp_symbolic.errors import InputError, unknown, wrong_type
from ptp_symbolic.numeric.runtime.model import Model, load_model, load_module, model_names
from ptp_symbolic.platform import Platform, effect_key

if TYPE_CHECKING:
    from ptp_symbolic.api.run import Run
    from ptp_symbolic.symbolic.derivation.equations import Equations

FloatArray = NDArray[np.float64]
Source = Model | Platform | str | Path

INPUT_STEP = 2.0**-10  # SI: central difference by an input, exact where outputs are quadratic in it


class Jacobian(NamedTuple):
    """Derivatives of dx/dt by state `x` [n, n], input `u` [n, nu] and parameter `p` [n, np], SI."""

    x: FloatArray
    u: FloatArray
    p: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class Machine(Displayed, Model):
    """The equations of motion of one machine: names, units, functions, simulation.

    States x [n], inputs u [nu] and parameters p [np] are in the order of `state_names`,
    `input_names` and `parameter_names`, in the SI units of `units`. Wherever one of them is asked
    for, a mapping by name does, with numbers in SI or texts such as "30 deg"; what it leaves out
    keeps its initial value, zero or its default. Machines pickle and copy: by their platform, and
    with the hash of their equations.

    >>> import ptp_symbolic as ptp
    >>> machine = ptp.load("ideal")
    >>> machine.state_names
    ('theta_pan', 'theta_tilt', 'omega_pan', 'omega_tilt')
    >>> machine.rhs({"omega_pan": 2.0}, u={"tau_pan": 0.2}, p={"b_pan": "0.1 N m s/rad"})[0]
    np.float64(2.0)
    """

    @overload
    def rhs(
        self,
        x: Values,
        u: Values | None = None,
        p: Values | None = None,
        *,
        t: float = 0.0,
    ) -> FloatArray: ...

    @overload
    def rhs(self, t: float, x: ArrayLike, u: ArrayLike, p: ArrayLike) -> FloatArray: ...

    def rhs(self, *point: Any, **named: Any) -> FloatArray:
        """Return dx/dt [n] at state x [n], input u [nu] (zero) and parameters p [np] (defaults).

        `rhs(t, x, u, p)`, with arrays in the order of the names, is the same at the time t in s;
        it matters on a base that moves. Friction and contact are in the modes that the state says.
        Raises InputError for unknown names, other shapes and units that do not fit.

        >>> import ptp_symbolic as ptp
        >>> machine = ptp.load("ideal")
        >>> machine.rhs([0.0, 0.0, 1.0, 0.0]) @ [1.0, 0.0, 0.0, 0.0]
        np.float64(1.0)
        """
        names = ("t", "x", "u", "p") if len(point) == 4 else ("x", "u", "p")
        if len(point) > 4:
            raise TypeError(f"rhs takes x, u, p or t, x, u, p, not {len(point)} arguments")
        given = dict(zip(names, point, strict=False))
        for name in named:
            if name in given or name not in ("t", "x", "u", "p"):
                raise TypeError(f"rhs got an unexpected argument '{name}'")
        given |= named
        if "x" not in given:
            raise TypeError("rhs needs the state x")
        if len(point) == 4:
            return super().rhs(*point)
        x, u, p = self._point(given["x"], given.get("u"), given.get("p"))
        return super().rhs(float(given.get("t", 0.0)), x, u, p)

    def jacobian(
        self, x: Values, u: Values | None = None, p: Values | None = None, *, t: float = 0.0
    ) -> Jacobian:
        """Derivatives of dx/dt at x [n], u [nu] (zero), p [np] (defaults): exact, by
        `.x` [n, n], `.u` [n, nu] and `.p` [n, np], in the modes that the state says.

        Raises InputError as `rhs` does.

        >>> import ptp_symbolic as ptp
        >>> ptp.load("ideal").jacobian([0.0, 0.0, 0.0, 0.0]).x.shape
        (4, 4)
        """
        vectors = self._point(x, u, p)
        return self._jacobian(t, *vectors, self._modes(t, *vectors))

    def mass_matrix(self, x: Values, p: Values | None = None) -> FloatArray:
        """The mass matrix M [j, j] at x [n] and p [np] (defaults): M a = torques, with a row for
        every rate of `mass_matrix_rates`, in kg m^2 (kg of a linear joint).

        Raises InputError as `rhs` does.

        >>> import ptp_symbolic as ptp
        >>> ptp.load("ideal").mass_matrix([0.0, 0.0, 0.0, 0.0], {"J_y_tilt": "2 g m^2"})[1, 1]
        np.float64(0.002)
        """
        vectors, rows = self._point(x, None, p), len(self.mass_matrix_rates)
        matrix = np.zeros((rows, rows))
        self.module.mass_matrix(0.0, *vectors, self._modes(0.0, *vectors), matrix)
        return matrix

    def gravity_torque(self, x: Values, p: Values | None = None, *, t: float = 0.0) -> FloatArray:
        """The torques g [j] in N m (N) that hold the machine at x [n] against its weight, with
        parameters p [np] (defaults): M a + c + g = torques, in the rows of `mass_matrix_rates`.

        The time t in s matters on a base that moves. Raises InputError as `rhs` does.

        >>> import ptp_symbolic as ptp
        >>> ptp.load("payload").gravity_torque([0.0, 0.0, 0.0, 0.0], {"c_x_payload": "-10 cm"})
        array([0.      , 4.897152])
        """
        vectors = self._point(x, None, p)
        torques = np.zeros(len(self.mass_matrix_rates))
        self.module.gravity_torque(t, *vectors, self._modes(t, *vectors), torques)
        return torques

    @cached_property
    def mass_matrix_rates(self) -> tuple[str, ...]:
        """The rates [j] to which the rows of the mass matrix belong."""
        return tuple(name for name in self.state_names if name.startswith("omega_"))

    def inverse_dynamics(
        self,
        q: ArrayLike,
        w: ArrayLike,
        a: ArrayLike,
        p: Values | None = None,
        t: ArrayLike | None = None,
    ) -> FloatArray:
        """The torques on the joints, N m (N), that make them follow angles q in rad (m), rates w
        and accelerations a: of one instant [joints], or of many [k, joints] at times t [k] in s.

        Motors and shafts are left out; see `ptp_symbolic.inverse_dynamics`. Raises InputError for
        other shapes and unknown parameters.

        >>> import ptp_symbolic as ptp
        >>> ptp.load("ideal").inverse_dynamics([0, 0], [0, 0], [0, 0])
        array([0., 0.])
        """
        from ptp_symbolic.api.values import parameter_values
        from ptp_symbolic.models.inverse_dynamics import Motion, inverse_dynamics, numbers_of

        given = {"angles": q, "rates": w, "accelerations": a}
        rows = [np.atleast_2d(numbers_of(row, name)) for name, row in given.items()]
        times = None if t is None else np.atleast_1d(numbers_of(t, "times"))
        found = inverse_dynamics(
            self, Motion(rows[0], rows[1], rows[2], times), parameter_values(self, p)
        )
        return found if np.ndim(q) == 2 else found[0]

    @cached_property
    def equations(self) -> Equations:
        """The equations as SymPy expressions: `mass_matrix`, `forcing`, `rates`, `extra_states`,
        `frictions`, `contacts`, `outputs` and more; derived when they are first asked for.

        >>> import ptp_symbolic as ptp
        >>> ptp.load("ideal").equations.mass_matrix[1, 1]
        J_y_tilt
        """
        from ptp_symbolic.symbolic.derivation.assembly import assemble

        return assemble(self._known_platform())

    def linearize(
        self,
        x: Values | None = None,
        u: Values | None = None,
        p: Values | None = None,
        *,
        t: float = 0.0,
        modes: Mapping[str, float] | None = None,
    ) -> Linearization:
        """A, B, C, D with names about x [n] (at rest), u [nu] (zero), p [np] (defaults).

        `modes` replace those that follow from the state: a joint that dry friction holds does not
        move, so that its rows of A and B are zero; {"slide_pan": 1} linearises it as it slides.
        Derivatives are exact, D is a difference quotient of outputs that are linear in the inputs.
        Raises InputError as `rhs` does, and for a mode that the machine has not.

        >>> import ptp_symbolic as ptp
        >>> ptp.load("ideal").linearize().B.shape
        (4, 2)
        """
        vectors = self._point({} if x is None else x, u, p)
        found = self._modes(t, *vectors)
        for name, mode in (modes or {}).items():
            if name not in self.mode_names:
                raise unknown("mode", name, self.mode_names)
            found[self.mode_names.index(name)] = mode
        rate = np.zeros(len(self.state_names))
        self.module.mode_derivative(t, *vectors, found, rate)
        jacobian = self._jacobian(t, *vectors, found)
        by_x, by_u = self._output_jacobian(t, *vectors)
        names = (self.state_names, self.input_names, self.output_names)
        named = dict(zip(self.mode_names, map(float, found), strict=True))
        matrices = (jacobian.x, jacobian.u, by_x, by_u)
        return Linearization(self.name, *names, *matrices, *vectors[:2], rate, named)

    def simulate(self, times: Any = None, **given: Any) -> Run:
        """Simulate from 0 to a duration in s, over a span (start, end) in s, or at `times` [k].

        Inputs and parameters are given by their names, `x0` is the state at the start; all that
        `ptp_symbolic.simulate` takes may follow, a `controller` among it. Raises InputError for
        unknown names, units that do not fit and values out of bounds, and SimulationError where the
        motion cannot go on.

        >>> import ptp_symbolic as ptp
        >>> machine = ptp.load("ideal")
        >>> run = machine.simulate(0.2, tau_pan="50 mN m", x0={"theta_tilt": "30 deg"}, b_pan=0.2)
        >>> round(float(run["theta_tilt"][0]), 6)
        0.523599
        """
        from ptp_symbolic.api.simulation import simulate

        return simulate(self, times, **given)

    def _point(
        self, x: Values, u: Values | None, p: Values | None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        return state_vector(self, x), input_vector(self, u), parameter_vector(self, p)

    def _modes(self, t: float, x: FloatArray, u: FloatArray, p: FloatArray) -> FloatArray:
        modes = np.zeros(len(self.mode_names))
        self.module.initial_modes(t, x, u, p, modes)
        return modes

    def _jacobian(
        self, t: float, x: FloatArray, u: FloatArray, p: FloatArray, modes: FloatArray
    ) -> Jacobian:
        return Jacobian(*self.derivatives(t, x, u, p, modes)[:3])

    def _output_jacobian(
        self, t: float, x: FloatArray, u: FloatArray, p: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        count = len(self.output_names)
        by_x, by_p = np.zeros((count, len(x))), np.zeros((count, len(p)))
        self.module.output_jacobian(t, x, u, p, by_x, by_p)
        by_u, ends = np.zeros((count, len(u))), np.zeros((2, count))
        for k in range(len(u)):
            for end, sign in zip(ends, (1.0, -1.0), strict=True):
                self.module.outputs(t, x, u + sign * INPUT_STEP * np.eye(len(u))[k], p, end)
            by_u[:, k] = (ends[0] - ends[1]) / (2.0 * INPUT_STEP)
        return by_x, by_u

    def _known_platform(self) -> Platform:
        if self.platform is None:
            raise InputError(f"Model '{self.name}' does not know its platform.")
        return self.platform

    def _heading(self) -> str:
        return f"{self.name}: {self.title}"

    def _tables(self) -> tuple[Table, ...]:
        unit, initial = self.units, self.module.STATE_INITIAL
        states = tuple((n, unit[n], v) for n, v in zip(self.state_names, initial, strict=True))
        parameters = tuple(
            (p.name, p.default, p.unit, f"{p.lower:g} to {p.upper:g}", p.meaning)
            for p in self.parameters
        )
        return (
            Table("State", ("state", "unit", "initial"), states),
            Table("Input", ("input", "unit"), tuple((n, unit[n]) for n in self.input_names)),
            Table("Output", ("output", "unit"), tuple((n, unit[n]) for n in self.output_names)),
            Table("Parameter", ("parameter", "default", "unit", "bounds", "meaning"), parameters),
            Table(
                "Effect",
                ("effect", "what it is"),
                tuple((effect_key(e.id, e.axis), e.title) for e in self.effects),
            ),
        )

    def __hash__(self) -> int:
        return hash((self.module.MODEL_HASH, self.name))

    def __reduce__(self) -> tuple[Callable[..., Machine], tuple[Any, ...]]:
        where = (self.module.__file__, self.module.__name__, self.module.MODEL_HASH)
        return _restored, (*where, self.declared, self.platform)


def machine_of(model: Model) -> Machine:
    """`model` as a machine."""
    if isinstance(model, Machine):
        return model
    return Machine(model.module, model.declared, model.platform)


def load(source: Source, *, catalogue_values: bool = False) -> Machine:
    """Load a machine: a committed model or a packaged preset by its name, the path of a platform
    TOML, a `Platform`, or a model.

    Raises InputError when there is no such model, the platform cannot be used, or leaves out a
    parameter without a natural default, such as an inertia. With `catalogue_values` a `Platform`
    has for these the values of the catalogue, which are those of the thesis' machine.

    >>> import ptp_symbolic as ptp
    >>> ptp.load("payload").title
    'Pan-tilt platform of the thesis with its payload'
    """
    if isinstance(source, Model):
        return machine_of(source)
    _refuse_no_machine(source)
    if not isinstance(source, Platform) and str(source) in model_names():
        return machine_of(load_model(str(source)))
    if not (isinstance(source, Platform) and catalogue_values):
        source = platform_of(source)
    from ptp_symbolic.models.emission import emit

    machine = machine_of(emit(source))
    if machine.platform is not None:
        from ptp_symbolic.models.declared import refuse_unknown_signals

        refuse_unknown_signals(machine.platform, machine)
    return machine


def platform_of(source: Source) -> Platform:
    """The platform of what `load` takes, without deriving anything. Raises InputError as it does,
    and for a model that does not know its platform.
    """
    if isinstance(source, Platform):
        from ptp_symbolic.symbolic.derivation.placement import refuse_undeclared

        refuse_undeclared(source)
        return source
    if isinstance(source, Model):
        return machine_of(source)._known_platform()
    _refuse_no_machine(source)
    if str(source) in model_names():
        return machine_of(load_model(str(source)))._known_platform()
    from ptp_symbolic.models.committed import declared_platform

    return declared_platform(source)


def _refuse_no_machine(source: object) -> None:
    if not isinstance(source, str | Path | Platform):
        raise wrong_type(
            "A machine",
            source,
            "the name of a model or a preset, the path of a platform file, a Platform or a Machine"
            " (it comes first, logs follow)",
        )


def _restored(
    file: str,
    import_name: str,
    digest: str,
    declared: tuple[str, str, Mapping[str, tuple[float, float, float]]] | None,
    platform: Platform | None,
) -> Machine:
    """The machine that was pickled: its module, or the same one derived again from its platform.

    Raises InputError where this program derives other equations.
    """
    if Path(file).is_file():
        found = Machine(load_module(Path(file), import_name).module, declared, platform)
        if digest == found.module.MODEL_HASH:
            return found
    if platform is not None:
        from ptp_symbolic.models.emission import emit

        again = emit(platform)
        if digest == again.module.MODEL_HASH:
            return Machine(again.module, declared, platform)
    name = import_name if platform is None else platform.name
    raise InputError(
        f"The pickled model '{name}' has the equations {digest}, and this version of the program"
        " derives others; load its platform anew."
    )
