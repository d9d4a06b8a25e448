"""The sources of the pages: kept outputs, examples, and what is said of every effect."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from ptp_symbolic.symbolic.effects import PACKAGED

LARGEST = 400_000  # bytes of a kept notebook


def test_kept_outputs_belong_to_the_tutorials_as_they_are(
    docs: Path, kept_outputs: ModuleType
) -> None:
    sources = kept_outputs.tutorials(docs)
    assert len(sources) == 9
    assert [path.name for path in sources if kept_outputs.is_stale(path)] == []
    kept = {path.stem for path in (docs / "tutorials" / "outputs").glob("*.ipynb")}
    assert kept == {path.stem for path in sources}


def test_a_tutorial_whose_code_was_changed_is_found(
    docs: Path, kept_outputs: ModuleType, tmp_path: Path
) -> None:
    (tmp_path / "outputs").mkdir()
    for name in ("friction_map.md", "outputs/friction_map.ipynb"):
        (tmp_path / name).write_bytes((docs / "tutorials" / name).read_bytes())
    copy = tmp_path / "friction_map.md"
    assert not kept_outputs.is_stale(copy)
    text = copy.read_text("utf-8")
    copy.write_text(text.replace("# A friction map", "# Another title"), "utf-8")
    assert not kept_outputs.is_stale(copy)
    copy.write_text(text.replace("default_rng(7)", "default_rng(8)"), "utf-8")
    assert kept_outputs.is_stale(copy)


def test_kept_outputs_hold_no_error_and_no_path_and_are_small(
    docs: Path, kept_outputs: ModuleType
) -> None:
    for path in kept_outputs.tutorials(docs):
        place = kept_outputs.kept_path(path)
        assert place.stat().st_size < LARGEST
        assert "/tmp/" not in place.read_text("utf-8")
        kinds = {o.output_type for c in kept_outputs.kept(path).cells for o in c.outputs}
        assert kinds <= {"stream", "execute_result", "display_data"}, path


def test_the_tutorials_found_the_truth(docs: Path, kept_outputs: ModuleType) -> None:
    """Numbers of the printed outputs beside those from which the data were made."""

    def printed(name: str) -> str:
        cells = kept_outputs.kept(docs / "tutorials" / f"{name}.md").cells
        return "".join(o.text for c in cells for o in c.outputs if o.output_type == "stream")

    lean = float(re.search(r"beta_base = ([0-9.]+) rad", printed("first_diagnosis"))[1])
    assert lean == pytest.approx(np.radians(4.0), abs=1e-3)
    hits = int(re.search(r"(\d+) of 12 contain", printed("fit"))[1])
    assert hits >= 10
    static = float(re.search(r"F_s_pan = \{value = ([0-9.]+)", printed("friction_map"))[1])
    assert static == pytest.approx(0.40, abs=0.01)
    first = float(re.search(r"time=([0-9.]+)", printed("stick_slip_and_backlash"))[1])
    assert first == pytest.approx(0.5 / (2.0 * 0.1), abs=1e-6)
    plan = printed("predictive_control")
    assert float(re.search(r"pan ([0-9.-]+) deg", plan)[1]) == pytest.approx(90.0, abs=0.01)
    for largest, limit in re.findall(r"largest tau_\w+: ([0-9.]+) of ([0-9.]+) N m", plan):
        assert float(largest) <= float(limit) + 1e-3
    pairs = re.findall(r": ([0-9.-]+) by JAX, ([0-9.-]+) by", printed("batches_and_gradients"))
    assert len(pairs) == 3
    for by_jax, by_sensitivity in pairs:
        assert float(by_jax) == pytest.approx(float(by_sensitivity), rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "library"), [("predictive_control", "casadi"), ("batches_and_gradients", "diffrax")]
)
def test_tutorials_of_other_libraries_run(
    name: str, library: str, docs: Path, kept_outputs: ModuleType, tmp_path: Path
) -> None:
    """Their outputs are kept: here they run with the versions that are installed."""
    pytest.importorskip(library)
    cells = kept_outputs.code(kept_outputs.source(docs / "tutorials" / f"{name}.md"))
    program = "\n".join(cell for cell in cells if not cell.startswith("%"))
    ran = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stderr
    (line,) = [line for line in ran.stdout.splitlines() if line.startswith(("after", "c_x"))]
    kept = kept_outputs.kept(docs / "tutorials" / f"{name}.md").cells
    assert any(line in o.text for c in kept for o in c.outputs if o.output_type == "stream")


def test_every_effect_is_described_as_a_log_shows_it(docs: Path) -> None:
    groups = tomllib.loads((docs / "effects_in_logs.toml").read_text("utf-8"))
    named = [name for group in groups.values() for name in group["effects"]]
    assert sorted(named) == sorted(effect.id for effect in PACKAGED)


def test_the_examples_of_the_reference_run(docs: Path, tmp_path: Path) -> None:
    text = (docs / "reference" / "emitted_module.md").read_text("utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    program = f"{block}\nprint(dx[2:].round(6).tolist(), dx[:2].tolist())"
    ran = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stderr
    accelerations, rates = ran.stdout.split("] [")
    assert rates.strip(" []\n") == "0.0, 0.0"
    assert 0.0 < float(accelerations.strip("[").split(",")[0]) < 10.0
