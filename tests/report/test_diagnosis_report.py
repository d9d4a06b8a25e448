"""The diagnosis page: every part is there for every verdict, with the numbers of the diagnosis."""

import base64
import hashlib
import math
import re
from html import unescape

import numpy as np
import pytest

from ptp_symbolic.report.diagnosis import VERDICTS, render_diagnosis, write_curves_csv
from ptp_symbolic.report.figures import BORDER, motion_figure
from ptp_symbolic.report.figures import FLOOR as FLOOR_COLOUR
from ptp_symbolic.report.quantities import number
from tests.report.synthetic_diagnosis import (
    ADDED,
    COUNT,
    EQUATION,
    REFUSED,
    RUNS,
    page,
    synthetic_curves,
    synthetic_diagnosis,
)


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_verdict_has_its_headline_errors_and_figures(verdict: str) -> None:
    html = page(verdict)
    diagnosis = synthetic_diagnosis(verdict)
    assert f'data-verdict="{verdict}"' in html
    for part in ("errors", "motion", "residuals", "ranking", "limits", "parameters", "tests"):
        assert f'<section id="{part}">' in html
    leaves_more = verdict in ("unexplained", "partly_explained")
    # one per run, one map per signal, and one of torques where more than noise is left
    assert html.count("<svg") == len(RUNS) + 2 + leaves_more
    assert ('id="torques"' in html) == leaves_more
    headline = re.search(r"<h1>(.*?)</h1>", html)
    assert headline is not None
    assert ("base that is not level" in headline[1]) == bool(diagnosis["added"])
    assert ('id="equations"' in html) == bool(diagnosis["added"])
    assert ('id="hints"' in html) == (verdict == "unexplained")
    assert ('id="closest"' in html) == (verdict == "unexplained")
    assert ("with the added effect" in html) == bool(diagnosis["added"])
    assert f"Error: {diagnosis['error']['definition']}." in html


def test_the_numbers_of_the_diagnosis_are_on_the_page() -> None:
    html = page("explained")
    for text in ("29.8", "0.292", "0.289", "0.08731", "0.08699 to 0.08763", "5.002°", "base_tilt"):
        assert text in html
    assert "at its bound" in html
    assert "not identified" in html
    assert "<math" in html
    assert r"\sin\beta" in html


def test_repeatability_is_told_where_runs_repeat() -> None:
    diagnosis = synthetic_diagnosis("partly_explained")
    signal = {"rmse": 0.00123, "unit": "rad", "rmse_counts": 1.41}
    diagnosis["repeatability"] = {"runs": [["a", "b"]], "by_signal": {"theta_pan": signal}}
    html = render_diagnosis(diagnosis, synthetic_curves(600))
    assert "(1 pair) spread about their mean by 1.41 counts rms of <code>theta_pan" in html
    assert "spread about their mean" not in page("partly_explained")


def test_torque_maps_say_their_share() -> None:
    html = page("unexplained")
    torques = html[html.index('<section id="torques">') : html.index('<section id="ranking">')]
    for text in ("62 % of the variance", "angle [deg]", "rate [deg/s]", "residual torque [N m]"):
        assert text in torques


def test_look_alikes_come_with_the_experiment_that_separates_them() -> None:
    html = page("explained_up_to_group")
    limits = html[html.index('<section id="limits">') : html.index('<section id="parameters">')]
    assert "<code>cable_spring</code>" in limits
    assert '<code>constant_torque</code> <span class="soft nowrap">(tilt axis)</span>' in limits
    assert "Sweep the pan axis over a full turn." in limits


def test_gains_are_in_percent_with_their_interval() -> None:
    html = page("explained")
    cards = html[: html.index("<nav")].replace("\u00a0", " ")
    assert "98.7 % (98.5 to 98.9 %), cross-validated on the training runs" in cards
    assert "on the validation runs falls by 97.5 % (97.1 to 97.9 %)" in cards
    table = html[html.index('<section id="ranking">') : html.index('<section id="limits">')]
    table = table.replace("\u00a0", " ")
    assert "92.0 % (91.8 to 92.2 %)" in table
    assert "−0.2 % (−0.4 to 0.0 %)" in table
    assert '<td class="gain">–</td>' in table  # a fit without derivatives has no gain


