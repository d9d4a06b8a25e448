"""Modules run as the text that was verified, wholly or not at all."""

import hashlib
import importlib.util
import os
import py_compile
import sys
from pathlib import Path

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import TRAILER, load_module


def sealed(text: str) -> str:
    return f"{text}{TRAILER}{hashlib.sha256(text.encode()).hexdigest()}\n"


def test_a_failed_import_leaves_no_half_made_module(tmp_path: Path) -> None:
    path = tmp_path / "half.py"
    path.write_text(sealed("VALUE = 1\nraise RuntimeError('in the middle')\n"))
    for _ in range(2):
        with pytest.raises(RuntimeError, match="in the middle"):
            load_module(path, "half_made_for_a_test")
        assert "half_made_for_a_test" not in sys.modules


def test_bytecode_beside_a_module_is_not_run(tmp_path: Path) -> None:
    """Bytecode of another text, of the module's time and size, as Python would take for its own."""
    path, text = tmp_path / "model.py", sealed("NAMES = 'of the text verified'\n")
    path.write_text(text)
    planted = tmp_path / "planted.py"
    planted.write_text("NAMES = 'planted'\n".ljust(len(text), "#"))
    stat = path.stat()
    os.utime(planted, ns=(stat.st_atime_ns, stat.st_mtime_ns))
    py_compile.compile(str(planted), cfile=importlib.util.cache_from_source(str(path)))
    model = load_module(path, "beside_planted_bytecode")
    assert model.module.NAMES == "of the text verified"


def test_an_edited_module_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "model.py"
    path.write_text(sealed("VALUE = 1\n").replace("VALUE = 1", "VALUE = 2"))
    with pytest.raises(InputError, match="does not fit its checksum"):
        load_module(path, "edited_for_a_test")
