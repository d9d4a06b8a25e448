"""Write a program as a self-contained numba module."""

import hashlib
import textwrap

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program.kernel import Entry, Kernel, used_names
from ptp_symbolic.symbolic.program.program import Program, program
from ptp_symbolic.symbolic.targets.numba.docstring import docstring
from ptp_symbolic.symbolic.targets.numba.literals import WIDTH
from ptp_symbolic.symbolic.targets.numba.metadata import metadata_text
from ptp_symbolic.symbolic.targets.numba.mode_functions import (
    lane_functions_text,
    mode_functions_text,
)
from ptp_symbolic.symbolic.targets.printing import Language, Printer

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
LANES = 64  # states side by side: calls cost little among so many, and the first cache holds them
IN_LANES = Language(
    "numba, several states at once",
    {**NUMBA.operations, "sin": "lane_sin({0})", "cos": "lane_cos({0})"},
)
SEAL = "# END sha256 "
DOC_WIDTH = WIDTH - 4
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
    in_lanes = whole.kernel("prepared_derivative")
    if in_lanes is not None and not whole.has_modes and whole.kernel("sample") is None:
        body = "\n\n\n".join([body, lane_functions_text(), _lane_function(in_lanes)])
    opening = docstring(whole.computed, whole.operations)
    head = metadata_text(whole.equations, digest, opening, len(whole.vectors.c))
    return sealed(f"{head}\n\n\n{body}\n")


def sealed(text: str) -> str:
    """`text` with its SHA-256 as the last line, in place of an earlier one."""
    text = text.partition(SEAL)[0]
    return f"{text}{SEAL}{hashlib.sha256(text.encode()).hexdigest()}\n"


def _function(kernel: Kernel) -> str:
    """A compiled function that unpacks what it uses and assigns the lines of a kernel in turn."""
    shapes = "; ".join(_described(kernel, argument) for argument in kernel.arguments)
    shapes = textwrap.fill(f"{shapes}.", DOC_WIDTH)
    rows = [f'"""{kernel.doc}\n\n{shapes}\n"""']
    rows += IMPLIED_MODES if kernel.finds_modes else ()
    rows += [f"{name} = {array}[{index}]" for name, array, index in kernel.unpacked]
    rows += [_assignment(target, expression) for target, expression in kernel.lines]
    if not kernel.lines:
        rows.append("return")
    head = '@njit(cache=True, error_model="numpy", nogil=True)\n'
    head += f"def {kernel.name}({', '.join(kernel.arguments)}):\n"
    return head + textwrap.indent("\n".join(rows), "    ")


def _lane_function(kernel: Kernel) -> str:
    """The function of LANES states side by side, all in one array: LLVM sees that what is written
    is not what is read.
    """
    first, rows = {"t": 0}, 1
    for array in (*"xupc", "dx"):
        first[array] = rows
        rows += kernel.vectors.shape(array)[0]
    places = [(name, array, index) for name, array, index in kernel.unpacked]
    if "t" in used_names(kernel.lines):
        places.insert(0, ("t", "t", 0))
    lines = [f"{name} = {_lane(first[array] + index)}" for name, array, index in places]
    for assignment, (name, expression) in zip(kernel.body, kernel.lines, strict=True):
        target = assignment.target
        place = _lane(first["dx"] + target.indices[0]) if isinstance(target, Entry) else name
        lines.append(_assignment(place, expression, IN_LANES, WIDTH - 4))
    doc = (
        f'"""Write the time derivatives of {LANES} states side by side into w.\n\n'
        f"w [{rows} * {LANES}]: rows of {LANES} numbers, t, then x, u, p, c of prepare and dx.\n"
        '"""'
    )
    loop = f"for lane in range({LANES}):\n" + textwrap.indent("\n".join(lines), "    ")
    head = f'LANES = {LANES}\n\n\n@njit(cache=True, error_model="numpy", nogil=True)\n'
    return head + "def lane_derivative(w):\n" + textwrap.indent(f"{doc}\n{loop}", "    ")


def _lane(row: int) -> str:
    return f"w[{row * LANES} + lane]" if row else "w[lane]"


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


def _assignment(
    target: str, expression: sp.Expr, language: Language = NUMBA, width: int = WIDTH
) -> str:
    source = language.expression(expression)
    if len(target) + len(source) + 7 <= width:
        return f"{target} = {source}"
    return "\n".join(_wrapped(target, expression, language))


def _wrapped(target: str, expression: sp.Expr, language: Language) -> list[str]:
    """A long sum, one term per line; anything else in parentheses, broken at operators."""
    if expression.is_Add:
        terms = [language.expression(t) for t in expression.as_ordered_terms()]
        first, *rest = terms
        signed = [f"- {t[1:].strip()}" if t.startswith("-") else f"+ {t}" for t in rest]
        return [f"{target} = (", f"    {first}", *(f"    {t}" for t in signed), ")"]
    if not expression.is_Mul:
        return [f"{target} = {language.expression(expression)}"]
    negative, above, below = Printer(language).quotient(expression)
    rows = [f"    {'-' if negative else ''}{above[0]}", *(f"    * {f}" for f in above[1:])]
    return [f"{target} = (", *rows, *([f"    / {below}"] if below else []), ")"]
