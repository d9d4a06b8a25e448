"""Text of a platform file is never read as a formula, which SymPy would run as Python."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from ptp_symbolic import loop
from ptp_symbolic.errors import InputError
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


def loose_mentions(source: str) -> list[str]:
    """Names of sympify in a module, other than in strict calls; `S.Zero` converts nothing."""
    nodes = list(ast.walk(ast.parse(source)))
    calls = [node for node in nodes if isinstance(node, ast.Call)]
    harmless = [c.func for c in calls if "strict=True" in map(ast.unparse, c.keywords)]
    harmless += [node.value for node in nodes if isinstance(node, ast.Attribute)]
    named = [n for n in nodes if isinstance(n, ast.Name | ast.Attribute) and n not in harmless]
    words = [ast.unparse(node) for node in named]
    words += [node.name for node in nodes if isinstance(node, ast.alias)]
    return [word for word in words if word.rpartition(".")[2] in NAMES]


def test_values_are_converted_at_one_door(checkout: Path) -> None:
    """What effects contribute is converted where it comes in, strictly; nothing is later."""
    package = checkout / "ptp_symbolic"
    sources = {
        str(module.relative_to(package)): module.read_text(encoding="utf-8")
        for module in sorted(package.rglob("*.py"))
    }
    found = {name: loose_mentions(source) for name, source in sources.items()}
    assert {name: loose for name, loose in found.items() if loose} == {}
    assert [n for n, source in sources.items() if "sympify(" in source] == ["derivation/parts.py"]


@pytest.mark.parametrize(
    "source",
    [
        "sp.sympify(text)",
        "sp.sympify(text, strict=False)",
        "sp.S(text)",
        "map(sp.sympify, texts)",
        "from sympy import sympify as convert",
    ],
)
def test_the_search_finds_a_loose_sympify(source: str) -> None:
    assert len(loose_mentions(source)) == 1


@pytest.mark.parametrize("text", [HOSTILE, "1 + 1", HOSTILE.encode()])
def test_a_strict_sympify_refuses_text(text: str | bytes) -> None:
    with pytest.raises(sp.SympifyError):
        sp.sympify(text, strict=True)


@pytest.mark.parametrize("nested", [(HOSTILE,), {HOSTILE}, {HOSTILE: 1}])
def test_a_strict_sympify_runs_text_in_a_container(nested: Any, converted: list[object]) -> None:
    """Strictness ends at tuple, set and dict: what is emitted must not hand these over either."""
    with pytest.raises(pytest.fail.Exception, match="SymPy parses the text"):
        sp.sympify(nested, strict=True)


def test_free_text_of_a_platform_never_reaches_sympify(
    tmp_path: Path, converted: list[object]
) -> None:
    """Titles and columns may hold any text; only SymPy's own objects are ever converted."""
    platform = read_platform(written(tmp_path, *FREE))
    model = loop.emit(platform)
    assert (model.title, platform.signals[0].column) == (HOSTILE, HOSTILE)
    assert converted
    assert {type(value) for value in converted if not isinstance(value, sp.Basic)} == set()


@pytest.mark.parametrize("field", [*TEXTS, *SIGNAL, *NUMBERS])
def test_hostile_text_in_any_other_field_is_refused(
    field: str, tmp_path: Path, converted: list[object]
) -> None:
    """Names, units and numbers take no free text: the reader refuses it before any derivation."""
    with pytest.raises(InputError, match=r"named\.toml: .*__import__"):
        read_platform(written(tmp_path, field))
    assert converted == []
