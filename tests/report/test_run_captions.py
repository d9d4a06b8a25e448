"""Captions of the figures of runs."""

import re
from typing import Any

from ptp_symbolic.report.diagnosis import render_diagnosis
from tests.report.synthetic_diagnosis import synthetic_curves, synthetic_diagnosis


def test_a_run_whose_name_both_parts_have_is_shown_with_its_error() -> None:
    curves = synthetic_curves(samples=200)
    run, curve = next((r, c) for r, c in curves.items() if c["set"] == "validate")
    plain = page_of(curves)
    renamed = {f"{r} (validate)" if r == run else r: c for r, c in curves.items()}
    assert f"<b>{run} (validate)</b>" in page_of(renamed)
    renamed[f"{run} (validate)"] = {**curve, "run": run}
    assert captions(page_of(renamed)) == captions(plain)


def page_of(curves: dict[str, Any]) -> str:
    return render_diagnosis(synthetic_diagnosis("explained"), curves)


def captions(html: str) -> list[str]:
    return sorted(re.findall(r"<figcaption>.*?</figcaption>", html, re.DOTALL))
