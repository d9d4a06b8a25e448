"""C99 for firmware and hardware in the loop: header and source, no library but libm."""

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from importlib import resources

from ptp_symbolic.symbolic.program.kernel import Assignment, Entry, Kernel
from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.program.term_names import vocabulary
from ptp_symbolic.symbolic.targets.c99.language import DOUBLE, FLOAT
from ptp_symbolic.symbolic.targets.printing import Language
from ptp_symbolic.symbolic.targets.target import (
    effects_of,
    in_lines,
    remarks_of_functions,
    state_meanings,
    state_units,
)

WIDTH = 96
NAMED_BY_TABLES = ("dx", "y", "c", "bounds", "margin")
UNBROKEN = "\N{NO-BREAK SPACE}"  # in what must stay on one line


class C99:
    """Header and source in C99, in double precision or single (`language`)."""

    def __init__(self, name: str, language: Language) -> None:
        self.name = name
        self.language = language
        self.summary = f"C99, {'single' if language.single else 'double'} precision, with step()"

    def refuse(self, program: Program) -> str | None:
        """Nothing is refused."""
        return None

    def remarks(self, program: Program) -> list[str]:
        """Nothing is lost; inputs that are late, and names that are others."""
        return remarks_of_functions(program)

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """``name.h`` and ``name.c``."""
        return {
            f"{name}.h": header(program, name, self.language),
            f"{name}.c": source(program, name, self.language),
        }


C99_DOUBLE, C99_FLOAT = C99("c99", DOUBLE), C99("c99-float", FLOAT)


def header(program: Program, name: str, language: Language) -> str:
    """The header: sizes, names and units, the machine between two steps, the functions."""
    large, counts, equations = name.upper(), program.operations, program.equations
    tables, words = _tables(program), vocabulary(program.computed).targets
    text = [
        f"/* {_comment(equations.title)}: equations of motion.",
        "",
        f"   Effects: {_comment(', '.join(effects_of(program)))}.",
        f"   Operations of the vector field: {counts.written}, of which {counts.each} at every call"
        " where prepare() does the others once per parameter set. A step evaluates it twice and one"
        " Jacobian, and where modes change up to 30 times more, once for each set of modes that it"
        " tries.",
        "",
        "   All numbers are in SI units. Inputs are those that act: one that is late by a parameter"
        " is delayed by the caller. Matrices are stored by rows; derivatives that are zero for any"
        " argument are not written, so clear arrays once before the first call. */",
        f"#ifndef {large}_H",
        f"#define {large}_H",
        "",
        f"typedef {_real(language)} {name}_real;",
        "",
        "enum {",
        *(f"    {large}_{word} = {number}," for word, number in _sizes(program).items()),
        "};",
        "",
        "enum {",
        f"    {large}_DONE = 0,",
        f"    {large}_DIVERGED = 1,  /* a state is no number, or larger than 1e12 */",
        f"    {large}_UNDECIDED = 3, /* no set of modes is consistent */",
        f"    {large}_OUTSIDE = 4,   /* a state has left the domain of the equations */",
        f"    {large}_NO_PERIOD = 6  /* a sampling time is not positive */",
        "};",
        "",
        *tables,
        f"extern const char *const {name}_state_names[];",
        f"extern const char *const {name}_input_names[];",
        f"extern const char *const {name}_output_names[];",
        f"extern const char *const {name}_parameter_names[];",
        f"extern const char *const {name}_parameter_units[];",
        f"extern const {name}_real {name}_parameters[]; /* values of the platform */",
        f"extern const {name}_real {name}_initial_state[];",
        "",
    ]
    for kernel in _kernels(program):
        text += [
            *_prototype_comment(kernel, words),
            f"void {_signature(kernel, name, language)};",
            "",
        ]
    if program.has_modes:
        text += [
            "/* Find the modes that a state implies. */",
            _prototype(f"void {name}_initial_modes", *_state_arguments(name), f"{name}_real *m"),
            "",
        ]
    text += [*_machine(program, name), "#endif", ""]
    return "\n".join(_filled(text))


