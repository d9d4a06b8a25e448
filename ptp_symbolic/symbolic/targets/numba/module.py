"""Write a program as a self-contained numba module."""

import hashlib
import textwrap
from collections.abc import Mapping, Sequence

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program.kernel import GIVEN, Entry, Kernel, Part, used_names
from ptp_symbolic.symbolic.program.program import Program, program
from ptp_symbolic.symbolic.program.sharing import Line
from ptp_symbolic.symbolic.program.term_names import vocabulary
from ptp_symbolic.symbolic.targets.numba.docstring import docstring
from ptp_symbolic.symbolic.targets.numba.language import DOUBLE, FLOAT, IN_LANES
from ptp_symbolic.symbolic.targets.numba.literals import (
    COMPILED,
    INLINED,
    INNER_WIDTH,
    UNBROKEN,
    WIDTH,
    assignment_text,
    function_text,
    tuple_text,
    unpacking_text,
)
from ptp_symbolic.symbolic.targets.numba.metadata import metadata_text, search_text
from ptp_symbolic.symbolic.targets.numba.mode_functions import (
    lane_functions_text,
    mode_functions_text,
    with_modes,
)
from ptp_symbolic.symbolic.targets.printing import Language
from ptp_symbolic.symbolic.targets.target import late_inputs

ARGUMENTS = (
    "# Arguments, in SI: t in s; x in STATE_UNITS, u in INPUT_UNITS, p in the units of"
    " PARAMETERS;\n"
    "# modes m as MODE_NAMES; c as `prepare` writes it. Lengths and shapes are in brackets.\n"
)
MATRICES = {
    "fx": "rows and columns as STATE_NAMES",
    "fu": "rows as STATE_NAMES, columns as INPUT_NAMES",
    "fp": "rows as STATE_NAMES, columns as PARAMETERS",
    "gx": "rows as g of guards, columns as STATE_NAMES",
    "gp": "rows as g of guards, columns as PARAMETERS",
}
LANES = 64  # states side by side: calls cost little among so many, and the first cache holds them
NAMED_BY_CONSTANTS = ("dx", "y", "margin")  # STATE_NAMES, OUTPUT_NAMES, REQUIREMENTS
SEAL = "# END sha256 "
WRITTEN_BY_PARTS = {
    "prepare": ["values = constants(p)", "for k in range(PREPARED):\n    c[k] = values[k]"],
    "mode_derivative": ["prepared_derivative(t, x, u, p, m, constants(p), dx)"],
}
OTHER_NAMES = """# What the field calls some of these functions.
vector_field, events, inverse_dynamics = mode_derivative, guards, equation_error"""
STATE_AND_MODES = ("t", "x", "u", "p", "m")
IMPLIED_MODES = "m = implied_modes(t, x, u, p)"


def module_text(equations: Equations) -> str:
    """Return the source of the module that computes `equations`.

    The text depends on the mathematics alone: the same bytes on every machine. It ends with the
    SHA-256 of everything above, which the loader verifies.
    """
    return written(program(equations))


def written(whole: Program, language: Language = DOUBLE) -> str:
    """Return a program as the source of a module, in double precision or single."""
    words = vocabulary(whole.computed).targets
    functions = [_part(part, language) for part in whole.parts]
    for kernel in whole.kernels:
        if kernel.name == "guards" and whole.has_modes:
            functions.append(_guard_values(kernel, words, language))
        functions.append(_function(kernel, words, language))
    functions += [mode_functions_text(whole, language), OTHER_NAMES]
    functions[0] = ARGUMENTS + functions[0]
    body = "\n\n\n".join(functions)
    digest = hashlib.sha256(body.encode()).hexdigest()[:16]
    if _has_lanes(whole) and not language.single:
        in_lanes = whole.kernel("prepared_derivative")
        assert in_lanes is not None
        body = "\n\n\n".join([body, lane_functions_text(), _lane_function(in_lanes)])
    opening = docstring(whole.computed, whole.operations, language)
    head = metadata_text(whole.equations, digest, opening, len(whole.vectors.c), language)
    return sealed(f"{head}\n\n\n{body}\n\n\n{search_text(whole.equations)}\n")


def _has_lanes(whole: Program) -> bool:
    """Whether several states side by side go through the same operations."""
    return not whole.has_modes and whole.kernel("sample") is None


def sealed(text: str) -> str:
    """`text` with its SHA-256 as the last line, in place of an earlier one."""
    text = text.partition(SEAL)[0]
    return f"{text}{SEAL}{hashlib.sha256(text.encode()).hexdigest()}\n"


