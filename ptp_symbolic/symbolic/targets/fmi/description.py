"""The XML of an FMU: what it is, its units, types, variables and structure; how it is built."""

import re
from collections.abc import Mapping
from xml.etree import ElementTree as Xml

from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.fmi.variables import (
    CONTINUOUS,
    DISCRETE,
    ENUMERATIONS,
    Variable,
    Variables,
)

# Powers of SI base units, and of the radian, in derived ones.
BASE = {
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "H": {"kg": 1, "m": 2, "s": -2, "A": -2},
    "Hz": {"s": -1},
    **{unit: {unit: 1} for unit in ("kg", "m", "s", "A", "K", "rad")},
}
FACTOR = re.compile(r"([A-Za-z]+)(?:\^(-?\d+))?")


def base_units(unit: str) -> dict[str, int]:
    """Powers of the SI base units and the radian in a unit such as ``N m s/rad``."""
    powers: dict[str, int] = {}
    above, _, below = unit.partition("/")
    for sign, part in ((1, above), (-1, below)):
        for name, power in FACTOR.findall(part):
            for base, own in BASE.get(name, {}).items():
                powers[base] = powers.get(base, 0) + sign * own * int(power or 1)
    return {base: power for base, power in powers.items() if power}


def description(
    program: Program, found: Variables, name: str, version: str, token: str, wrapper: str
) -> str:
    """The text of modelDescription.xml."""
    old, equations = version == "2.0", program.equations
    root = Xml.Element(
        "fmiModelDescription",
        {
            "fmiVersion": version,
            "modelName": legible(equations.name) or name,
            "guid" if old else "instantiationToken": token,
            "description": legible(equations.title),
            "generationTool": "ptp_symbolic",
            "variableNamingConvention": "flat",
        },
    )
    if old:
        root.set("numberOfEventIndicators", str(len(found.indicators)))
    _interfaces(root, name, old, wrapper)
    units = Xml.SubElement(root, "UnitDefinitions")
    for unit in dict.fromkeys((*found.units, "s")):
        own = Xml.SubElement(units, "Unit", {"name": unit})
        Xml.SubElement(own, "BaseUnit", {b: str(p) for b, p in base_units(unit).items()})
    _types(root, found, old)
    categories = Xml.SubElement(root, "LogCategories")
    Xml.SubElement(categories, "Category", {"name": "logStatusError"})
    Xml.SubElement(
        root, "DefaultExperiment", {"startTime": "0", "stopTime": "1", "tolerance": "1e-8"}
    )
    listed = Xml.SubElement(root, "ModelVariables")
    if not old:
        time = {"name": "time", "valueReference": "0", "causality": "independent"}
        time |= {"variability": CONTINUOUS, "description": "time", "unit": "s"}
        Xml.SubElement(listed, "Float64", time)
    index = {v.reference: str(k + 1) for k, v in enumerate(found.all)}
    for variable in found.all:
        (_variable_2 if old else _variable_3)(listed, variable, index)
    (_structure_2 if old else _structure_3)(root, found, index)
    return _text(root)


def build_description(name: str, wrapper: str) -> str:
    """The text of buildDescription.xml of FMI 3.0."""
    root = Xml.Element("fmiBuildDescription", {"fmiVersion": "3.0"})
    build = Xml.SubElement(root, "BuildConfiguration", {"modelIdentifier": name})
    sources = Xml.SubElement(build, "SourceFileSet", {"language": "C99"})
    Xml.SubElement(sources, "SourceFile", {"name": wrapper})
    Xml.SubElement(build, "Library", {"name": "m", "external": "true"})
    return _text(root)


def legible(text: str) -> str:
    """A text without characters that XML cannot hold."""
    return "".join(c for c in text if c in "\t\n" or (c.isprintable() and ord(c) < 0xFFFE))


def _text(root: Xml.Element) -> str:
    Xml.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{Xml.tostring(root, encoding="unicode")}\n'


def _interfaces(root: Xml.Element, name: str, old: bool, wrapper: str) -> None:
    state = "FMUstate" if old else "FMUState"
    shared = {
        "modelIdentifier": name,
        f"canGetAndSet{state}": "true",
        f"canSerialize{state}": "true",
        "providesDirectionalDerivative" if old else "providesDirectionalDerivatives": "true",
    }
    if old:
        shared["canNotUseMemoryManagementFunctions"] = "true"
    else:
        shared["providesAdjointDerivatives"] = "true"
    further = {"ModelExchange": dict[str, str](), "CoSimulation": {}}
    step = ("completedIntegratorStepNotNeeded", "needsCompletedIntegratorStep")
    further["ModelExchange"] = {step[0]: "true"} if old else {step[1]: "false"}
    further["CoSimulation"]["canHandleVariableCommunicationStepSize"] = "true"
    for kind, own in further.items():
        element = Xml.SubElement(root, kind, shared | own)
        if old:
            files = Xml.SubElement(element, "SourceFiles")
            Xml.SubElement(files, "File", {"name": wrapper})


