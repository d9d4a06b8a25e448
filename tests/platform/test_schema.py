"""The JSON Schema of a platform file: what the reader takes it takes, and mistakes it finds."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.formats.diagnosis_file import diagnosis_schema
from ptp_symbolic.formats.json_schema import schema_text
from ptp_symbolic.formats.platform_file import platform_schema
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.effects import PACKAGED

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is of the extra `test`")

FOLDER = Path(__file__).parents[2] / "ptp_symbolic" / "formats"
PLATFORM = """
[platform]
name = "a"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "backlash"
axis = "pan"
kind = "dead_zone"
[parameters]
J_pan = { value = 1.0, unit = "kg m^2" }
gap_pan = { start = 1.0, unit = "deg", bounds = [0.0, 2.0] }
[signals]
tau_pan = { role = "input", column = "t", unit = "N m", noise = 0.0, delay = "2 ms" }
theta_pan = { role = "output", column = "a", unit = "rad", counts_per_revolution = 7200 }
[log]
time_unit = "ms"
[fit]
window = "2 s"
"""


def errors(document: Any) -> list[str]:
    schema = json.loads((FOLDER / "platform.schema.json").read_text("utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    return [e.message for e in jsonschema.Draft7Validator(schema).iter_errors(document)]


def test_the_schemas_are_those_that_the_code_gives() -> None:
    """After a change: `ptp-symbolic schema platform > ptp_symbolic/formats/platform.schema.json`,
    and the same for `diagnosis`.
    """
    for name, schema in (
        ("platform", platform_schema(PACKAGED)),
        ("diagnosis", diagnosis_schema()),
    ):
        assert (FOLDER / f"{name}.schema.json").read_text("utf-8") == schema_text(schema)


def test_every_platform_of_the_package_and_of_the_tests_is_valid(checkout: Path) -> None:
    files = [
        path
        for folder in ("ptp_symbolic/platform", "ptp_symbolic/machines", "ptp_symbolic/samples")
        for path in (checkout / folder).rglob("*.toml")
    ]
    files += (checkout / "tests/platforms").glob("*.toml")
    assert len(files) >= 13
    assert {path.name: errors(tomllib.loads(path.read_text("utf-8"))) for path in files} == {
        path.name: [] for path in files
    }


def test_a_platform_with_every_table_is_valid() -> None:
    assert errors(tomllib.loads(PLATFORM)) == []


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('name = "a"', 'name = "a"\ncolour = "red"'),
        ('name = "a"', "name = 3"),
        ('name = "a"', 'name = "a b"'),
        ('axes = ["pan"]', 'axes = ["roll"]'),
        ('axes = ["pan"]', ""),
        ('effect = "rigid_bodies"', 'effect = "rigid_body"'),
        ('effect = "rigid_bodies"', 'effect = "rigid_bodies"\naxis = "pan"'),
        ('kind = "dead_zone"', 'kind = "dead"'),
        ('axis = "pan"', ""),
        ("J_pan = {", "J_pam = {"),
        ("value = 1.0", 'value = "1.0"'),
        ("value = 1.0", "value = 1.0, start = 2.0"),
        ("value = 1.0, unit", "unit"),
        ("bounds = [0.0, 2.0]", "bounds = [0.0]"),
        ('role = "input"', 'role = "in"'),
        ("counts_per_revolution = 7200", "counts_per_revolution = 0.5"),
        ("noise = 0.0", "noise = -1.0"),
        ('time_unit = "ms"', "time_unit = 1"),
        ('window = "2 s"', "window = 2.0"),
        ("[log]", "[logs]"),
    ],
)
def test_a_mistake_is_found(right: str, wrong: str, tmp_path: Path) -> None:
    assert right in PLATFORM
    text = PLATFORM.replace(right, wrong, 1)
    assert errors(tomllib.loads(text))


@pytest.mark.parametrize(
    ("table", "path"),
    [
        ("[platform]", ("platform",)),
        ("[[effects]]", ("effects", "items")),
        ("J_pan = {", ("definition",)),
        ("tau_pan = {", ("signals", "additionalProperties")),
        ("[log]", ("log",)),
        ("[fit]", ("fit",)),
    ],
)
def test_tables_have_the_keys_that_the_reader_allows(
    table: str, path: tuple[str, ...], tmp_path: Path
) -> None:
    """The reader lists them where it meets another key."""
    odd = f"{table} nonsense = 1," if table.endswith("{") else f"{table}\nnonsense = 1"
    file = tmp_path / "a.toml"
    file.write_text(PLATFORM.replace(table, odd, 1), encoding="utf-8")
    with pytest.raises(InputError, match="unknown key 'nonsense'") as refused:
        read_platform(file)
    allowed = re.search(r"allowed are (.*)\.$", str(refused.value))
    assert allowed is not None
    schema = platform_schema(PACKAGED)
    own = schema["definitions"]["parameter"]
    if path != ("definition",):
        own = schema["properties"][path[0]]
        for key in path[1:]:
            own = own[key]
    assert sorted(own["properties"]) == allowed[1].split(", ")
