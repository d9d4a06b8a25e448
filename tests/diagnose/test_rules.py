"""The rules of a diagnosis, switched off one by one."""

from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import gain, verdict
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.confirm import why_unconfirmed
from ptp_symbolic.numeric.diagnose.gain import Gain
from ptp_symbolic.numeric.diagnose.stepwise import is_earned
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.workflows import preparation
from ptp_symbolic.workflows.rules import RULES, Rule, switched_off, table
from tests.identify.straight import finished

BY_NAME = {rule.name: rule for rule in RULES}


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_a_rule_is_off_meanwhile_and_on_again_after_an_error(rule: Rule) -> None:
    before = [vars(owner)[name] for owner, name in rule.targets()]
    with pytest.raises(ZeroDivisionError), switched_off(rule):
        for owner, name in rule.targets():
            assert vars(owner)[name] is rule.off
        raise ZeroDivisionError
    assert [vars(owner)[name] for owner, name in rule.targets()] == before


def test_names_are_unique_and_the_page_of_rules_has_the_table(checkout: Path) -> None:
    assert len(BY_NAME) == len(RULES)
    page = (checkout / "docs/development/rules.md").read_text(encoding="utf-8")
    assert table() in page, f"docs/development/rules.md has another table; this is it:\n{table()}"


def test_an_effect_at_its_bound_is_named_without_that_rule() -> None:
    """Two runs ask for a spring of 1, which may be 1 at most, far above their noise."""
    spring = free_parameter("k", 0.5, 0.0, 1.0)
    effect = Candidate("spring", None, "", "", (spring,), {"k": 0.0})
    rng, wave = np.random.default_rng(5), np.sin(0.1 * np.arange(300))
    residuals = [0.01 * rng.standard_normal(300) for _ in range(2)]
    slopes = [-wave[:, None] * spring.scale] * 2
    fit = finished(residuals, slopes, None, (spring,), {"k": 1.0})
    assert why_unconfirmed(fit, effect, leaves_noise=True) == "k ends at its bound"
    with switched_off(BY_NAME["bounds"]):
        assert why_unconfirmed(fit, effect, leaves_noise=True) is None


def test_what_validation_runs_deny_is_borne_out_without_that_rule() -> None:
    worse = Gain(-0.5, -0.6, -0.4, -10.0, 20)
    assert not verdict.is_validated(worse, True, False, 0.1)
    with switched_off(BY_NAME["validated"]):
        assert verdict.is_validated(worse, True, False, 0.1)


def test_chance_alone_earns_a_place_without_significance() -> None:
    """A t statistic of 1 with 20 degrees of freedom has a one-sided chance of 16 %."""
    weak = Gain(0.2, 0.01, 0.4, 1.0, 20, 0.16)
    assert not is_earned(weak, 0.16, 1, 0.1)
    with switched_off(BY_NAME["significant"]):
        assert is_earned(weak, 0.16, 1, 0.1)
    assert not is_earned(weak, 0.16, 1, 0.1)


def test_a_rule_decides_with_another_value() -> None:
    """A function of it in place of a function, a number in place of a number; both come back."""
    usual, alike = preparation.material_of, gain.UNALIKE
    material, windows = (BY_NAME[name].at(0.05) for name in ("material", "windows alike"))
    with switched_off(material), switched_off(windows):
        assert preparation.material_of(cast(Any, None)) == gain.UNALIKE == 0.05
    assert preparation.material_of is usual and alike == gain.UNALIKE
