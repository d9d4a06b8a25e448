"""Text of a platform file is never read as a formula, which SymPy would run as Python."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.platform import read_platform

HOSTILE = "__import__('os').system('touch mark')"
PLATFORM = """[platform]
name = "named"
title = "a title"
axes = ["pan"]
gravity = 9.81
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "dc_motor"
axis = "pan"
[[effects]]
effect = "backlash"
axis = "pan"
kind = "elastic_impact"
[[effects]]
effect = "pid_controller"
axis = "pan"
[parameters.J_pan]
value = 2e-3
unit = "kg m^2"
[parameters.J_motor_pan]
same_as = "J_pan"
[signals.theta_pan]
role = "output"
column = "a column"
unit = "rad"
"""
FREE = ('"a title"', '"a column"')
TEXTS = ('"named"', '"rigid_bodies"', '"pan"', '"elastic_impact"', "J_pan", '"J_pan"', '"kg m^2"')
SIGNAL = ("theta_pan", '"output"', '"rad"')
NUMBERS = ("9.81", "2e-3")
NAMES = {"sympify", "_sympify", "S"}


@pytest.fixture(autouse=True)
def nothing_is_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Whatever a test does, no text is run: none leaves `mark` in the working folder."""
    monkeypatch.chdir(tmp_path)
    yield
    assert not (tmp_path / "mark").exists()


@pytest.fixture
def converted(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """All that the package gives to sympify; text fails there, and wherever SymPy parses it."""
    given: list[object] = []
    usual = sp.sympify

    def sympify(value: object, **more: Any) -> Any:
        if isinstance(value, str):
            pytest.fail(f"sympify was given the text {value!r}")
        given.append(value)
        return usual(value, **more)

    def parse_expr(text: str, *_: object, **__: object) -> None:
        pytest.fail(f"SymPy parses the text {text!r}")

    monkeypatch.setattr(sp, "sympify", sympify)
    monkeypatch.setattr("sympy.parsing.sympy_parser.parse_expr", parse_expr)
    return given


def written(folder: Path, *replaced: str) -> Path:
    """The platform file, in which the hostile text stands for each of `replaced`."""
    text = PLATFORM
    for each in replaced:
        assert each in text
        text = text.replace(each, f'"{HOSTILE}"', 1)
    path = folder / "named.toml"
    path.write_text(text, encoding="utf-8")
    return path


def mentions(source: str) -> list[str]:
    """Names of sympify in a module; `S.Zero` converts nothing."""
    nodes = list(ast.walk(ast.parse(source)))
    constants = [node.value for node in nodes if isinstance(node, ast.Attribute)]
    named = [n for n in nodes if isinstance(n, ast.Name | ast.Attribute) and n not in constants]
    words = [ast.unparse(node) for node in named]
    words += [node.name for node in nodes if isinstance(node, ast.alias)]
    return [word for word in words if word.rpartition(".")[2] in NAMES]


def test_no_module_converts_a_value_to_an_expression(checkout: Path) -> None:
    """What effects contribute is SymPy's own from the start, so no text can become a formula."""
    modules = sorted((checkout / "ptp_symbolic").rglob("*.py"))
    found = {module.name: mentions(module.read_text(encoding="utf-8")) for module in modules}
    assert {name: words for name, words in found.items() if words} == {}


@pytest.mark.parametrize(
    "source",
    [
        "sp.sympify(text)",
        "sp.sympify(text, strict=True)",
        "sp.S(text)",
        "map(sp.sympify, texts)",
        "from sympy import sympify as convert",
    ],
)
def test_the_search_finds_a_mention(source: str) -> None:
    assert len(mentions(source)) == 1


def test_free_text_of_a_platform_never_reaches_sympify(
    tmp_path: Path, converted: list[object]
) -> None:
    """Titles and columns may hold any text; none of it is converted or parsed."""
    platform = read_platform(written(tmp_path, *FREE))
    model = emission.emit(platform)
    assert (model.title, platform.signals[0].column) == (HOSTILE, HOSTILE)
    assert converted == []


@pytest.mark.parametrize("field", [*TEXTS, *SIGNAL, *NUMBERS])
def test_hostile_text_in_any_other_field_is_refused(
    field: str, tmp_path: Path, converted: list[object]
) -> None:
    """Names, units and numbers take no free text: the reader refuses it before any derivation."""
    with pytest.raises(InputError, match=r"named\.toml: .*__import__"):
        read_platform(written(tmp_path, field))
    assert converted == []
