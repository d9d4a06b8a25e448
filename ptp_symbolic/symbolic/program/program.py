"""The program of a machine: all kernels that compute it, and what a target has to know of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.program import dynamics
from ptp_symbolic.symbolic.program.kernel import Kernel, Part, Vectors
from ptp_symbolic.symbolic.program.motion import (
    Motion,
    impact_kernels,
    linearize_kernel,
    motion,
)
from ptp_symbolic.symbolic.program.signals import (
    domain_kernel,
    energies,
    margins_kernel,
    output_jacobian_kernel,
    outputs_kernel,
    sampler_kernels,
)
from ptp_symbolic.symbolic.simplify.base_parameters import base_form


@dataclass(frozen=True)
class Operations:
    """Operations of the state derivative: as derived, as written with shared terms, and at each
    call where the others are done once per parameter set.
    """

    derived: int
    written: int
    each: int


@dataclass(frozen=True)
class Layout:
    """Where frictions and contacts act. `friction_rates`: state index of the rate of every
    friction; `zero_at_rest`: per state the friction that resets it when it comes to rest, or -1;
    `contact_angles`: per contact the state index of both angles, gear output and joint;
    `rigid_contacts`: per contact and switch that of both rates, and 0 where it is sprung, 1 rigid,
    2 rigid and held in the gap (empty where none is rigid).
    """

    friction_rates: tuple[int, ...]
    zero_at_rest: tuple[int, ...]
    contact_angles: tuple[tuple[int, int], ...]
    rigid_contacts: tuple[tuple[int, int, int], ...]


@dataclass(frozen=True, eq=False)
class Program:
    """What a target writes: `equations` with their names, units and bounds, in `computed` as the
    kernels compute them; the kernels, in the order in which they are written, and the parts that
    they have in common.
    """

    equations: Equations
    computed: Equations
    vectors: Vectors
    kernels: tuple[Kernel, ...]
    parts: tuple[Part, ...]
    operations: Operations
    layout: Layout

    def kernel(self, name: str) -> Kernel | None:
        """The kernel of a name; None where the machine has none."""
        return next((k for k in self.kernels if k.name == name), None)

    @property
    def has_modes(self) -> bool:
        """Whether friction, contacts or switches divide the motion into modes."""
        return bool(self.vectors.m)

    @property
    def has_rigid_contacts(self) -> bool:
        """Whether rigid bodies strike each other."""
        return any(contact.rigid for contact in self.equations.contacts)


def program(equations: Equations) -> Program:
    """The program that computes `equations`; it depends on the mathematics alone."""
    computed = _in_base_parameters(equations)
    solve = dynamics.solve_accelerations(computed)
    guards = dynamics.guard_expressions(computed, solve)
    vectors = Vectors(
        tuple(map(str, equations.state_symbols)),
        tuple(i.name for i in equations.inputs),
        tuple(p.name for p in equations.parameters),
        tuple(map(str, equations.mode_symbols)),
        (),
        _rows(equations, len(guards)),
    )
    own = motion(computed, solve, guards, energies(equations, solve), vectors)
    vectors = own.prepared.vectors
    kernels = (
        *own.kernels,
        linearize_kernel(computed, solve, guards, vectors),
        *impact_kernels(computed, solve, vectors),
        outputs_kernel(computed, solve, vectors),
        output_jacobian_kernel(equations, computed, solve, vectors),
        domain_kernel(equations, vectors),
        margins_kernel(equations, vectors),
        *sampler_kernels(equations, vectors),
    )
    operations = _operations(equations, own)
    parts = (own.prepared, own.forces)
    return Program(equations, computed, vectors, kernels, parts, operations, layout(equations))


def layout(equations: Equations) -> Layout:
    """Where frictions and contacts of `equations` act."""
    states = list(equations.state_symbols)
    axes = [friction.axis for friction in equations.frictions]
    reset = {
        state.name: axes.index(state.zero_at_rest_of)
        for state in equations.extra_states
        if state.zero_at_rest_of in axes
    }
    rigid: list[tuple[int, int, int]] = []
    if any(contact.rigid for contact in equations.contacts):
        for contact in equations.contacts:
            gear, joint = kinematics.gear_rate(contact.axis), kinematics.rate(contact.axis)
            rule = 2 if contact.holds else int(contact.rigid)
            rigid.append((states.index(gear), states.index(joint), rule))
        rigid += [(0, 0, 0)] * len(equations.switches)
    return Layout(
        tuple(states.index(friction.rate) for friction in equations.frictions),
        tuple(reset.get(str(symbol), -1) for symbol in states),
        tuple(
            (states.index(kinematics.gear_angle(c.axis)), states.index(kinematics.angle(c.axis)))
            for c in equations.contacts
        ),
        tuple(rigid),
    )


def _rows(equations: Equations, guards: int) -> dict[str, tuple[str, str]]:
    """Shape of the arrays that kernels write, and their units."""
    states, contacts = len(equations.state_symbols), len(equations.contacts)
    rates = "STATE_UNITS per s"
    rows, further = len(equations.rates), len(equations.extra_states)
    samples = 3 * len(equations.samplers) + len(equations.updates)
    return {
        "dx": (f"{states}", rates),
        "f": (f"{states}", rates),
        "g": (f"{guards}", equations.unit("N m and rad")),
        "strike": (f"{contacts * (states + 2)}", "STATE_UNITS, 1 and J"),
        "y": (f"{len(equations.outputs)}", "OUTPUT_UNITS"),
        "e": ("3", "J, W and W"),
        "r": (f"{rows + further}", f"{equations.unit('N m')}, then {rates}"),
        "M": (f"{rows}, {rows}", equations.unit("kg m^2")),
        "G": (f"{rows}", equations.unit("N m")),
        "z": (f"{samples}", "s, s and 1 per sampler, then STATE_UNITS"),
        "bounds": (f"{len(equations.limits)}, 2", "STATE_UNITS: lower, upper"),
        "margin": (f"{len(equations.requirements)}", "units of what is compared"),
    }


def _operations(equations: Equations, own: Motion) -> Operations:
    derived = [e for _, e in dynamics.solve_accelerations(equations).definitions]
    derived += [state.derivative for state in equations.extra_states]
    lines = {kernel.name: kernel.lines for kernel in own.kernels}
    return Operations(
        *(
            sum(int(sp.count_ops(e)) for e in es)
            for es in (
                derived,
                (e for _, e in lines["mode_derivative"]),
                (e for _, e in lines["prepared_derivative"]),
            )
        )
    )


def _in_base_parameters(equations: Equations) -> Equations:
    """The same equations written in base parameters, which need the fewest operations; these and
    what they are multiplied by are named functions.
    """
    varying = equations.varying_inertia
    constant = equations.mass_matrix - varying
    form = base_form(equations.rigid_at_rest, constant, equations.forcing)
    mass = sp.ImmutableMatrix(form.mass_matrix + varying)
    raw, written = (
        [*matrix, *forcing]
        for matrix, forcing in ((equations.mass_matrix, equations.forcing), (mass, form.forcing))
    )
    terms = [(s, e) for s, e in (*form.base_parameters, *form.shared_terms) if s != e]
    terms += [(s, _in_base_form(e, raw, written)) for s, e in equations.terms]
    return replace(equations, mass_matrix=mass, forcing=form.forcing, terms=tuple(terms))


def _in_base_form(
    expression: sp.Expr, raw: Sequence[sp.Expr], written: Sequence[sp.Expr]
) -> sp.Expr:
    """The expression with a `raw` entry in it as it is `written` instead, where that is shorter."""
    for entry, form in zip(raw, written, strict=True):
        other = expression - entry + form
        if sp.count_ops(other) < sp.count_ops(expression):
            return other
    return expression
