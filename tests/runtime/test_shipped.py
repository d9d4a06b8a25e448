"""Compiled functions that come with an installation: taken where they fit, else passed over."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from ptp_symbolic.numeric.runtime import shipped

# An input that is constant from the first of its pieces on: the function writes its value.
CALL = """
import json, sys
from pathlib import Path
from ptp_symbolic.numeric.runtime import shipped
shipped.FOLDER = Path(sys.argv[1])
import numpy as np
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.inputs import constant, stack
given = stack([constant(0.25)])
u = np.zeros(1)
evaluate_inputs(0.5, 1, *given.arrays, given.new_cursor(), u)
hits = sum(evaluate_inputs.stats.cache_hits.values())
print(json.dumps({"value": u[0], "found": hits}))
"""


def call(shipped_in: Path, scratch: Path, **variables: str) -> dict[str, float]:
    """What a new process with an empty cache computes, and whether it found compiled code."""
    scratch.mkdir()
    environment = os.environ | {"NUMBA_CACHE_DIR": str(scratch)} | variables
    command = [sys.executable, "-c", CALL, str(shipped_in)]
    ran = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(ran.stdout)
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a build for the baseline wrote."""
    target = shipped.baseline()
    if target is None:
        pytest.skip("nothing is compiled ahead for this kind of machine")
    made = tmp_path_factory.mktemp("made")
    variables = {
        shipped.WRITE_INTO: str(made),
        "NUMBA_CPU_NAME": target.cpu,
        "NUMBA_CPU_FEATURES": "",
    }
    scratch = tmp_path_factory.mktemp("scratch") / "numba"
    assert call(made, scratch, **variables) == {"value": 0.25, "found": 0}
    return made


def test_what_was_compiled_ahead_runs_where_the_cache_is_empty(
    folder: Path, tmp_path: Path
) -> None:
    assert call(folder, tmp_path / "numba") == {"value": 0.25, "found": 1}
    assert not list((tmp_path / "numba").rglob("*.nbc"))


def test_a_damaged_file_is_passed_over(folder: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    broken.mkdir()
    for path in folder.iterdir():
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        (broken / path.name).write_bytes(content)
    assert call(broken, tmp_path / "numba") == {"value": 0.25, "found": 0}


def test_a_processor_that_lacks_what_the_code_uses_gets_none(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lacking = shipped.Baseline("x", frozenset({"an-instruction-that-no-processor-has"}))
    known = dict.fromkeys(shipped.BASELINES, lacking)
    monkeypatch.setattr(shipped, "FOLDER", folder)
    shipped.fits.cache_clear()
    assert shipped.fits()
    monkeypatch.setattr(shipped, "BASELINES", known)
    shipped.fits.cache_clear()
    assert not shipped.fits()
    shipped.fits.cache_clear()


def test_the_name_changes_with_the_sources(monkeypatch: pytest.MonkeyPatch) -> None:
    own = shipped.name_of(call, "signature", "code")
    assert own == shipped.name_of(call, "signature", "code")
    monkeypatch.setattr(shipped, "_surroundings", lambda: ("other sources",))
    assert own != shipped.name_of(call, "signature", "code")
