"""Kernels as functions that return what they compute, for languages of arrays."""

import math
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.program.kernel import Entry, Kernel
from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.printing import Language

# What is exported, by the field's name, and the kernel that computes it.
KERNELS = {
    "vector_field": "mode_derivative",
    "outputs": "outputs",
    "inverse_dynamics": "equation_error",
    "mass_matrix": "mass_matrix",
    "gravity_torque": "gravity_torque",
    "energy": "energy",
    "guards": "guards",
    "impacts": "impacts",
    "sample": "sample",
}
MEANINGS = {
    "vector_field": "Time derivative of the state x in the modes m.",
    "outputs": "Measured signals.",
    "inverse_dynamics": "Torques on the joints that the motion takes beyond the inputs u; x ends"
    " in the accelerations of the joints. Then the rates of the other states.",
    "mass_matrix": "Mass matrix M of the joints, then of the gear outputs.",
    "gravity_torque": "Torques g that hold the machine against its weight: M a + c + g = torques.",
    "energy": "Stored energy in J, power supplied and power dissipated in W.",
    "guards": "Per friction holding, forward and backward breakaway torque; per contact separation,"
    " half gap, torque at the upper and at the lower face.",
    "impacts": "Per contact: change of the state where faces stay together, restitution, energy.",
    "sample": "Period, offset and phase of every sampler, then the states that they set.",
}


@dataclass(frozen=True)
class Function:
    """A function of arrays `arguments` (and the time t): unpacked names, named terms, and the
    entries of the vector or, row by row, of the matrix of this `shape` that it returns, as texts of
    a language.
    """

    name: str
    meaning: str
    arguments: tuple[str, ...]
    sizes: tuple[int, ...]
    unpacked: tuple[tuple[str, str, int], ...]
    terms: tuple[tuple[str, str], ...]
    entries: tuple[str, ...]
    shape: tuple[int, ...]


def functions(program: Program, language: Language) -> list[Function]:
    """All functions that a program has, written in `language`."""
    found = []
    for name, own in KERNELS.items():
        kernel = program.kernel(own)
        if kernel is not None and math.prod(_shape(kernel)) > 0:
            found.append(_function(name, kernel, language))
    return found


def _shape(kernel: Kernel) -> tuple[int, ...]:
    (written,) = kernel.written
    return kernel.vectors.shape(written)


def _function(name: str, kernel: Kernel, language: Language) -> Function:
    """A kernel that writes one vector or matrix, as a function that returns it."""
    shape = _shape(kernel)
    entries = [language.expression(sp.Integer(0))] * math.prod(shape)
    terms = []
    for target, expression in kernel.body:
        text = language.expression(expression)
        if isinstance(target, Entry):
            entries[target.place(shape)] = text
        else:
            terms.append((language.identifier(target), text))
    read = [a for a in kernel.arguments if a not in kernel.written]
    read += ["m"] if kernel.finds_modes else []
    return Function(
        name,
        MEANINGS[name],
        tuple(read),
        tuple(1 if a == "t" else kernel.vectors.shape(a)[0] for a in read),
        tuple((language.identifier(n), a, k) for n, a, k in kernel.unpacked),
        tuple(terms),
        tuple(entries),
        shape,
    )


def names_of(program: Program) -> dict[str, tuple[str, ...]]:
    """Names, units and values that are written beside the functions, by the name of the table."""
    equations = program.equations
    return {
        "STATE_NAMES": program.vectors.x,
        "INPUT_NAMES": program.vectors.u,
        "OUTPUT_NAMES": tuple(name for name, _, _ in equations.outputs),
        "MODE_NAMES": program.vectors.m,
        "PARAMETER_NAMES": program.vectors.p,
        "PARAMETER_UNITS": tuple(p.unit for p in equations.parameters),
    }
