"""Pages whose blocks run in the order of reading, in one folder, as a reader would paste them.

A block whose first line is a comment with the name of a file is that file. Other Python and shell
blocks run, and a `text` block after them is what they print: the same words, and numbers within 2 %
(machines differ in the last digits).
"""

import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE_NAME = re.compile(r"# ([\w.-]+\.\w+)\n")
NUMBER = re.compile(r"[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
PRINTED_WITHIN = 0.02


@dataclass(frozen=True)
class Block:
    """A fenced block: its language and its text."""

    language: str
    text: str

    @property
    def file(self) -> str | None:
        """The file that the block is, if it is one."""
        found = FILE_NAME.match(self.text)
        return found[1] if found else None


def blocks(page: str) -> list[Block]:
    """The fenced blocks of a page with a language, in the order of reading."""
    return [Block(*found) for found in FENCE.findall(page)]


@dataclass
class Reader:
    """Someone who pastes the blocks of a page, one after the other, in `folder`.

    `command` runs the words of a command line that begins with ptp-symbolic, and returns what it
    prints.
    """

    folder: Path
    command: Callable[[list[str]], str]
    names: dict[str, object] = field(default_factory=lambda: {"__name__": "page"})
    printed: str = ""
    done: int = 0

    def paste(self, block: Block) -> None:
        """Do what the block says; `text` that is no file is compared with what was printed."""
        self.done += 1
        if block.file:
            (self.folder / block.file).write_text(block.text, encoding="utf-8")
        elif block.language == "text":
            assert_prints(self.printed, block.text)
        elif block.language == "python":
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                exec(compile(block.text, "block", "exec"), self.names)
            self.printed = out.getvalue()
        elif block.language == "sh":
            self.printed = "".join(self.command(words) for words in command_lines(block.text))
        elif block.language == "c":
            self.printed = self.compiled(block.text)
        elif block.language == "matlab":
            self.printed = self.by_octave(block.text)
        elif block.language == "toml":
            tomllib.loads(block.text)
        else:
            raise AssertionError(f"a block of {block.language} cannot be pasted")

    def compiled(self, text: str) -> str:
        """What a C program prints that includes the exported source; nothing without a compiler."""
        compiler = shutil.which("cc")
        (header,) = re.findall(r'#include "(\w+)\.h"', text)
        source = min(self.folder.rglob(f"{header}.c"))
        (source.parent / "main.c").write_text(text, encoding="utf-8")
        if compiler is None:
            return ""
        words = [compiler, "-std=c99", "-O2", "-Wall", "-Werror", "main.c", source.name, "-lm"]
        subprocess.run(words, cwd=source.parent, check=True)
        program = [str(source.parent / "a.out")]
        return subprocess.run(program, check=True, capture_output=True, text=True).stdout

    def by_octave(self, text: str) -> str:
        """What Octave prints for a script; nothing without Octave."""
        octave = shutil.which("octave-cli")
        if octave is None:
            return ""
        words = [octave, "--norc", "--eval", text]
        done = subprocess.run(words, cwd=self.folder, check=True, capture_output=True, text=True)
        return done.stdout


def command_lines(text: str) -> Iterator[list[str]]:
    """The words of every command line; backslashes join lines, and # begins a comment."""
    import glob
    import shlex

    for line in text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words:
            yield [file for w in words for file in (sorted(glob.glob(w)) if "*" in w else [w])]


def assert_prints(printed: str, shown: str) -> None:
    """Every line that a page shows is printed, in that order; `...` stands for lines left out."""
    lines = iter(" ".join(line.split()) for line in printed.splitlines())
    for line in shown.splitlines():
        wanted = " ".join(line.split())
        if wanted and wanted != "...":
            assert any(same(wanted, line) for line in lines), f"not printed: {wanted}\n{printed}"


def same(wanted: str, line: str) -> bool:
    """Whether the words of two lines are the same, and their numbers within 2 %."""
    if NUMBER.sub("#", wanted) != NUMBER.sub("#", line):
        return False
    pairs = zip(NUMBER.findall(wanted), NUMBER.findall(line), strict=True)
    return all(
        float(a.replace("−", "-"))
        == pytest.approx(float(b.replace("−", "-")), rel=PRINTED_WITHIN, abs=1e-12)
        for a, b in pairs
    )


def in_a_shell(words: list[str]) -> str:
    """Run a command line as a program of its own; it must end with exit code 0."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(words, env={**os.environ, "PATH": path}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout
