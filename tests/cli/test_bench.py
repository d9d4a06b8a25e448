"""`ptp-symbolic bench`: SciPy and the simulation agree on what they are timed with."""

import json
import time
from pathlib import Path

import pytest

from ptp_symbolic.api.machine import load
from ptp_symbolic.api.scipy_peer import beyond_scipy
from tests.cli.conftest import Call


def test_the_table_and_the_file_say_the_same_and_scipy_finds_the_same_motion(
    call: Call, tmp_path: Path
) -> None:
    begun = time.perf_counter()
    done = call(
        *("bench", "--platform", "thesis-payload", "--input", "tau_pan=step:0.1@0.5"),
        *("--duration", 1, "--quick", "--out", tmp_path),
    )
    elapsed = time.perf_counter() - begun
    assert done.code == 0, done
    found = json.loads((tmp_path / "bench.json").read_text())
    assert found["computer"]["cores"] >= 1 and found["given"] == ["tau_pan=step:0.1@0.5"]
    timings = found["timings"]
    for timing in timings:
        assert timing["what"] in done.out and timing["value"] > 0.0
    beside = [each for each in timings if each["peer"] == "SciPy DOP853"]
    assert len(beside) == 2
    for each, tolerance in zip(beside, (1e-6, 1e-9), strict=True):
        assert each["error"] < 30.0 * tolerance and each["peer_error"] < 30.0 * tolerance
        assert each["ratio"] == pytest.approx(each["peer_value"] / each["value"])
        assert 1e-3 * (each["value"] + each["peer_value"]) < elapsed


def test_a_machine_that_scipy_cannot_run_says_why() -> None:
    assert beyond_scipy(load("thesis-pan-servo")) == "a sampled controller"
    assert beyond_scipy(load("pan_drive")) is None


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("--platform", "thesis-paylod"), "thesis-payload"),
        (("--platform", "thesis-payload", "--duration", -1), "-1 s; give a positive number"),
        (("--platform", "thesis-payload", "--input", "tau_pam=step:1@0"), "tau_pan"),
    ],
)
def test_what_cannot_be_timed_is_one_line(
    call: Call, given: tuple[object, ...], said: str, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    done = call("bench", *given, "--out", out)
    assert done.code == 2 and said in done.err and done.err.count("\n") == 1
    assert not out.exists()
