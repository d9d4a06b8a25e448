"""The diagnosis page: every part is there for every verdict, and a browser has nothing to say."""

import math
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.report.diagnosis import VERDICTS, render_diagnosis, write_curves_csv
from tests.report.synthetic_diagnosis import (
    ADDED,
    COUNT,
    EQUATION,
    RUNS,
    synthetic_curves,
    synthetic_diagnosis,
)

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


@cache
def page(verdict: str, samples: int = 600, current: bool = True) -> str:
    diagnosis = synthetic_diagnosis(verdict)
    drift = 0.0 if verdict == "nothing_missing" else 40.0
    curves = synthetic_curves(samples, bool(diagnosis["added"]), current, drift)
    return render_diagnosis(diagnosis, curves)


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_verdict_has_its_headline_errors_and_figures(verdict: str) -> None:
    html = page(verdict)
    diagnosis = synthetic_diagnosis(verdict)
    assert f'data-verdict="{verdict}"' in html
    for part in ("errors", "motion", "residuals", "ranking", "limits", "parameters", "tests"):
        assert f'<section id="{part}">' in html
    assert html.count("<svg") == len(RUNS) + 2  # one per run and one map per signal
    headline = re.search(r"<h1>(.*?)</h1>", html)
    assert headline is not None
    assert ("base that is not level" in headline[1]) == bool(diagnosis["added"])
    assert ('id="equations"' in html) == bool(diagnosis["added"])
    assert ('id="hints"' in html) == (verdict == "unexplained")


def test_the_numbers_of_the_diagnosis_are_on_the_page() -> None:
    html = page("explained")
    for text in ("29.8", "0.292", "0.289", "0.08731", "0.08699 to 0.08763", "5.002°", "base_tilt"):
        assert text in html
    assert "at its bound" in html
    assert "not identified" in html
    assert "<math" in html
    assert r"\sin\beta" in html


def test_look_alikes_come_with_the_experiment_that_separates_them() -> None:
    html = page("explained_up_to_group")
    limits = html[html.index('<section id="limits">') : html.index('<section id="parameters">')]
    assert "constant_torque" in limits
    assert "Sweep the pan axis over a full turn." in limits


def test_two_effects_are_both_in_the_headline() -> None:
    diagnosis = synthetic_diagnosis("explained")
    diagnosis["added"].append({**ADDED, "effect": "cable_spring", "title": "cable spring"})
    html = render_diagnosis(diagnosis, {})
    assert "<h1>Missing effects found: base that is not level and cable spring</h1>" in html


def test_candidates_are_ordered_by_validation_error_and_failures_come_last() -> None:
    html = page("explained")
    table = html[html.index('<section id="ranking">') : html.index('<section id="limits">')]
    order = re.findall(r'<th scope="row"><code>(\w+)</code>', table)
    assert order[:2] == ["base_tilt", "cable_spring"]
    assert order[-1] == "backlash"


def test_only_the_required_keys_are_needed() -> None:
    for verdict in VERDICTS:
        full = synthetic_diagnosis(verdict)
        least = {key: full[key] for key in ("verdict", "error", "ranking", "added")}
        html = render_diagnosis(least, {})
        assert 'id="errors"' in html
        assert 'id="motion"' not in html
    assert 'id="verdict"' in render_diagnosis(
        {"verdict": "unexplained", "error": {}, "ranking": [], "added": []}, {}
    )


def test_the_page_loads_nothing_and_two_renderings_are_the_same_bytes() -> None:
    html = page("explained")
    again = render_diagnosis(synthetic_diagnosis("explained"), synthetic_curves(600))
    assert html == again
    without_names = re.sub(r'xmlns(:\w+)?="[^"]*"', "", html)
    assert "://" not in without_names
    assert "<script" not in html
    assert all(target.startswith("#") or target == "data:," for target in
               re.findall(r'(?:href|src)="([^"]*)"', html))  # fmt: skip


def test_text_from_files_is_escaped_and_mathml_that_is_more_than_a_formula_is_left_out() -> None:
    diagnosis = synthetic_diagnosis("explained")
    evil = "<img src=x onerror=alert(1)>"
    diagnosis["platform"]["title"] = evil
    diagnosis["summary"] = evil
    diagnosis["hints"] = [evil]
    diagnosis["equations"] = [{**EQUATION, "mathml": f"<mi>x</mi>{evil}", "latex": evil}]
    curves = synthetic_curves(samples=50)
    curves[evil] = curves.pop("step")
    html = render_diagnosis(diagnosis, curves)
    assert "<img" not in html
    assert "<math" not in html
    assert EQUATION["text"] in html


def test_a_failed_simulation_leaves_a_gap_instead_of_an_error() -> None:
    curves = synthetic_curves(samples=300)
    curves["step"]["signals"]["theta_pan"]["before"][100:] = np.nan
    curves["sweep"]["signals"]["theta_pan"]["before"][:] = np.nan
    diagnosis = synthetic_diagnosis("explained")
    diagnosis["error"]["validate"]["before"]["total"]["rmse_counts"] = math.nan
    assert render_diagnosis(diagnosis, curves).count("<svg") == len(RUNS) + 2


def test_long_logs_stay_below_three_megabytes() -> None:
    curves = synthetic_curves(samples=4000)
    many = {f"{run}-{k}": curve for run, curve in curves.items() for k in range(3)}
    html = render_diagnosis(synthetic_diagnosis("explained"), many)
    assert len(html.encode()) < 3_000_000


def test_every_plotted_curve_is_written_as_csv() -> None:
    curves = synthetic_curves(samples=40)
    curves["../evil name"] = curves["step"]
    texts = write_curves_csv(curves)
    assert set(texts) >= {"train-ramp.csv", "validate-step.csv", "validate-.._evil_name.csv"}
    lines = texts["validate-step.csv"].splitlines()
    header = lines[0].split(",")
    values = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    signal = curves["step"]["signals"]["theta_pan"]
    assert header[:3] == ["time [s]", "angle_pan [rad]", "rate_pan [rad/s]"]
    assert np.array_equal(values[:, header.index("theta_pan_before [rad]")], signal["before"])
    np.testing.assert_allclose(
        values[:, header.index("theta_pan_residual_after [counts]")] * COUNT,
        signal["measured"] - signal["after"],
        atol=1e-15,
    )


@pytest.fixture(scope="module")
def browser() -> str:
    for name in BROWSERS:
        if path := shutil.which(name):
            return path
    pytest.skip(f"no browser on PATH (looked for {', '.join(BROWSERS)})")


@pytest.mark.parametrize("verdict", ["explained", "nothing_missing"])
def test_a_browser_shows_every_part_and_reports_no_error(
    verdict: str, browser: str, tmp_path: Path
) -> None:
    file = tmp_path / "report.html"
    file.write_text(page(verdict), encoding="utf-8")
    command = [
        browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
        f"--user-data-dir={tmp_path / 'profile'}", "--enable-logging=stderr", "--v=0",
        "--dump-dom", file.as_uri(),
    ]  # fmt: skip
    shown = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert "CONSOLE" not in shown.stderr, shown.stderr
    assert "</footer>" in shown.stdout
    for part in ("verdict", "errors", "motion", "residuals", "ranking", "limits", "parameters"):
        assert f'id="{part}"' in shown.stdout
    assert shown.stdout.count("<svg") == len(RUNS) + 2
    # the parser moves nothing out of place: table cells stay in tables, figures in their section
    assert shown.stdout.count("<tr") == page(verdict).count("<tr")
