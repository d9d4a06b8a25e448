"""Ctrl-C in the middle of a diagnosis, and on from its evidence."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from ptp_symbolic.cli.interruption import MESSAGE
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.workflows.diagnosis import recorded_in
from ptp_symbolic.workflows.stored_evidence import FILE, Header, keeper_of, read_evidence

SAMPLE = Path(__file__).parents[2] / "ptp_symbolic" / "samples" / "tilted_base"
HEADER = Header("1.0", "platform", {"train a.csv": "digest"}, {})


@recorded()
def double(value: float) -> float:
    """Something that is evaluated."""
    return 2.0 * value


def test_what_ends_a_diagnosis_early_leaves_its_evidence(tmp_path: Path) -> None:
    keeper = keeper_of(HEADER, None, tmp_path / "out")
    with pytest.raises(SystemExit), recorded_in(keeper):
        double(2.0)
        raise SystemExit(130)
    _, header, entries = read_evidence(tmp_path / "out")
    assert header == HEADER
    assert [entry.value for entry in entries.values()] == [4.0]
    resumed = keeper_of(HEADER, tmp_path / "out" / FILE, tmp_path / "out")
    with recorded_in(resumed):
        assert double(2.0) == 4.0
    assert not resumed.evidence.fresh


def diagnose(out: Path, *more: str) -> "subprocess.Popen[str]":
    """The command on the sample, under way."""
    words = ["diagnose", "--platform", str(SAMPLE / "platform.toml")]
    words += ["--train", str(SAMPLE / "train"), "--validate", str(SAMPLE / "validate")]
    return subprocess.Popen(
        [sys.executable, "-m", "ptp_symbolic", *words, "--out", str(out), *more],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def found_in(out: Path) -> dict[str, Any]:
    """The diagnosis, without the date of it."""
    found: dict[str, Any] = json.loads((out / "diagnosis.json").read_text("utf-8"))
    del found["provenance"]["date"], found["provenance"]["command"]
    return found


@pytest.mark.long
@pytest.mark.skipif(os.name != "posix", reason="signals are sent as POSIX does")
def test_an_interrupted_diagnosis_ends_as_one_that_was_not(tmp_path: Path) -> None:
    whole, part, on = (tmp_path / name for name in ("whole", "part", "on"))
    begun = time.monotonic()
    assert diagnose(whole).wait() == 0
    took = time.monotonic() - begun
    process = diagnose(part)
    time.sleep(random.uniform(0.3, 0.8) * took)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=30)
    assert process.returncode == 130 and said.endswith(MESSAGE)
    assert [file.name for file in part.iterdir()] == [FILE]
    assert diagnose(on, "--resume", str(part)).wait() == 0
    assert json.dumps(found_in(on)) == json.dumps(found_in(whole))