def test_the_closest_fit_is_shown_with_its_figures_where_nothing_was_confirmed() -> None:
    html = page("unexplained")
    card = html[html.index('id="closest"') : html.index("<nav")].replace("\u00a0", " ")
    for text in ("base_tilt", "not confirmed", "0.08731", "5.002°", "29.8 counts rms"):
        assert text in card
    assert "98.7 % (98.5 to 98.9 %)" in card
    diagnosis = synthetic_diagnosis("unexplained")
    of_shaft = {**diagnosis["ranking"][0], "effect": "shaft_compliance", "structure": ["shaft"]}
    listed = {**diagnosis, "ranking": [of_shaft, *diagnosis["ranking"]]}
    page_of_both = render_diagnosis(listed, {})
    assert "base_tilt" in page_of_both[page_of_both.index('id="closest"') :][:400]
    diagnosis["ranking"] = [row for row in diagnosis["ranking"] if row["effect"] == "backlash"]
    assert 'id="closest"' not in render_diagnosis(diagnosis, {})


def test_what_was_refused_is_listed_with_its_reason() -> None:
    html = page("explained")
    part = html[html.index('<section id="refused">') : html.index('<section id="ranking">')]
    assert "Improved the fit, but rejected" in part
    for key, why in REFUSED.items():
        effect, _, axis = key.partition("@")
        named = f"<code>{effect}</code>" + (
            f' <span class="soft nowrap">({axis} axis)</span>' if axis else ""
        )
        assert f'{named}</th><td class="why">{why}</td>' in part
    assert 'id="refused"' not in page("nothing_missing")


def test_errors_without_an_encoder_are_in_rad_and_every_signal_is_in_its_own_unit() -> None:
    html = page("explained")
    signals = html[html.index('<table id="signals">') : html.index('<section id="equations">')]
    current = '<code>i_pan</code></th><td class="unit">A</td><td class="n">0.408</td>'
    assert current in signals
    angle = '<code>theta_pan</code></th><td class="unit">counts</td><td class="n">29.8</td>'
    assert angle in signals
    diagnosis = synthetic_diagnosis("explained")
    for part in ("train", "validate"):
        for stage in diagnosis["error"][part].values():
            for error in (stage["total"], *stage["by_run"].values(), *stage["by_signal"].values()):
                error["rmse_counts"] = None
    html = render_diagnosis(diagnosis, synthetic_curves(200))
    assert "rms error [rad]" in html
    assert f"<b>{number(29.8 * COUNT)}</b>" in html
    assert "counts rms" not in html


def test_every_rule_stands_with_its_number_and_its_limit() -> None:
    html = unescape(page("explained"))
    part = html[html.index('<section id="why">') : html.index('<section id="refused">')]
    rows = [re.sub(r"<[^>]+>", "|", row) for row in part.split("<tr>")[2:]]
    assert all(word in rows[0] for word in ("base_tilt", "0.971", "\u2265 0.5", "|yes|"))
    assert all(word in rows[1] for word in ("the model", "1.37", "\u2264 1.1", "|no|"))
    assert 'id="why"' not in page("nothing_missing")


def test_remarks_on_the_logs_stand_with_what_they_cannot_tell() -> None:
    diagnosis = synthetic_diagnosis("nothing_missing")
    diagnosis["remarks"] = ["'pan_angle' never moves: nothing can be identified of that axis."]
    html = unescape(render_diagnosis(diagnosis, {}))
    assert diagnosis["remarks"][0] in html[html.index('<section id="limits">') :]


def test_two_effects_are_both_in_the_headline() -> None:
    diagnosis = synthetic_diagnosis("explained")
    diagnosis["added"].append({**ADDED, "effect": "cable_spring", "title": "cable spring"})
    html = render_diagnosis(diagnosis, {})
    assert "<h1>Missing effects found: base that is not level and cable spring</h1>" in html


def test_candidates_are_ordered_by_training_error_and_those_not_fitted_come_last() -> None:
    html = page("explained")
    table = html[html.index('<section id="ranking">') : html.index('<section id="limits">')]
    table = table.replace("\u00a0", " ")
    shown, folded = table.split("<details>")
    order = re.findall(r'<th scope="row"><code>(\w+)</code>', shown)
    assert order[:3] == ["base_tilt", "cable_spring", "constant_torque"]
    assert order[-1] == "viscous_friction"
    assert "backlash" not in order
    assert "backlash" in folded
    assert "1 candidate that was not simulated" in folded
    assert "0.3000 N m/rad" in shown
    assert "on the training runs" in shown
    assert "validation" not in table


