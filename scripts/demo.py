"""Set up `.venv` and diagnose the sample log: `python3 scripts/demo.py [--out FOLDER]`.

The sample is a pan axis with a payload on a base that is not level, which its declaration does
not say; its logs come from an independent multibody engine. The diagnosis fits the declared
machine, finds it wanting, names the effect, and compares the error before and after on runs that
were never fitted. Needs Python 3.11+ and nothing else.
"""

from __future__ import annotations

import argparse
import subprocess
from pathlib import Path

from environment import CHECKOUT, PROGRAMS, leave, prepare_environment, say

SAMPLE = CHECKOUT / "ptp_symbolic" / "samples" / "tilted_base"


def main() -> int:
    """Diagnose the sample log; print the before/after table and the path of the report."""
    parser = argparse.ArgumentParser(description="Diagnose the sample log that ships along.")
    parser.add_argument("--out", type=Path, default=Path("out/demo"), help="default: out/demo")
    out = parser.parse_args().out.resolve()
    prepare_environment()
    finished = subprocess.run(diagnose_command(out)).returncode
    if finished != 0:
        return finished
    report = out / "report.html"
    if not report.is_file():
        leave(f"the diagnosis ended without writing {report}")
    say(f"\nOpen the report in a browser: {report}")
    return 0


def diagnose_command(out: Path) -> list[str]:
    """Return the command line that diagnoses the sample and writes into the folder `out`."""
    command = [str(PROGRAMS / "ptp-symbolic"), "diagnose"]
    command += ["--platform", str(SAMPLE / "platform.toml")]
    for role in ("train", "validate"):
        command += [f"--{role}", *(str(log) for log in sorted((SAMPLE / role).glob("*.csv")))]
    return [*command, "--out", str(out)]


if __name__ == "__main__":
    raise SystemExit(main())