def _types(root: Xml.Element, found: Variables, old: bool) -> None:
    used = [kind for kind in ENUMERATIONS if kind in {v.enumeration for v in found.modes}]
    if not used:
        return
    types = Xml.SubElement(root, "TypeDefinitions")
    for kind in used:
        if old:
            simple = Xml.SubElement(types, "SimpleType", {"name": kind})
            own = Xml.SubElement(simple, "Enumeration")
        else:
            own = Xml.SubElement(types, "EnumerationType", {"name": kind})
        for value, word in ENUMERATIONS[kind]:
            Xml.SubElement(own, "Item", {"name": word, "value": str(value)})


def _shared(variable: Variable) -> dict[str, str]:
    """Attributes of a variable that both versions have."""
    given = {
        "name": variable.name,
        "valueReference": str(variable.reference),
        "description": legible(variable.meaning),
        "causality": variable.causality,
        "variability": variable.variability,
    }
    if variable.causality != "input":
        given["initial"] = "calculated" if variable.start is None else "exact"
    return given


def _value(variable: Variable) -> dict[str, str]:
    """Unit, bounds, size and start of a real variable."""
    given = {"unit": variable.unit} if variable.unit else {}
    if variable.nominal is not None:
        given["nominal"] = repr(variable.nominal)
    for word, bound in (("min", variable.lower), ("max", variable.upper)):
        if bound is not None and abs(bound) != float("inf"):
            given[word] = repr(bound)
    if variable.start is not None:
        given["start"] = repr(variable.start)
    if variable.jumps:
        given["reinit"] = "true"
    return given


def _variable_2(listed: Xml.Element, variable: Variable, index: Mapping[int, str]) -> None:
    element = Xml.SubElement(listed, "ScalarVariable", _shared(variable))
    if variable.enumeration:
        Xml.SubElement(element, "Enumeration", {"declaredType": variable.enumeration})
        return
    value = _value(variable)
    if variable.of is not None:
        value["derivative"] = index[variable.of]
    Xml.SubElement(element, "Real", value)


def _variable_3(listed: Xml.Element, variable: Variable, _: Mapping[int, str]) -> None:
    if variable.enumeration:
        given = _shared(variable) | {"declaredType": variable.enumeration}
        Xml.SubElement(listed, "Enumeration", given)
        return
    given = _shared(variable) | _value(variable)
    if variable.of is not None:
        given["derivative"] = str(variable.of)
    Xml.SubElement(listed, "Float64", given)


def _structure_2(root: Xml.Element, found: Variables, index: Mapping[int, str]) -> None:
    structure = Xml.SubElement(root, "ModelStructure")
    own = {v.reference: v for v in found.all}
    sampled = {v.reference for v in found.states if v.variability == DISCRETE}

    def listed(word: str, references: list[int], with_dependencies: bool) -> None:
        if not references:
            return
        group = Xml.SubElement(structure, word)
        for r in sorted(references, key=lambda r: int(index[r])):
            given = {"index": index[r]}
            if with_dependencies:
                known = [d for d in own[r].depends if d not in sampled]
                given["dependencies"] = " ".join(index[d] for d in known)
            Xml.SubElement(group, "Unknown", given)

    derivatives = [v.reference for v in found.derivatives]
    listed("Outputs", list(found.seen), True)
    listed("Derivatives", derivatives, True)
    listed("InitialUnknowns", [*(v.reference for v in found.outputs), *derivatives], False)


def _structure_3(root: Xml.Element, found: Variables, _: Mapping[int, str]) -> None:
    structure = Xml.SubElement(root, "ModelStructure")
    own = {v.reference: v for v in found.all}
    sampled = {v.reference for v in found.states if v.variability == DISCRETE}

    def entry(word: str, reference: int, with_dependencies: bool) -> None:
        given = {"valueReference": str(reference)}
        if with_dependencies:
            known = [d for d in own[reference].depends if d not in sampled]
            given["dependencies"] = " ".join(map(str, known))
        Xml.SubElement(structure, word, given)

    for reference in found.seen:
        entry("Output", reference, True)
    for variable in found.derivatives:
        entry("ContinuousStateDerivative", variable.reference, True)
    for variable in (*found.derivatives, *found.outputs):
        entry("InitialUnknown", variable.reference, False)
    for variable in found.indicators:
        entry("EventIndicator", variable.reference, False)
