"""Pages of the reference that are written from the code: schemas, Python, emitted modules."""

import inspect
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from effect_pages import write_if_new
from sphinx.application import Sphinx

import ptp_symbolic
from ptp_symbolic.formats.diagnosis_file import diagnosis_schema
from ptp_symbolic.formats.platform_file import platform_schema
from ptp_symbolic.symbolic.effects import PACKAGED

FOLDER = "_generated"
GROUPS = {
    "Machines": ("load", "Machine", "Model", "Jacobian", "Linearization", "inverse_dynamics"),
    "Simulation": ("simulate", "Run", "Event", "sensitivity", "Sensitivities"),
    "Many runs": ("simulate_batch", "Batch", "batch_function"),
    "Logs": ("read_log", "Log", "sample"),
    "Fit and diagnosis": ("fit", "FitResult", "Estimate", "diagnose", "Diagnosis"),
    "Experiments": ("experiment", "Experiment", "friction_map", "FrictionMap"),
    "Platforms and effects": ("read_platform", "Platform", "Effect", "check_effect"),
    "Other tools": ("export", "read_robot", "ImportedPlatform"),
    "Errors": ("InputError", "SimulationError"),
}


def setup(app: Sphinx) -> dict[str, Any]:
    """Write the pieces before the sources are read."""
    app.connect("builder-inited", write_pieces)
    return {"version": "1", "parallel_read_safe": True}


def write_pieces(app: Sphinx) -> None:
    """Write what the pages of the reference include into `_generated/`."""
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(exist_ok=True)
    schemas = {"platform": platform_schema(PACKAGED), "diagnosis": diagnosis_schema()}
    schemas["platform"]["properties"].pop("parameters")  # a page per effect has them
    schemas["platform"]["properties"]["parameter"] = schemas["platform"]["definitions"]["parameter"]
    for name, schema in schemas.items():
        write_if_new(folder / f"{name}.md", "\n".join(tables(schema)) + "\n")
    write_if_new(folder / "python.md", "\n".join(python()) + "\n")


def tables(schema: Mapping[str, Any]) -> Iterator[str]:
    """A table of the entries of every table in a schema, the outermost first."""
    yield from _table("", schema)
    for name, own in schema["properties"].items():
        inner = _object(own)
        if inner is not None:
            yield from _table(name, inner)


def _object(schema: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """The object with named entries within a schema: itself, or what its arrays or keys hold."""
    options = [schema, schema.get("items"), schema.get("additionalProperties")]
    options += schema.get("anyOf", [])
    return next((o for o in options if isinstance(o, dict) and o.get("properties")), None)


def _table(name: str, schema: Mapping[str, Any]) -> Iterator[str]:
    if name:
        yield f"\n## `{name}`\n"
        if schema.get("description"):
            yield f"{schema['description']}\n"
    yield "| Key | Type | Needed | Meaning |"
    yield "|---|---|---|---|"
    for key, own in schema["properties"].items():
        needed = "yes" if key in schema.get("required", ()) else ""
        meaning = own.get("description", "").replace("|", "\\|")
        yield f"| `{key}` | {_type(own)} | {needed} | {meaning} |"


def _type(schema: Mapping[str, Any]) -> str:
    if "enum" in schema:
        names = [f"`{name}`" for name in schema["enum"]]
        return " or ".join(names) if len(names) < 6 else "a name"
    if "const" in schema:
        return f"`{schema['const']}`"
    if "anyOf" in schema:
        return " or ".join(_type(option) for option in schema["anyOf"])
    kind = schema.get("type", "any")
    if kind == "array":
        return f"list of {_type(schema.get('items', {}))}"
    words = {"object": "table", "number": "number", "string": "text", "integer": "whole number"}
    return words.get(str(kind), str(kind))


def python() -> Iterator[str]:
    """Directives that print the docstrings of all public names, by group."""
    named = {name for names in GROUPS.values() for name in names}
    missing = set(ptp_symbolic.__all__) - named - {"__version__"}
    if missing or named - set(ptp_symbolic.__all__):
        raise ValueError(f"public names and GROUPS differ: {missing or named}")
    for title, names in GROUPS.items():
        yield f"## {title}\n"
        for name in names:
            is_class = inspect.isclass(getattr(ptp_symbolic, name))
            yield "```{eval-rst}"
            yield f".. auto{'class' if is_class else 'function'}:: ptp_symbolic.{name}"
            if is_class:
                yield "   :members:"
            yield "```\n"
