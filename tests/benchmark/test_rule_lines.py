"""The lines that go with a rule, on modules small enough to count by hand."""

from pathlib import Path

import pytest

from ptp_symbolic.workflows.rules import RULES
from tests.benchmark import rule_lines
from tests.benchmark.rule_lines import read_engine

SOURCE = '''"""Decides."""

from engine.numeric.identify.tools import shared, single

LIMIT = 3


def decide(fit):
    return rule(fit) and fit.kept() and shared(fit)


def rule(fit):
    return single(fit) > LIMIT or fit.told()


class Fit:
    value = 1

    def kept(self):
        return shared(self)

    def told(self):
        return (
            self.value
        )
'''
TOOLS = '''"""Tools."""


def shared(fit):
    return 1


def single(fit):
    # counted with the function that it stands in
    return helper(fit)


def helper(fit):
    return 2
'''


@pytest.fixture
def engine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> rule_lines.Engine:
    """An engine of two modules, of which the rest of the package uses `decide` and `Fit`."""
    for name, text in {
        "__init__.py": "",
        "api.py": "from engine.numeric.diagnose.verdict import Fit, decide\n",
        "numeric/diagnose/verdict.py": SOURCE,
        "numeric/identify/tools.py": TOOLS,
    }.items():
        path = tmp_path / "engine" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    monkeypatch.setattr(rule_lines, "PACKAGE", tmp_path / "engine")
    return read_engine()


def test_a_rule_costs_what_nothing_else_uses(engine: rule_lines.Engine) -> None:
    every = engine.reached()
    left = engine.reached({("engine.numeric.diagnose.verdict", "rule")})
    gone = {name for _, name in every - left}
    assert gone == {"rule", "single", "helper", "LIMIT", "Fit.told"}
    assert engine.lines(every - left) == 2 + 3 + 2 + 1 + 4


def test_every_rule_of_the_package_is_found() -> None:
    engine = read_engine()
    every = engine.reached()
    for rule in RULES:
        for place in rule.where:
            module, _, name = place.partition(":")
            target = engine.imported.get((module, name), (module, name))
            assert target in every, place
