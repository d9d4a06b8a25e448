"""An exported model runs on an emulated microcontroller, and its table has numbers that can be."""

import importlib.util
import shutil
from pathlib import Path

import pytest

from tests.targets.machines import program_of

SCRIPT = Path(__file__).parents[2] / "scripts" / "firmware_table.py"


def test_a_sampled_servo_runs_on_a_cortex_m4(tmp_path: Path) -> None:
    """Every operation takes an instruction at least; a step takes two vector fields and more."""
    spec = importlib.util.spec_from_file_location("firmware_table", SCRIPT)
    assert spec is not None and spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    missing = [tool for tool in script.TOOLS if shutil.which(tool) is None]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")
    row = script.measured("thesis-pan-servo", "Cortex-M4F, float", tmp_path)
    assert program_of("thesis-pan-servo").operations.each < row.vector_field < 1000
    assert row.worst_step >= row.step > 2 * row.vector_field
    assert 0 < row.stack < 12288 and 0 < row.ram < row.flash < 65536
