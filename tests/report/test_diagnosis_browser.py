"""The diagnosis page in a browser: it has nothing to complain of, and all fits into its box."""

import json
import re
import shutil
import subprocess
from html import escape, unescape
from pathlib import Path

import pytest

from ptp_symbolic.report.diagnosis import render_diagnosis
from tests.report.synthetic_diagnosis import RUNS, page, synthetic_diagnosis

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
UNSEEN = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage")


@pytest.fixture(scope="module")
def browser() -> str:
    for name in BROWSERS:
        if path := shutil.which(name):
            return path
    pytest.skip(f"no browser on PATH (looked for {', '.join(BROWSERS)})")


def opened(file: Path, browser: str, *options: str) -> subprocess.CompletedProcess[str]:
    """The document that the browser makes of `file`, and on stderr what it complains of."""
    profile = f"--user-data-dir={file.with_name('profile')}"
    command = [browser, *UNSEEN, profile, *options, "--dump-dom", file.as_uri()]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)


@pytest.mark.parametrize("verdict", ["explained", "nothing_missing"])
def test_a_browser_shows_every_part_and_reports_no_error(
    verdict: str, browser: str, tmp_path: Path
) -> None:
    file = tmp_path / "report.html"
    file.write_text(page(verdict), encoding="utf-8")
    shown = opened(file, browser, "--enable-logging=stderr", "--v=0")
    assert "CONSOLE" not in shown.stderr, shown.stderr
    assert "</footer>" in shown.stdout
    for part in ("verdict", "errors", "motion", "residuals", "ranking", "limits", "parameters"):
        assert f'id="{part}"' in shown.stdout
    assert shown.stdout.count("<svg") == len(RUNS) + 2
    # the parser moves nothing out of place: table cells stay in tables, figures in their section
    assert shown.stdout.count("<tr") == page(verdict).count("<tr")


MEASURE = """<script>addEventListener('load', () => {
  const wide = (e) => e.scrollWidth > e.clientWidth + 1 || e.getBoundingClientRect().right > WIDTH;
  const bad = [...document.querySelectorAll('SELECTOR')].filter(wide).map((e) => e.className);
  parent.document.body.dataset.result = JSON.stringify([innerWidth, bad]);
});</script>"""


def too_wide(html: str, width: int, selector: str, browser: str, folder: Path) -> list[str]:
    """Classes of what does not fit into its box or into a page of `width` pixels."""
    html = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", html)
    script = MEASURE.replace("SELECTOR", selector).replace("WIDTH", str(width))
    inner = escape(html.replace("</head>", f"{script}</head>"), quote=True)
    frame = f'<body><iframe style="border:0;width:{width}px;height:900px" srcdoc="{inner}">'
    file = folder / "frame.html"
    file.write_text(f"<!DOCTYPE html>{frame}", encoding="utf-8")
    shown = opened(file, browser, "--virtual-time-budget=5000")
    found = re.search(r'data-result="([^"]*)"', shown.stdout)
    assert found is not None
    real_width, bad = json.loads(unescape(found[1]))
    assert real_width == width
    return bad


def test_on_a_telephone_the_cards_fit(browser: str, tmp_path: Path) -> None:
    assert too_wide(page("explained"), 420, ".card, .card table", browser, tmp_path) == []


def many_values() -> str:
    """A page on which every candidate has nine fitted values and a reason of two lines."""
    diagnosis = dict(synthetic_diagnosis("explained"))
    values = {f"F_some_parameter_{k}_pan": 0.3 * k + 1e-3 for k in range(9)}
    why = "explains more than noise, and so does the set that was chosen, with fewer parameters"
    diagnosis["ranking"] = [
        {**row, "parameters": row["parameters"] if row["accepted"] else values, "why": why}
        for row in diagnosis["ranking"]
    ]
    return render_diagnosis(diagnosis, {})


@pytest.mark.parametrize("width", [390, 1400])
def test_no_column_of_the_candidates_is_clipped(width: int, browser: str, tmp_path: Path) -> None:
    selector = ".wide, .wide table, .wide td, .wide th"
    assert too_wide(many_values(), width, selector, browser, tmp_path) == []


def test_in_print_nothing_is_wider_than_the_page(browser: str, tmp_path: Path) -> None:
    html = page("explained").replace("@media print", "@media all")
    selector = ".wide, .wide table, .formula, figure svg, .card, pre"
    assert too_wide(html, 703, selector, browser, tmp_path) == []
