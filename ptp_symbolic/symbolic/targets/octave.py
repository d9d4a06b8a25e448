"""Functions for Octave and MATLAB, one file each."""

import textwrap
from collections.abc import Mapping

from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.functions import Function, functions, names_of
from ptp_symbolic.symbolic.targets.printing import Language
from ptp_symbolic.symbolic.targets.target import remarks_of_functions
from ptp_symbolic.symbolic.targets.words import WORDS

OCTAVE = Language(
    "octave",
    {head: f"{head}({{0}})" for head in ("sqrt", "exp", "log", "sin", "cos", "acos", "floor")}
    | {
        "pow": "{0}^{1}",
        "inverse sqrt": "1.0 / sqrt({0})",
        "Abs": "abs({0})",
        "sign": "sign({0})",
        "Min": "min({0}, {1})",
        "Max": "max({0}, {1})",
        "Heaviside": "double({0} > 0.0)",
        "NearestCount": "({1} * floor(({0}) / {1} + 0.5))",
        "choice": "choice({0}, {1}, {2})",
        "And": "(({0}) && ({1}))",
        "Or": "(({0}) || ({1}))",
        "pi": "3.141592653589793",
    },
    words=WORDS,
)
CHOICE = """
function value = choice(condition, yes, no)
  if condition
    value = yes;
  else
    value = no;
  end
end
"""


class Octave:
    """``name_vector_field.m`` and its like, and ``name_model.m`` with names and values."""

    name = "octave"
    summary = "Functions for Octave and MATLAB"

    def refuse(self, program: Program) -> str | None:
        """Nothing is refused: modes are arguments."""
        return None

    def remarks(self, program: Program) -> list[str]:
        """Nothing is lost; inputs that are late, and names that are others."""
        return remarks_of_functions(program)

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """One file per function, and one that returns names, units and values."""
        own = {f"{name}_{f.name}.m": _text(f, name) for f in functions(program, OCTAVE)}
        return own | {f"{name}_model.m": _model(program, name)}


def _text(own: Function, name: str) -> str:
    shapes = ", ".join(
        f"{a} [{n}]" for a, n in zip(own.arguments, own.sizes, strict=True) if a != "t"
    )
    size = ", ".join(map(str, own.shape if len(own.shape) == 2 else (*own.shape, 1)))
    doc = textwrap.wrap(f"{own.meaning} Shapes: {shapes}; value [{size}].", 92)
    lines = [f"function value = {name}_{own.name}({', '.join(own.arguments)})"]
    lines += [f"  % {line}" for line in doc]
    lines += [f"  {term} = {array}({k + 1});" for term, array, k in own.unpacked]
    lines += [f"  {term} = {text};" for term, text in own.terms]
    lines += ["  value = [", *(f"    ({entry})" for entry in own.entries), "  ];"]
    if len(own.shape) == 2:
        rows, columns = own.shape
        lines.append(f"  value = reshape(value, {columns}, {rows})';")
    lines.append("end")
    text = "\n".join(lines) + "\n"
    return text + CHOICE if "choice(" in text else text


def _model(program: Program, name: str) -> str:
    """Names, units and values of the platform, as a structure."""
    lines = [f"function model = {name}_model()", "  % Names, units and values of the platform."]
    for table, names in names_of(program).items():
        items = ", ".join("'" + n.replace("'", "''") + "'" for n in names)
        lines.append(f"  model.{table.lower()} = {{{items}}};")
    values = "; ".join(repr(float(p.default)) for p in program.equations.parameters)
    lines += [f"  model.parameters = [{values}];", "end", ""]
    return "\n".join(lines)
