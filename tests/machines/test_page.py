"""The page of real machines: what was accepted, what was rejected and with which figures."""

from typing import Any

from ptp_symbolic.report.machines import render_machines

RANKING = [
    {
        "effect": "backlash",
        "gain": {"share": 0.8, "ci95": [0.7, 0.9]},
        "accepted": True,
        "why": "",
    },
    {
        "effect": "cogging",
        "gain": {"share": 0.31, "ci95": [0.1, 0.5]},
        "accepted": False,
        "why": "its amount is not significantly different from zero",
    },
    {
        "effect": "cable_spring",
        "gain": None,
        "gain_along_motion": {"share": 0.123, "ci95": [0.1, 0.2]},
        "accepted": False,
        "why": "compared in rows",
    },
]


def machine() -> dict[str, Any]:
    total = {"total": {"rmse_counts": 12.5, "rmse": 1e-3, "unit": "rad"}}
    log = {"part": "validate", "file": "held_out.csv", "samples": 400, "rate": 200.0}
    return {
        "title": "A servo",
        "source": "A laboratory, 2020",
        "verdict": "explained",
        "summary": "Missing: backlash",
        "error": {p: dict.fromkeys(("before", "after", "noise_floor"), total) for p in PARTS},
        "ranking": RANKING,
        "position_error": [{"stage": "before", "train": 0.143, "validate": 0.157}],
        "fit": {"after": {"parameters": {}}},
        "refused": {},
        "hints": [],
        "provenance": {"logs": [{**log, "sha256": "0f3e"}]},
    }


PARTS = ("train", "validate")


def shown(machines: list[dict]) -> str:
    """The page of some machines, with plain spaces before its signs of percent."""
    page = render_machines({"version": "1", "date": "today", "machines": machines})
    return page.replace("\u00a0", " ")


def test_candidates_errors_and_files_of_a_machine_are_on_its_page() -> None:
    page = shown([machine()])
    assert "80.0 % (70.0 to 90.0 %)" in page and "accepted" in page
    assert (
        "31.0 % (10.0 to 50.0 %)" in page
        and "its amount is not significantly different from zero" in page
    )
    assert "of each alone): cable_spring (12.3 %)." in page
    assert "training 143, validation 157" in page
    assert "held_out.csv" in page and "0f3e" in page


def test_a_set_that_grew_along_the_motion_is_accepted_with_what_its_members_gain_there() -> None:
    grown = {"effect": "backlash + cogging", "gain": None, "accepted": True, "why": ""}
    members = [
        {"effect": effect, "gain": {"share": share, "ci95": [0.5 * share, 1.5 * share]}}
        for effect, share in (("backlash", 0.6), ("cogging", 0.2))
    ]
    one = {**machine(), "ranking": [grown], "added": members}
    page = shown([one])
    assert "accepted by the torque along the measured motion" in page
    assert "backlash 60.0 % (30.0 to 90.0 %), cogging 20.0 % (10.0 to 30.0 %)" in page


def test_a_force_put_in_is_on_the_page_with_what_was_found_of_it() -> None:
    total = {"total": {"rmse_counts": None, "rmse": 2.5e-4, "unit": "m"}}
    row = {
        "title": "cogging every 20 mm",
        "effect": "cogging",
        "named": ["cogging", "input_delay"],
        "size": {"unit": "N", "put_in": 0.8485, "found": 0.8312},
        "wave": {"unit": "rad/m", "put_in": 314.16, "found": 314.05},
        "error": {"validate": dict.fromkeys(("before", "after"), total)},
    }
    missed = {**row, "title": "a spring", "named": [], "wave": None}
    missed["size"] = {**row["size"], "found": None}
    put_in = {"title": "Forces", "source": "", "put_in": [row, missed]}
    page = shown([put_in])
    assert "<b>cogging</b>, input_delay" in page
    assert "0.849 N" in page and "0.831" in page and "314.2" in page
    assert "not named" in page and "0.000250 m" in page
