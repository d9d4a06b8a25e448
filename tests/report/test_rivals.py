"""What the page says of rivals without physics, and that it is silent where none was trained."""

from html import unescape

from ptp_symbolic.report.diagnosis import render_diagnosis
from tests.report.synthetic_diagnosis import synthetic_diagnosis


def model(rms: float, share: float, size: str | None = None) -> dict:
    figures = {"rms": rms, "share": share}
    return {"size": size, "train": figures, "validate": figures, "by_run": {"sweep": rms}}


RIVALS = {
    "about": "No model was fitted to the validation runs.",
    "half_width": 0.1,
    "axes": {
        "pan": {
            "unit": "N m",
            "models": {
                "declared": model(0.5, 0.0),
                "named": model(0.05, 0.99, "2 parameters"),
                "sparse": model(0.07, 0.9804, "8 of 29 terms"),
                "network": model(0.06, 0.9856, "5 x 1249 weights"),
            },
        }
    },
    "free": {"sparse": {"rmse": 0.003, "rmse_counts": 3.4375}, "network": None},
}


def test_every_model_has_its_torque_and_its_free_simulation() -> None:
    diagnosis = {**synthetic_diagnosis("explained"), "black_box": RIVALS}
    page = render_diagnosis(diagnosis, {})
    html = unescape(page[page.index('<section id="black-box">') :]).split("</section>")[0]
    for text in (
        RIVALS["about"],
        "98.0\N{NO-BREAK SPACE}%",
        "5 x 1249 weights",
        "sweep",
        "residual torque, rms [N m]",
        "rms error [counts]",
        '<th scope="row">with sparse regression</th><td class="n">3.44</td>',
        '<th scope="row">with a neural network</th><td class="n">–</td>',
    ):
        assert text in html
    error = diagnosis["error"]["validate"]["after"]["total"]["rmse_counts"]
    assert f'<th scope="row">with the named effect</th><td class="n">{error:.3g}' in html


def test_without_rivals_nothing_is_said_of_them() -> None:
    assert "black-box" not in render_diagnosis(synthetic_diagnosis("explained"), {})
