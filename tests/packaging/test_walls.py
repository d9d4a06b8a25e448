"""Walls that the import contracts of pyproject.toml cannot express."""

import ast
from pathlib import Path

import pytest

ALLOWED_IN_GENERATED = {"math", "numpy", "numba"}
RUNS_TEXT = {"eval", "exec", "compile", "sympify", "parse_expr"}
UNPICKLES = {"pickle", "cPickle", "dill", "cloudpickle", "joblib", "marshal", "shelve"}


def imported_names(source: str) -> set[str]:
    """Top-level names of everything that a module imports, wherever the import stands."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add("." * node.level + (node.module or "").split(".")[0])
    return names


def calls_that_run_text(source: str) -> set[str]:
    """Names of the calls in a module that would run or parse a string as code.

    Patterns and functions of numba have a method `compile` that is not the built-in function.
    """
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call):
            continue
        whole = ast.unparse(node.func)
        name = whole.rpartition(".")[2]
        is_method = name == "compile" and whole not in ("compile", "builtins.compile")
        if name in RUNS_TEXT and not is_method:
            found.add(name)
    return found


def test_generated_modules_import_math_numpy_numba_and_nothing_else(checkout: Path) -> None:
    modules = sorted((checkout / "generated").glob("**/*.py"))
    strangers = {
        module.name: imported_names(module.read_text(encoding="utf-8")) - ALLOWED_IN_GENERATED
        for module in modules
    }
    assert {"ideal.py", "payload.py", "pan_drive.py"} <= set(strangers)
    assert {name: names for name, names in strangers.items() if names} == {}


def test_no_text_is_ever_run_or_unpickled(checkout: Path) -> None:
    found = {}
    for module in sorted((checkout / "ptp_symbolic").rglob("*.py")):
        source = module.read_text(encoding="utf-8")
        words = calls_that_run_text(source) | (imported_names(source) & UNPICKLES)
        if words:
            found[str(module.relative_to(checkout))] = sorted(words)
    assert found == {}


@pytest.mark.parametrize(
    ("source", "caught"),
    [
        ("import sympy as sp\nsp.sympify(text)", {"sympify"}),
        ("def f(text):\n    return eval(text)", {"eval"}),
        ("from sympy.parsing.sympy_parser import parse_expr\nparse_expr(text)", {"parse_expr"}),
        ("import sympy as sp\nsp.sympify(number, strict=True)", {"sympify"}),
        ("import re\nre.compile(pattern)", set()),
        ("from numba import njit\nnjit(f).compile(types)", set()),
        ("import builtins\nbuiltins.compile(text, '', 'exec')", {"compile"}),
    ],
)
def test_the_search_for_run_text_finds_it(source: str, caught: set[str]) -> None:
    assert calls_that_run_text(source) == caught
