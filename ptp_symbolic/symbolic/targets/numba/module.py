"""Write a program as a self-contained numba module."""

import hashlib
import textwrap

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program.kernel import Kernel
from ptp_symbolic.symbolic.program.program import Program, program
from ptp_symbolic.symbolic.targets.numba.docstring import docstring
from ptp_symbolic.symbolic.targets.numba.literals import WIDTH, assignment_text
from ptp_symbolic.symbolic.targets.numba.metadata import metadata_text, search_text
from ptp_symbolic.symbolic.targets.numba.mode_functions import mode_functions_text
from ptp_symbolic.symbolic.targets.printing import Language

NUMBA = Language(
    "numba",
    {
        "pow": "{0}**{1}",
        "sqrt": "math.sqrt({0})",
        "inverse sqrt": "1/math.sqrt({0})",
        "Heaviside": "(1.0 if {0} > 0.0 else 0.0)",
        "NearestCount": "({1} * math.floor(({0}) / {1} + 0.5))",
        "pi": "math.pi",
    },
)
SEAL = "# END sha256 "
INNER_WIDTH = WIDTH - 4
IMPLIED_MODES = ("m = np.empty(len(MODE_NAMES))", "initial_modes(t, x, u, p, m)")


def module_text(equations: Equations) -> str:
    """Return the source of the module that computes `equations`.

    The text depends on the mathematics alone: the same bytes on every machine. It ends with the
    SHA-256 of everything above, which the loader verifies.
    """
    return written(program(equations))


def written(whole: Program) -> str:
    """Return a program as the source of a module."""
    modes = mode_functions_text(whole.has_modes, whole.has_rigid_contacts)
    body = "\n\n\n".join([*(_function(kernel) for kernel in whole.kernels), modes])
    digest = hashlib.sha256(body.encode()).hexdigest()[:16]
    opening = docstring(whole.computed, whole.operations)
    head = metadata_text(whole.equations, digest, opening, len(whole.vectors.c))
    return sealed(f"{head}\n\n\n{body}\n\n\n{search_text(whole.equations)}\n")


def sealed(text: str) -> str:
    """`text` with its SHA-256 as the last line, in place of an earlier one."""
    text = text.partition(SEAL)[0]
    return f"{text}{SEAL}{hashlib.sha256(text.encode()).hexdigest()}\n"


def _function(kernel: Kernel) -> str:
    """A compiled function that unpacks what it uses and assigns the lines of a kernel in turn."""
    shapes = "; ".join(_described(kernel, argument) for argument in kernel.arguments)
    shapes = textwrap.fill(f"{shapes}.", INNER_WIDTH)
    rows = [f'"""{kernel.doc}\n\n{shapes}\n"""']
    rows += IMPLIED_MODES if kernel.finds_modes else ()
    rows += [f"{name} = {array}[{index}]" for name, array, index in kernel.unpacked]
    for optional, lines in kernel.sections:
        rows += [f"if len({optional}) == 0:\n    return"] if optional else []
        rows += [assignment_text(str(t), NUMBA.expression(e), INNER_WIDTH) for t, e in lines]
    if not kernel.lines:
        rows.append("return")
    head = '@njit(cache=True, error_model="numpy", nogil=True)\n'
    head += f"def {kernel.name}({', '.join(kernel.arguments)}):\n"
    return head + textwrap.indent("\n".join(rows), "    ")


def _described(kernel: Kernel, argument: str) -> str:
    """Shape and unit of an argument of a kernel."""
    if argument == "t":
        return "t in s"
    vectors = kernel.vectors
    said = {
        "x": "in STATE_UNITS",
        "u": "in INPUT_UNITS",
        "p": "in the units of PARAMETERS",
        "c": "of prepare",
    }
    shape = ", ".join(map(str, vectors.shape(argument)))
    if argument == "m":
        return f"m [{shape}], see MODE_NAMES"
    if argument in vectors.rows:
        return f"{argument} [{shape}] in {vectors.rows[argument][1]}"
    return f"{argument} [{shape}] {said[argument]}" if argument in said else f"{argument} [{shape}]"