def _part(part: Part, language: Language) -> str:
    """A compiled function that returns what kernels have in common."""
    rows = [f'"""{part.doc}"""', *_single_time(part.lines, language)]
    unpacked = [each for each in part.unpacked if each[1] != "m"]
    rows += unpacking_text(unpacked, INNER_WIDTH)
    rows += [assignment_text(name, language.expression(e), INNER_WIDTH) for name, e in part.lines]
    rows.append(tuple_text("return ", part.results, INNER_WIDTH))
    return function_text(INLINED, part.name, with_modes(part.arguments, part.vectors.m), rows)


def _function(kernel: Kernel, words: Mapping[str, str], language: Language) -> str:
    """A compiled function that unpacks what it uses and assigns the lines of a kernel in turn, each
    entry with its name.
    """
    rows = [f'"""{kernel.doc}\n\n{_table(kernel, words)}\n"""']
    if kernel.name in WRITTEN_BY_PARTS and kernel.lines:
        rows += WRITTEN_BY_PARTS[kernel.name]
        return function_text(COMPILED, kernel.name, kernel.arguments, rows)
    if kernel.name == "guards" and kernel.vectors.m:
        entries = [f"g[{k}]" for k in range(*kernel.vectors.shape("g"))]
        given = with_modes(STATE_AND_MODES, kernel.vectors.m)
        rows += _unpacked_modes(kernel)
        call = f"{UNBROKEN}={UNBROKEN}guard_values({', '.join(given)})"
        rows.append(tuple_text("", entries, INNER_WIDTH, call))
        return function_text(COMPILED, kernel.name, kernel.arguments, rows)
    rows += [IMPLIED_MODES] if kernel.finds_modes else ()
    rows += _opening(kernel, language)
    for optional, lines in kernel.sections(kernel.own):
        rows += [f"if len({optional}) == 0:\n    return"] if optional else []
        for target, expression in lines:
            source, meaning = language.expression(expression), words.get(str(target), "")
            own = "" if source == meaning else meaning
            rows.append(assignment_text(str(target), source, INNER_WIDTH, own))
    if not kernel.lines:
        rows.append("return")
    return function_text(COMPILED, kernel.name, kernel.arguments, rows)


def _guard_values(kernel: Kernel, words: Mapping[str, str], language: Language) -> str:
    """The guards as a function that returns them, so that modes are found without an array."""
    rows = ['"""Return what `guards` writes, in modes that are given one by one."""']
    rows += _opening(kernel, language, unpacks_modes=False)
    taken = used_names(kernel.lines) | {name for name, _ in kernel.lines}
    results: dict[int, str] = {}
    for assignment in kernel.sections(kernel.own)[0][1]:
        target, source = assignment.target, language.expression(assignment.expression)
        name = str(target)
        if isinstance(target, Entry):
            name = words[name] if words[name] not in taken else f"{words[name]}_"
            bare = assignment.expression.is_Symbol or (-assignment.expression).is_Symbol
            results[target.indices[0]] = source if bare else name
        if not isinstance(target, Entry) or results[target.indices[0]] == name:
            rows.append(assignment_text(name, source, INNER_WIDTH))
    rows.append(tuple_text("return ", [results[k] for k in sorted(results)], INNER_WIDTH))
    arguments = with_modes(STATE_AND_MODES, kernel.vectors.m)
    return function_text(INLINED, "guard_values", arguments, rows)


def _opening(kernel: Kernel, language: Language, unpacks_modes: bool = True) -> list[str]:
    """What a function begins with: what parts compute, and what its own lines use of arrays."""
    calls = _calls(kernel)
    apart = any("mass_and_forces" in call for call in calls) or not unpacks_modes
    modes = _unpacked_modes(kernel) if apart and unpacks_modes else []
    places = kernel.vectors.unpacked(kernel.own)
    own = [each for each in places if not (apart and each[1] == "m")]
    time = _single_time(kernel.own, language)
    return [*time, *modes, *calls, *unpacking_text(own, INNER_WIDTH)]


def _unpacked_modes(kernel: Kernel) -> list[str]:
    return unpacking_text([(n, "m", k) for k, n in enumerate(kernel.vectors.m)], INNER_WIDTH)


def _single_time(lines: Sequence[Line], language: Language) -> list[str]:
    """In single precision the time is rounded where it is used: callers give a float of Python."""
    used = language.single and "t" in used_names(lines)
    return [f"t = {language.number.format('t')}"] if used else []


