"""Python modules of array libraries: CasADi and JAX."""

import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.functions import Function, functions, names_of
from ptp_symbolic.symbolic.targets.printing import Language
from ptp_symbolic.symbolic.targets.target import effects_of, in_lines, literal, remarks_of_functions
from ptp_symbolic.symbolic.targets.words import WORDS


@dataclass(frozen=True)
class ArrayModule:
    """A target that is one Python module: `opening` are its imports, `ending` what follows the
    functions, `vector` how a list of entries becomes a vector, `matrix` how that becomes a matrix.
    """

    name: str
    summary: str
    language: Language
    opening: str
    vector: str
    matrix: str
    ending: str

    def refuse(self, program: Program) -> str | None:
        """Nothing is refused: modes are arguments."""
        return None

    def remarks(self, program: Program) -> list[str]:
        """Nothing is lost; inputs that are late, and names that are others."""
        return remarks_of_functions(program)

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """``name_casadi.py`` or ``name_jax.py``."""
        title = " ".join(program.equations.title.split())
        head = [
            f'"""{literal(title)[1:-1]}: equations of motion for {self.language.name}.',
            "",
            *textwrap.wrap(f"Effects: {', '.join(effects_of(program))}.", 96),
            "",
            "Vectors are in the order of the names below, in SI units. Modes m [nm] are numbers:"
            " the direction",
            "of every friction (-1, 0 sticking, 1), then side and activity of every contact and"
            " switch.",
            "The functions are smooth while they last; `guards` tells when they end.",
            '"""',
            "",
            self.opening,
        ]
        tables = [_tuple(table, map(literal, names)) for table, names in names_of(program).items()]
        values = (repr(float(p.default)) for p in program.equations.parameters)
        tables.append(_tuple("PARAMETERS", values))
        own = functions(program, self.language)
        arguments = ((f.name, ", ".join(map(literal, f.arguments))) for f in own)
        sizes = ((f.name, ", ".join(map(str, f.sizes))) for f in own)
        tables += [_by_function("ARGUMENTS", arguments), _by_function("SIZES", sizes)]
        body = [self._function(each) for each in own]
        parts = ["\n".join(head), "\n".join(tables), *body, self.ending]
        return {f"{name}_{self.name}.py": "\n\n\n".join(parts).rstrip() + "\n"}

    def _function(self, own: Function) -> str:
        shapes = ", ".join(
            f"{a} [{n}]" for a, n in zip(own.arguments, own.sizes, strict=True) if a != "t"
        )
        size = ", ".join(map(str, own.shape))
        doc = textwrap.fill(f"{own.meaning} Shapes: {shapes}; returns [{size}].", 92)
        lines = [f'"""{doc}"""']
        lines += [f"{name} = {array}[{k}]" for name, array, k in own.unpacked]
        lines += [f"{name} = {text}" for name, text in own.terms]
        entries = ",\n".join(f"    {entry}" for entry in own.entries)
        returned = self.vector.format(f"\n{entries},\n")
        if len(own.shape) == 2:
            returned = self.matrix.format(returned, *own.shape)
        lines.append(f"return {returned}")
        text = textwrap.indent("\n".join(lines), "    ")
        return f"def {own.name}({', '.join(own.arguments)}):\n{text}"


def _tuple(table: str, items: Iterable[str]) -> str:
    lines = [line for line in in_lines(items) if line.strip()]
    return "\n".join([f"{table} = (", *lines, ")"])


def _by_function(table: str, rows: Iterable[tuple[str, str]]) -> str:
    """A dictionary of tuples, by the name of the function."""
    return "\n".join([f"{table} = {{", *(f'    "{name}": ({row}),' for name, row in rows), "}"])


FUNCTIONS = {  # of SymPy's heads, by the name that CasADi and JAX give them
    "acos": ("acos", "arccos"),
    "Abs": ("fabs", "abs"),
    "Min": ("fmin", "minimum"),
    "Max": ("fmax", "maximum"),
    "choice": ("if_else", "where"),
    "And": ("logic_and", "logical_and"),
    "Or": ("logic_or", "logical_or"),
    **{same: (same, same) for same in ("sqrt", "exp", "log", "sin", "cos", "sign", "floor")},
}
ARGUMENTS = {"Min": 2, "Max": 2, "And": 2, "Or": 2, "choice": 3}


def _language(name: str, at: str, column: int) -> Language:
    """A language whose functions are those of the module `at`."""
    own = {head: f"{at}.{names[column]}" for head, names in FUNCTIONS.items()}
    calls = {
        head: f"{called}({', '.join(f'{{{k}}}' for k in range(ARGUMENTS.get(head, 1)))})"
        for head, called in own.items()
    }
    others = {
        "pow": "{0}**{1}",
        "inverse sqrt": f"1.0 / {own['sqrt']}({{0}})",
        "Heaviside": f"{own['choice']}({{0}} > 0.0, 1.0, 0.0)",
        "NearestCount": f"({{1}} * {own['floor']}(({{0}}) / {{1}} + 0.5))",
        "pi": "3.141592653589793",
    }
    return Language(name, calls | others, words=WORDS)


CASADI = ArrayModule(
    "casadi",
    "Python module for CasADi: SX and MX functions",
    _language("CasADi", "ca", 0),
    "import casadi as ca",
    "ca.vertcat({})",
    "ca.reshape({0}, {2}, {1}).T",
    '''def function(name, kind=ca.SX):
    """The function `name` of this module as a casadi.Function of symbols of `kind`: SX or MX."""
    symbols = [kind.sym(a, n) for a, n in zip(ARGUMENTS[name], SIZES[name])]
    value = globals()[name](*symbols)
    return ca.Function(name, symbols, [value], list(ARGUMENTS[name]), ["value"])''',
)
JAX = ArrayModule(
    "jax",
    "Python module for JAX: functions for jit, vmap and grad, in double precision",
    _language("JAX", "jnp", 1),
    'import jax\nimport jax.numpy as jnp\n\njax.config.update("jax_enable_x64", True)',
    "jnp.array([{}])",
    "{0}.reshape({1}, {2})",
    "",
)
