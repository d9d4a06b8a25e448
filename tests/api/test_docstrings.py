"""Everything public says what it is, with an example that runs."""

import doctest
import inspect
from pathlib import Path

import pytest

import ptp_symbolic as ptp

PUBLIC = [name for name in ptp.__all__ if not name.startswith("_")]
FUNCTIONS = [name for name in PUBLIC if inspect.isfunction(getattr(ptp, name))]
METHODS = (
    "rhs",
    "jacobian",
    "mass_matrix",
    "gravity_torque",
    "inverse_dynamics",
    "linearize",
    "simulate",
)


def test_the_public_names_are_those_that_type_checkers_see(checkout: Path) -> None:
    stub = (checkout / "ptp_symbolic" / "__init__.pyi").read_text(encoding="utf-8")
    for name in PUBLIC:
        assert f" import {name} as {name}\n" in stub


def test_importing_lists_the_public_names_and_nothing_else() -> None:
    assert sorted(dir(ptp)) == sorted(ptp.__all__)
    for name in ptp.__all__:
        assert getattr(ptp, name) is not None


@pytest.mark.parametrize("name", PUBLIC)
def test_every_public_name_has_a_docstring(name: str) -> None:
    thing = getattr(ptp, name)
    assert inspect.getdoc(thing)
    if inspect.isclass(thing):
        fields = getattr(thing, "__dataclass_fields__", {})
        members = [(n, m) for n, m in vars(thing).items() if n not in fields]
        bare = [
            n
            for n, member in members
            if not n.startswith("_") and callable(member) and not inspect.getdoc(member)
        ]
        assert bare == []


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_says_what_it_raises_and_shows_an_example(name: str) -> None:
    text = inspect.getdoc(getattr(ptp, name)) or ""
    assert "Raises" in text
    assert ">>> " in text


@pytest.mark.parametrize("name", METHODS)
def test_every_method_of_a_machine_shows_an_example(name: str) -> None:
    assert ">>> " in (inspect.getdoc(getattr(ptp.Machine, name)) or "")


@pytest.mark.parametrize("name", PUBLIC)
def test_examples_give_what_they_show(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL
    runner = doctest.DocTestRunner(optionflags=flags)
    thing = getattr(ptp, name)
    for test in doctest.DocTestFinder(exclude_empty=True).find(thing, name, module=False):
        runner.run(test)
    assert runner.summarize(verbose=False).failed == 0