def test_values_that_are_declared_wrong_have_a_heading_of_their_own() -> None:
    diagnosis = synthetic_diagnosis("explained")
    title = "declared value of J_pan is wrong by -0.007 % (inertia)"
    diagnosis["added"] = [{**ADDED, "effect": "declared_value:J_pan", "title": title}]
    html = render_diagnosis(diagnosis, {})
    assert "<h1>Declared value of J_pan is wrong by -0.007 % (inertia)</h1>" in html


def test_windows_are_marked_in_the_figures_and_their_length_is_in_the_captions() -> None:
    curves = synthetic_curves(samples=400)
    assert "start of a window" not in render_diagnosis(synthetic_diagnosis("explained"), curves)
    without = {run: motion_figure(curve, {}, 300) for run, curve in curves.items()}
    for curve in curves.values():
        curve["borders"] = [float(t) for t in np.linspace(*curve["time"][[0, -1]], 11)[1:-1]]
    html = render_diagnosis(synthetic_diagnosis("explained"), curves)
    length = float(np.ptp(curves["step"]["time"])) / 10.0
    assert f"restarts every {number(length, 2)} s" in html
    assert html.count(f"windows of {number(length, 2)} s") >= len(curves)
    for run, curve in curves.items():
        panels = without[run].count(f"stroke: {BORDER}")
        assert panels == 0
        assert motion_figure(curve, {}, 300).count(f"stroke: {BORDER}") == 6


def test_the_band_of_the_noise_floor_is_that_of_every_signal() -> None:
    curve = synthetic_curves(samples=200)["step"]
    bands = [
        motion_figure(curve, floors, 300).count(f"fill: {FLOOR_COLOUR}")
        for floors in ({}, {"i_pan": 0.004}, {"i_pan": 0.004, "theta_pan": 0.29})
    ]
    assert bands == [0, 2, 4]  # residuals of both models, and that of the final one enlarged


def test_the_windows_of_the_training_runs_are_counted() -> None:
    diagnosis = synthetic_diagnosis("explained")
    diagnosis["windows"] = {"count": 24, "seconds": 1.25}
    assert "cut into 24 windows of 1.2 s" in render_diagnosis(diagnosis, {})
    assert "windows of" not in page("explained")


def test_errors_stand_beside_the_windows_that_they_were_taken_over() -> None:
    diagnosis = synthetic_diagnosis("explained")
    for part, seconds in (("train", 10.0), ("validate", 1.5)):
        for stage in ("before", "after", "noise_floor"):
            diagnosis["error"][part][stage]["windows"] = {"count": 12, "seconds": seconds}
    html = render_diagnosis(diagnosis, {})
    assert "Training runs: used for the fit, errors over 12 windows of 10 s" in html
    assert "Validation runs: never fitted, errors over 12 windows of 1.5 s" in html


def test_the_share_that_earns_a_name_is_stated() -> None:
    assert "an effect needs 5 % at least" in page("explained")


def test_every_parameter_has_its_meaning_and_a_search_from_several_starts_a_dash() -> None:
    html = page("explained")
    rows = html[html.index('<section id="parameters">') : html.index('<section id="tests">')]
    assert "inertia of the pan body" in rows
    added = re.search(r'<code>beta_base</code></th>.*?class="n">(.*?)</td>', rows, re.DOTALL)
    assert added is not None
    assert added[1] == "–"


def test_sentences_are_whole() -> None:
    for html in map(page, VERDICTS):
        assert "free simulation that" not in html
        assert "after alone" not in html
        assert "colour an output error" not in html


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
    (script,) = re.findall(r"<script>(.*?)</script>", html, flags=re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}'" in html
    assert all(
        target.startswith("#") or target == "data:,"
        for target in re.findall(r'(?:href|src)="([^"]*)"', html)
    )


def test_text_from_files_is_escaped_and_mathml_that_is_more_than_a_formula_is_left_out() -> None:
    diagnosis = synthetic_diagnosis("explained")
    evil = "<img src=x onerror=alert(1)>"
    diagnosis["platform"]["title"] = evil
    diagnosis["summary"] = evil
    diagnosis["hints"] = [evil]
    diagnosis["refused"] = {f"{evil}@pan": evil}
    diagnosis["error"]["definition"] = evil
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


def test_long_logs_stay_below_one_and_a_half_megabytes() -> None:
    curves = synthetic_curves(samples=4000)
    many = {f"{run}-{k}": curve for run, curve in curves.items() for k in range(3)}
    html = render_diagnosis(synthetic_diagnosis("explained"), many)
    assert len(html.encode()) < 1_500_000


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