def _calls(kernel: Kernel) -> list[str]:
    """Calls of the parts whose results a kernel uses."""
    rows: list[str] = []
    used = used_names(kernel.own)
    for part in reversed(kernel.parts):
        call = f"{part.name}({', '.join(with_modes(part.arguments, part.vectors.m))})"
        if part.arguments == ("p",):
            rows[:0] = [f"c = {call}"] if rows or used & set(part.results) else []
        elif used & set(part.results):
            rows.append(f"forces = {call}")
            places = enumerate(part.results)
            rows += unpacking_text([(n, "forces", k) for k, n in places if n in used], INNER_WIDTH)
    return rows


def _table(kernel: Kernel, words: Mapping[str, str]) -> str:
    """Shapes, units and entries of the arguments of a kernel."""
    read = [_described(kernel, a) for a in kernel.arguments if a not in kernel.written]
    written = [_described(kernel, a) for a in kernel.arguments if a in kernel.written]
    said = [f"{'; '.join([', '.join(read), *written])}."]
    matrices = [f"{array}: {MATRICES[array]}" for array in kernel.arguments if array in MATRICES]
    said += [f"{'; '.join(matrices)}."] if matrices else []
    for array in kernel.arguments:
        names = _entries(kernel, array, words)
        said += [f"{array}: {', '.join(names)}."] if names else []
    if kernel.optional:
        named = " or ".join(kernel.optional)
        said.append(f"Where {named} is empty, it and what follows it is not computed.")
    lines = [textwrap.fill(each, INNER_WIDTH, subsequent_indent="  ") for each in said]
    return "\n".join(lines).replace(UNBROKEN, " ")


def _entries(kernel: Kernel, array: str, words: Mapping[str, str]) -> list[str]:
    """Names of the entries of an array that no constant of the module lists."""
    if array == "c" and not kernel.reads(array):
        return ["what `constants` returns, in its order"]
    if array in NAMED_BY_CONSTANTS:
        return []
    if array == "x" and kernel.vectors.x[-1].startswith(GIVEN):
        given = [name for name in kernel.vectors.x if name.startswith(GIVEN)]
        return [f"STATE_NAMES, then {given[0]}", *given[1:]]
    count = kernel.vectors.shape(array)[0] if array in kernel.vectors.rows else 0
    names = [words.get(f"{array}[{k}]", "") for k in range(count)]
    return names if all(names) else []


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
        lines.append(assignment_text(place, IN_LANES.expression(expression), WIDTH - 8))
    doc = (
        f'"""Write the time derivatives of {LANES} states side by side into w.\n\n'
        f"w [{rows} * {LANES}]: rows of {LANES} numbers, t, then x, u, p, c of prepare and dx.\n"
        '"""'
    )
    loop = f"for lane in range({LANES}):\n" + textwrap.indent("\n".join(lines), "    ")
    return (
        f"LANES = {LANES}\n\n\n{COMPILED}"
        + "def lane_derivative(w):\n"
        + textwrap.indent(f"{doc}\n{loop}", "    ")
    )


def _lane(row: int) -> str:
    return f"w[{row * LANES} + lane]" if row else "w[lane]"


def _described(kernel: Kernel, argument: str) -> str:
    """Shape of an argument of a kernel, and the unit of what it writes."""
    if argument == "t":
        return "t"
    shape = f",{UNBROKEN}".join(map(str, kernel.vectors.shape(argument)))
    rows = kernel.vectors.rows
    unit = f" in {rows[argument][1]}" if argument in rows else ""
    return f"{argument}{UNBROKEN}[{shape}]{unit}"


class NumbaModule:
    """A Python module that numba compiles, in double precision or single (`language`)."""

    def __init__(self, language: Language) -> None:
        self.name = language.name
        self.language = language
        precision = "single" if language.single else "double"
        self.summary = f"Python module for numba, {precision} precision"

    def refuse(self, program: Program) -> str | None:
        """Nothing is refused."""
        return None

    def remarks(self, program: Program) -> list[str]:
        """Nothing is lost, and names are as they are; inputs that are late."""
        return late_inputs(program)

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """``name.py``, or ``name_float.py``."""
        file = f"{name}_float.py" if self.language.single else f"{name}.py"
        return {file: written(program, self.language)}


NUMBA_DOUBLE, NUMBA_FLOAT = NumbaModule(DOUBLE), NumbaModule(FLOAT)
