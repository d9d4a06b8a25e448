"""Kernels compiled ahead: a process of its own is begun where one is needed, and waited for."""

import subprocess
import sys
from pathlib import Path

import pytest

from ptp_symbolic.numeric.simulation import ahead, fixed_runner, hybrid, sampling
from ptp_symbolic.numeric.simulation.ahead import (
    FIXED_RUNNER,
    HELD_SAMPLES,
    RUNNER,
    SAMPLED_RUNNER,
)

COMPILE = ahead.COMPILE


@pytest.fixture
def mark(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A mark in an empty folder, and nothing begun; compiling is to leave a file `done` there."""
    slow = f"import time; time.sleep(0.5); open({str(tmp_path / 'done')!r}, 'w')"
    monkeypatch.setattr(ahead, "MARKS", tmp_path / "__pycache__")
    monkeypatch.setattr(ahead, "COMPILE", dict.fromkeys(COMPILE, slow))
    monkeypatch.setattr(ahead, "_begun", {})
    monkeypatch.setattr(ahead, "_came_along", lambda _: False)
    (tmp_path / "__pycache__").mkdir()
    return ahead._mark(RUNNER)


def test_who_needs_it_waits_until_it_is_compiled(mark: Path) -> None:
    done = mark.parents[1] / "done"
    ahead.compile_ahead(RUNNER)
    ahead.wait_until_compiled(RUNNER)
    assert done.exists()


def test_it_is_begun_once_and_not_where_it_was_compiled_before(
    mark: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[list[str]] = []
    start = subprocess.Popen

    def noted(command: list[str], **options: object) -> object:
        begun.append(command)
        return start(command, **options)  # type: ignore[call-overload]

    monkeypatch.setattr(ahead.subprocess, "Popen", noted)
    ahead.compile_ahead(RUNNER)
    ahead.compile_ahead(RUNNER)
    assert [command[0] for command in begun] == [sys.executable]
    ahead.note_compiled(SAMPLED_RUNNER)
    ahead.compile_ahead(SAMPLED_RUNNER)
    assert len(begun) == 1


def test_a_mark_of_other_sources_is_replaced(mark: Path) -> None:
    old = mark.with_name("runner-of-0")
    other = mark.with_name("sampled-runner-of-0")
    old.touch()
    other.touch()
    ahead.note_compiled(RUNNER)
    assert mark.exists()
    assert not old.exists()
    assert other.exists()


def test_where_no_process_can_be_begun_nobody_waits(
    mark: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ahead.sys, "executable", str(mark / "no python"))
    ahead.compile_ahead(RUNNER)
    ahead.wait_until_compiled(RUNNER)
    assert not (mark.parents[1] / "done").exists()


def test_what_is_compiled_ahead_is_what_runs_and_leaves_its_mark(mark: Path) -> None:
    hybrid.runner.cache_clear()
    exec(COMPILE[RUNNER], {})
    assert hybrid.runner.cache_info().currsize == 1
    assert mark.exists()
    assert not ahead._mark(SAMPLED_RUNNER).exists()
    for kernel, made in ((HELD_SAMPLES, sampling.loop), (FIXED_RUNNER, fixed_runner.runner)):
        made.cache_clear()
        exec(COMPILE[kernel], {})
        assert made.cache_info().currsize == 1
        assert ahead._mark(kernel).exists()


def test_nothing_is_begun_for_what_came_with_the_installation(
    mark: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ahead, "_came_along", lambda kernel: kernel == RUNNER)
    ahead.compile_ahead(RUNNER)
    assert not ahead._begun