def source(program: Program, name: str, language: Language, events: bool = False) -> str:
    """The source: tables, kernels, and what all models have in common; with `events` also how
    modes end and settle at one instant.
    """
    events = program.has_modes and (events or program.has_rigid_contacts)
    equations = program.equations
    values = [language.numeral(float(p.default)) for p in equations.parameters]
    states = list(equations.state_symbols)
    start = {state.name: float(state.initial) for state in equations.extra_states}
    initial = [language.numeral(start.get(str(s), 0.0)) for s in states]
    sizes = _sizes(program)
    text = [
        f'#include "{name}.h"',
        "",
        "#include <math.h>",
        "",
        f"typedef {name}_real real;",
        f"#define REAL(number) {'number##f' if language.single else 'number'}",
        f"#define ABS(number) {'fabsf' if language.single else 'fabs'}(number)",
        "#define MAX(a, b) ((a) > (b) ? (a) : (b))",
        f"#define SMALLEST {'1e-30f' if language.single else '1e-60'}",
        *(f"#define {word} {number}" for word, number in sizes.items()),
        f"#define RIGID {int(program.has_rigid_contacts)}",
        f"#define EVENTS {int(events)}",
        "",
        *_names(f"{name}_state_names", map(str, states)),
        *_names(f"{name}_input_names", (i.name for i in equations.inputs)),
        *_names(f"{name}_output_names", (n for n, _, _ in equations.outputs)),
        *_names(f"{name}_parameter_names", (p.name for p in equations.parameters)),
        *_names(f"{name}_parameter_units", (p.unit for p in equations.parameters)),
        *_array(f"const {name}_real {name}_parameters", values),
        *_array(f"const {name}_real {name}_initial_state", initial),
        "",
        *_layout(program, events),
    ]
    if program.has_modes:
        text.append(_template("modes.c", name))
    for kernel in _kernels(program):
        text += [_function(kernel, name, language), ""]
    text.append(_template("runtime.c", name))
    return "\n".join(_filled(text))


def _template(file: str, name: str) -> str:
    """What all models have in common, for the one called `name`."""
    text = (resources.files("ptp_symbolic.symbolic.targets.c99") / file).read_text()
    return text.replace("model_", f"{name}_").replace("MODEL_", f"{name.upper()}_")


def _kernels(program: Program) -> list[Kernel]:
    """All kernels, and the Jacobian by the state alone, which is all that a step needs."""
    found = []
    for kernel in program.kernels:
        found.append(kernel)
        if kernel.name == "linearize":
            doc = "Write the non-zero derivatives of mode_derivative by state."
            found.append(kernel.restricted("state_jacobian", doc, ("fx",)))
    return found


def _function(kernel: Kernel, name: str, language: Language) -> str:
    """The definition of a kernel."""
    lines = [f"const real {_id(n, language)} = {a}[{k}];" for n, a, k in kernel.unpacked]
    for optional, part in kernel.sections(kernel.lines):
        lines += [f"if ({optional} == 0)", "    return;"] if optional else []
        lines += [_statement(kernel, each, language) for each in part]
    if kernel.finds_modes:
        lines[:0] = ["real m[MODES];", f"{name}_initial_modes(t, x, u, p, m);"]
    used = {array for _, array, _ in kernel.unpacked}
    used |= set("txup") if kernel.finds_modes else set()
    used |= {target.array for target, _ in kernel.body if isinstance(target, Entry)}
    if any("t" in map(str, e.free_symbols) for _, e in kernel.lines):
        used.add("t")
    lines += [f"(void){a};" for a in kernel.arguments if a not in used]
    body = "\n".join(f"    {_broken(line)}" for line in lines)
    head = "\n".join(_filled([f"void {_signature(kernel, name, language)}"]))
    return f"{head}\n{{\n{body}\n}}"


def _statement(kernel: Kernel, assignment: Assignment, language: Language) -> str:
    target, expression = assignment
    text = language.expression(expression)
    if isinstance(target, Entry):
        return f"{target.array}[{target.place(kernel.vectors.shape(target.array))}] = {text};"
    return f"const real {_id(target, language)} = {text};"


def _signature(kernel: Kernel, name: str, language: Language) -> str:
    given = []
    for argument in kernel.arguments:
        if argument == "t":
            given.append(f"{name}_real t")
        else:
            const = "" if argument in kernel.written else "const "
            given.append(f"{const}{name}_real *{argument}")
    return f"{name}_{kernel.name}({', '.join(each.replace(' ', UNBROKEN) for each in given)})"


def _prototype_comment(kernel: Kernel, words: Mapping[str, str]) -> list[str]:
    """What a function does; shapes of its arrays, and what the entries of a vector are that no
    table lists.
    """
    shapes = []
    for argument in kernel.arguments:
        if argument != "t":
            shape = f",{UNBROKEN}".join(map(str, kernel.vectors.shape(argument)))
            shapes.append(f"{argument}{UNBROKEN}[{shape}]")
    said = f"{_comment(kernel.doc)} {'; '.join(shapes)}."
    for array in (a for a in kernel.written if a not in NAMED_BY_TABLES):
        names = [words.get(f"{array}[{k}]", "") for k in range(kernel.vectors.shape(array)[0])]
        said += f" {array}: {', '.join(names)}." if names and all(names) else ""
    optional = ", then ".join(kernel.optional)
    note = f" Pass 0 for what is not asked for: {optional}." if optional else ""
    return [f"/* {said}{note} */"]


