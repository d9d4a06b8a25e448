"""Functional Mock-up Units, FMI 2.0 and 3.0: model exchange and co-simulation, with events.

An FMU is a zip archive of a description in XML, the C of the machine, and what a compiler makes of
it. Source: Modelica Association, Functional Mock-up Interface, versions 2.0.4 and 3.0.1.
"""

import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from importlib import resources

import sympy as sp

from ptp_symbolic.symbolic.program import dynamics
from ptp_symbolic.symbolic.program.kernel import Kernel
from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.program.signals import output_input_jacobian_kernel
from ptp_symbolic.symbolic.targets.c99 import header, literals, source
from ptp_symbolic.symbolic.targets.c99.language import DOUBLE
from ptp_symbolic.symbolic.targets.fmi.archive import archive, missing_systems, systems
from ptp_symbolic.symbolic.targets.fmi.description import build_description, description
from ptp_symbolic.symbolic.targets.fmi.variables import FIXED, Variables, variables
from ptp_symbolic.symbolic.targets.target import remarks_of_functions

HEADERS = {
    "2.0": ("fmi2TypesPlatform.h", "fmi2FunctionTypes.h", "fmi2Functions.h"),
    "3.0": ("fmi3PlatformTypes.h", "fmi3FunctionTypes.h", "fmi3Functions.h"),
}


class Fmu:
    """A Functional Mock-up Unit of a `version` of the interface."""

    def __init__(self, version: str) -> None:
        self.version = version
        self.name = f"fmu{version[0]}"
        self.summary = f"FMU, FMI {version}: model exchange, co-simulation, sources and binaries"

    def refuse(self, program: Program) -> str | None:
        """Why no binary can be made here."""
        return None if systems(self.version) else "no C compiler is here; install gcc, or ziglang"

    def remarks(self, program: Program) -> list[str]:
        """Names that are others, inputs that the importer delays, systems without a binary."""
        found = remarks_of_functions(program)
        missing = ", ".join(missing_systems(self.version))
        if missing:
            found.append(
                f"no binary for {missing}: install ziglang, or let the importer compile the sources"
            )
        return found

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """Texts inside the archive, by name."""
        whole = replace(program, kernels=(*program.kernels, _input_slopes(program)))
        own = resources.files("ptp_symbolic.symbolic.targets.fmi")
        wrapper = f"fmi{self.version[0]}.c"
        instance = (own / "instance.c").read_text()
        instance = instance.replace("model_", f"{name}_").replace("MODEL_", f"{name.upper()}_")
        texts = {
            f"{name}.h": header(whole, name, DOUBLE),
            f"{name}.c": source(whole, name, DOUBLE, events=True),
            "instance.c": f'#include "{name}.c"\n#include "facts.h"\n\n{instance}',
            wrapper: (own / wrapper).read_text(),
        }
        found = variables(whole)
        facts = _facts(whole, found)
        digest = hashlib.sha256("".join((*texts.values(), facts, self.version)).encode())
        token = f"{{{digest.hexdigest()[:32]}}}"
        texts["facts.h"] = f'#define TOKEN "{token}"\n{facts}'
        texts |= {file: (own / file).read_text() for file in HEADERS[self.version]}
        inside = {f"sources/{file}": text for file, text in texts.items()}
        if self.version == "3.0":
            inside["sources/buildDescription.xml"] = build_description(name, wrapper)
        xml = description(whole, found, name, self.version, token, wrapper)
        return {"modelDescription.xml": xml, **inside}

    def pack(
        self, files: Mapping[str, str], name: str, say: Callable[[str], None]
    ) -> Mapping[str, bytes]:
        """The archive ``name.fmu`` of `files`, with a binary for every system that can be built;
        which is compiled for is said.

        Raises InputError where a compiler fails.
        """
        return {f"{name}.fmu": archive(files, name, self.version, systems(self.version), say)}


FMU_2, FMU_3 = Fmu("2.0"), Fmu("3.0")


def _input_slopes(program: Program) -> Kernel:
    """The derivatives of outputs by inputs, which no other target needs."""
    solve = dynamics.solve_accelerations(program.computed)
    return output_input_jacobian_kernel(program.equations, program.computed, solve, program.vectors)


def _facts(program: Program, found: Variables) -> str:
    """What the C of an instance has to know beside the machine itself."""
    equations = program.equations
    related, strict = [], []
    for own in equations.requirements:
        symbols = {str(symbol) for symbol in own.holds.free_symbols}
        places = [str(i) for i, p in enumerate(equations.parameters) if p.name in symbols]
        related.append(f"{{{', '.join((*places, '-1'))}}}")
        strict.append(str(int(isinstance(own.holds, sp.StrictGreaterThan | sp.StrictLessThan))))
    widest = max((row.count(",") + 1 for row in related), default=1)
    domain = [f"{own.state} has left its domain: {own.meaning}" for own in equations.limits]
    field = program.kernel("mode_derivative")
    assert field is not None
    timed = any("t" in map(str, e.free_symbols) for _, e in field.lines)
    sizes = {v.reference: v.nominal for v in found.states}
    nominal = [repr(sizes[own.of] or 1.0) for own in found.derivatives if own.of is not None]
    fixed = [str(int(p.variability == FIXED)) for p in found.parameters]
    lines = [
        f"#define CONTINUOUS {len(found.derivatives)} /* states that samplers do not set */",
        f"#define REQUIREMENTS {len(related)}",
        f"#define DEPENDS_ON_TIME {int(timed)}",
        *_table("double LOWEST", (_bound(p.lower) for p in equations.parameters)),
        *_table("double HIGHEST", (_bound(p.upper) for p in equations.parameters)),
        "/* Sizes to be expected of the continuous states. */",
        *_table("double NOMINALS", nominal),
        "/* Whether a parameter keeps its value once the instance is initialised. */",
        *_table("int FIXED", fixed),
        "/* Relations between parameters: which, and -1; the rule; whether it is strict. */",
        f"static const int RELATED[][{widest}] = {{",
        *(f"    {row}," for row in related or ["{-1}"]),
        "};",
        *_table("char *const RULES", literals(own.rule for own in equations.requirements)),
        *_table("int STRICT", strict),
        *_table("char *const DOMAIN_TEXTS", literals(domain)),
    ]
    return "\n".join((*lines, ""))


def _table(head: str, items: Iterable[str]) -> list[str]:
    rows = list(items)
    return [f"static const {head}[] = {{", *(f"    {item}," for item in rows or ["0"]), "};"]


def _bound(value: float) -> str:
    if abs(value) == float("inf"):
        return "HUGE_VAL" if value > 0 else "-HUGE_VAL"
    return repr(float(value))
