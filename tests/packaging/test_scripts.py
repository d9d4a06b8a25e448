"""The two commands of the README refuse a Python that cannot serve, in one line."""

import subprocess
import sys
from pathlib import Path

import pytest

REFUSED = {
    "too old": ("sys.version_info = (3, 10, 4)", "Python 3.10.4 is too old"),
    "no ensurepip": ("sys.modules['ensurepip'] = None", "apt install python3-venv"),
    "no venv": ("sys.modules['venv'] = None", "apt install python3-venv"),
}


@pytest.mark.parametrize("script", ["demo.py", "test.py"])
@pytest.mark.parametrize("case", REFUSED)
def test_unfit_python_is_refused_in_one_line(
    case: str, script: str, checkout: Path, tmp_path: Path
) -> None:
    preparation, message = REFUSED[case]
    scripts = checkout / "scripts"
    program = (
        f"import runpy, sys; sys.path.insert(0, {str(scripts)!r}); sys.argv = [{script!r}];"
        f"{preparation}; runpy.run_path({str(scripts / script)!r}, run_name='__main__')"
    )
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 2
    assert ran.stdout == ""
    assert ran.stderr.startswith("error: ") and ran.stderr.count("\n") == 1
    assert message in ran.stderr
    assert list(tmp_path.iterdir()) == []
