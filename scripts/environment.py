"""The virtual environment `.venv` of this checkout, made with the standard library alone."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import subprocess
import sys
import sysconfig
import time
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

CHECKOUT = Path(__file__).resolve().parent.parent
ENVIRONMENT = CHECKOUT / ".venv"
STAMP = ENVIRONMENT / "ptp-symbolic.stamp"
PROGRAMS = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin")
PYTHON = PROGRAMS / ("python.exe" if os.name == "nt" else "python")
OLDEST_PYTHON = (3, 11)
SIGN_OF_LIFE = 30.0  # s


def prepare_environment(extras: tuple[str, ...] = ()) -> None:
    """Make `.venv` and install this checkout into it, editable, with the named extras.

    What is already there is used again when its stamp fits: same checkout, same Python, same
    `pyproject.toml`. The stamp is written last, so an interrupted installation is made anew.
    Ends the program with one line on stderr and exit code 2 when that is impossible.
    """
    refuse_unfit_python()
    fingerprint = describe_installation()
    found, *installed = read_stamp() or [""]
    fits = found == fingerprint and PYTHON.exists()
    if fits and set(extras) <= set(installed):
        return
    if not fits:
        installed = []
        create_environment()
    wanted = sorted({*installed, *extras})
    install_checkout(wanted)
    STAMP.write_text("\n".join([fingerprint, *wanted]) + "\n", encoding="utf-8")


def refuse_unfit_python() -> None:
    """Leave with a message when this interpreter is too old or cannot make environments."""
    if sys.version_info < OLDEST_PYTHON:
        version = ".".join(str(part) for part in sys.version_info[:3])
        leave(f"Python {version} is too old: run this with Python 3.11 or newer.")
    if not all(importlib.util.find_spec(module) for module in ("venv", "ensurepip")):
        leave(
            f"{sys.executable} cannot make virtual environments (no venv or ensurepip): install "
            "them (Debian and Ubuntu: apt install python3-venv) or use another Python 3.11+."
        )


def describe_installation() -> str:
    """Return the hash of everything that decides whether an existing `.venv` still fits."""
    facts = f"{CHECKOUT}\n{sys.version}\n{sys.base_prefix}\n".encode()
    return hashlib.sha256(facts + (CHECKOUT / "pyproject.toml").read_bytes()).hexdigest()


def read_stamp() -> list[str]:
    """Return the lines of the stamp (hash, then the installed extras); none without a stamp."""
    return STAMP.read_text(encoding="utf-8").split() if STAMP.is_file() else []


def create_environment() -> None:
    """Make an empty `.venv` with pip, in place of the one that may be there."""
    say(f"Making {ENVIRONMENT} ...")
    STAMP.unlink(missing_ok=True)
    command = [sys.executable, "-m", "venv", "--clear", str(ENVIRONMENT)]
    made = subprocess.run(command, capture_output=True, text=True)
    if made.returncode != 0:
        reason = " ".join((made.stderr or made.stdout).split())[-300:]
        leave(f"python -m venv could not make {ENVIRONMENT}: {reason}")


def install_checkout(extras: list[str]) -> None:
    """Install this checkout with its dependencies into `.venv`; pip prints what goes wrong."""
    say("Installing ptp-symbolic and what it needs, and compiling its kernels (minutes, once) ...")
    target = f"{CHECKOUT}[{','.join(extras)}]" if extras else str(CHECKOUT)
    command = [str(PYTHON), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    installing = subprocess.Popen([*command, "--no-compile", "--editable", target])
    begun = time.monotonic()
    while installing.poll() is None:
        with suppress(subprocess.TimeoutExpired):
            installing.wait(SIGN_OF_LIFE)
            break
        say(f"  still at it, {time.monotonic() - begun:.0f} s")
    if installing.returncode != 0:
        leave("pip could not install the package (its message is above): check the network.")
    compile_packages()


def compile_packages() -> None:
    """Compile what is installed on all cores, without the packages' own tests: half of the work
    that pip would do on one. What does not compile is left for its import to complain about.
    """
    base = {"base": str(ENVIRONMENT), "platbase": str(ENVIRONMENT)}
    packages = sysconfig.get_path("purelib", "venv", base)
    options = ["-qq", "-j", "0", "-x", r"[\\/]tests[\\/]"]
    subprocess.run([str(PYTHON), "-m", "compileall", *options, packages])


def say(message: str) -> None:
    """Print a line of progress at once, before the output of the programs that follow."""
    print(message, flush=True)


def leave(message: str) -> NoReturn:
    """End the program with one line on stderr and exit code 2."""
    print(f"error: {message}", file=sys.stderr)
    raise SystemExit(2)