def _sizes(program: Program) -> dict[str, int]:
    """Sizes of all arrays, by their name in the source."""
    equations = program.equations
    contacts = len(equations.contacts) + len(equations.switches)
    return {
        "STATES": len(equations.state_symbols),
        "INPUTS": len(equations.inputs),
        "OUTPUTS": len(equations.outputs),
        "PARAMETERS": len(equations.parameters),
        "PREPARED": len(program.vectors.c),
        "MODES": len(program.vectors.m),
        "FRICTIONS": len(equations.frictions),
        "CONTACTS": contacts,
        "GUARDS": 3 * len(equations.frictions) + 4 * contacts,
        "SAMPLERS": len(equations.samplers),
        "UPDATES": len(equations.updates),
        "LIMITS": len(equations.limits),
    }


def _layout(program: Program, events: bool) -> list[str]:
    """Where frictions, contacts, samplers and limits act among the states."""
    equations = program.equations
    states = list(equations.state_symbols)
    layout = program.layout
    lines: list[str] = []
    if equations.frictions or events:
        rates = ", ".join(map(str, layout.friction_rates or (-1,)))
        lines.append(f"static const int FRICTION_RATES[] = {{{rates}}};")
        lines += [
            "/* Per state: the friction that sets it to zero when it comes to rest, or -1. */",
            f"static const int ZERO_AT_REST[] = {{{', '.join(map(str, layout.zero_at_rest))}}};",
        ]
    if program.has_rigid_contacts:
        rows = ", ".join(f"{{{a}, {b}, {rule}}}" for a, b, rule in layout.rigid_contacts)
        lines += [
            "/* Per contact: both rates; 0 sprung, 1 rigid, 2 rigid and held in the gap. */",
            f"static const int CONTACT_RATES[][3] = {{{rows}}};",
        ]
    if equations.updates:
        rows = ", ".join(f"{{{own}, {states.index(s)}}}" for own, s, _ in equations.updates)
        lines.append(f"static const int SAMPLED[][2] = {{{rows}}}; /* sampler and state */")
    if equations.limits:
        rows = ", ".join(str(states.index(limit.state)) for limit in equations.limits)
        lines.append(f"static const int LIMITED[] = {{{rows}}};")
    return [*lines, ""]


def _machine(program: Program, name: str) -> list[str]:
    """The record of a machine between two steps, and the functions that use it."""
    sizes, real = _sizes(program), f"{name}_real"
    n = sizes["STATES"]

    def array(kind: str, field: str, size: int) -> str:
        return f"    {kind} {field}[{max(size, 1)}];"

    fields = [
        array(real, "modes", sizes["MODES"]),
        array(real, "modes_before", sizes["MODES"]),
        array(real, "prepared", sizes["PREPARED"]),
        array(real, "guards", sizes["GUARDS"]),
        array(real, "by_state", n * n),
        array(real, "matrix", n * n),
        *(array(real, word, n) for word in ("k1", "k2", "end")),
        array("int", "order", n),
        array("int", "refused", 2 * sizes["FRICTIONS"]),
    ]
    if sizes["LIMITS"]:
        fields.append(array(real, "bounds", 2 * sizes["LIMITS"]))
    if program.has_rigid_contacts:
        fields.append(array(real, "strike", sizes["CONTACTS"] * (n + 2)))
        fields += [array("int", word, sizes["CONTACTS"]) for word in ("pressed", "settling")]
    if sizes["SAMPLERS"]:
        fields.append(array(real, "sampled", 3 * sizes["SAMPLERS"] + sizes["UPDATES"]))
        fields += [array("double", word, sizes["SAMPLERS"]) for word in ("due", "count")]
        fields.append(array("int", "armed", sizes["SAMPLERS"]))
    machine, state = f"{name}_machine *s", f"{real} *x"
    u, u_end, p = (f"const {real} *{a}" for a in ("u", "u_end", "p"))
    sampling = [
        "/* Run the samplers that are due at t, with inputs as after t. Instants: `due` of the"
        " machine. */",
        _prototype(f"void {name}_sample_now", machine, "double t", state, u, p),
        "",
    ]
    return [
        "/* A machine between two steps, and its room to work; nothing is allocated. */",
        "typedef struct {",
        *fields,
        f"}} {name}_machine;",
        "",
        "/* Prepare the parameters p and find consistent modes of the state x at t. Call it again"
        " when p changes. Returns a status. */",
        _prototype(f"int {name}_begin", machine, f"{real} t", state, u, p),
        "",
        "/* Take x from t to t + h in one step; inputs u at t and u_end at its end (the same where"
        " they are held). Friction and contact are solved implicitly. Returns a status. */",
        _prototype(f"int {name}_step", machine, f"{real} t", f"{real} h", state, u, u_end, p),
        "",
        *(sampling if sizes["SAMPLERS"] else []),
        "/* Take x from t to t_end in equal steps of at most `longest`, inputs held; samplers run"
        " when they are due. Returns a status. */",
        _prototype(
            f"int {name}_advance",
            machine,
            *("double t", "double t_end", "double longest"),
            *(state, u, p),
        ),
        "",
    ]


def _state_arguments(name: str) -> tuple[str, ...]:
    """The time, the state, inputs and parameters, as arguments that are read."""
    return (f"{name}_real t", *(f"const {name}_real *{a}" for a in "xup"))


def _prototype(head: str, *arguments: str) -> str:
    return f"{head}({', '.join(a.replace(' ', UNBROKEN) for a in arguments)});"


def _tables(program: Program) -> list[str]:
    """Comments that say of the entries of arrays what they are, with their units."""
    equations = program.equations
    units, meanings = state_units(equations), state_meanings(equations)
    tables = {
        "States x": [f"{name} [{unit}]: {meanings[name]}" for name, unit in units.items()],
        "Inputs u": [f"{i.name} [{i.unit}]: {i.meaning}" for i in equations.inputs],
        "Outputs y": [f"{n} [{unit}]" for n, unit, _ in equations.outputs],
        "Modes m (slide -1, 0 sticking, 1; side -1, 0, 1; active 0, 1)": list(program.vectors.m),
        "Parameters p": [f"{p.name} [{p.unit}]: {p.meaning}" for p in equations.parameters],
        "DOMAIN, bounds of states": [f"{own.state}: {own.meaning}" for own in equations.limits],
        "REQUIREMENTS of parameters": [own.rule for own in equations.requirements],
    }
    lines = []
    for table, entries in tables.items():
        rows = [f"   {k:3d} {_comment(entry)}" for k, entry in enumerate(entries)]
        lines += [f"/* {table}:", *rows[:-1], f"{rows[-1]} */"] if rows else []
    return lines


def _names(array: str, names: Iterable[str]) -> list[str]:
    return _array(f"const char *const {array}", literals(names))


def literals(texts: Iterable[str]) -> list[str]:
    """Texts as string literals, whatever they hold."""
    return [f'"{_escaped(text)}"' for text in texts]


def _array(head: str, items: Sequence[str]) -> list[str]:
    """The definition of an array, its items on as many lines as they need."""
    return [f"{head}[] = {{", *in_lines(items or ["0"], WIDTH), "};"]


def _escaped(text: str) -> str:
    """A text inside a string literal, whatever it holds; no trigraphs."""
    return "".join(
        c if c.isascii() and c.isprintable() and c not in '"\\?' else f"\\{ord(c):03o}"
        for c in text.encode("utf-8").decode("latin-1")
    )


def _comment(text: str) -> str:
    """A text inside a comment, whatever it holds: titles come from files."""
    plain = " ".join(text.replace("*/", "* /").replace("/*", "/ *").split())
    plain = "".join(c if c.isprintable() else "?" for c in plain)
    return plain.replace("??", "? ?").rstrip("\\")


def _real(language: Language) -> str:
    return "float" if language.single else "double"


def _id(name: str, language: Language) -> str:
    return language.identifier(name)


def _broken(line: str) -> str:
    """A statement on as many lines as it needs."""
    return "\n        ".join(textwrap.wrap(line, WIDTH, break_long_words=False)) or line


def _filled(lines: Sequence[str]) -> list[str]:
    """Lines, those of comments and tables broken where they are too long."""
    found = []
    for line in lines:
        if "\n" in line or len(line) <= WIDTH:
            found.append(line)
        elif line.startswith(("/*", "   ")):
            found += textwrap.wrap(line, WIDTH, subsequent_indent="   ", break_long_words=False)
        else:
            found += textwrap.wrap(line, WIDTH, subsequent_indent="    ", break_long_words=False)
    return [line.replace(UNBROKEN, " ") for line in found]
