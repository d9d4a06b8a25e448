"""Set up `.venv` and build the documentation: `python3 scripts/docs.py [--out DIR]`.

Writes the pages into one folder, `out/docs` unless another is named, which needs neither a network
nor a server: open its `index.html`. A tutorial whose code was changed runs first, and its outputs
are kept beside it. Warnings are errors. Needs Python 3.11+ and nothing else.
"""

from __future__ import annotations

import argparse
import subprocess
import time
from pathlib import Path

from environment import CHECKOUT, PYTHON, prepare_environment, say

DOCS = CHECKOUT / "docs"


def main() -> int:
    """Build the pages and return the exit code: 0, or that of what failed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, default=CHECKOUT / "out" / "docs", help="the folder")
    out: Path = parser.parse_args().out.resolve()
    prepare_environment(extras=("docs",))
    begun = time.monotonic()
    code = run("docs/_extensions/kept_outputs.py") or run(
        *("-m", "sphinx", "--quiet", "--fail-on-warning", "--keep-going", "--builder", "html"),
        *("--doctree-dir", str(out.parent / f".{out.name}" / "doctrees"), str(DOCS), str(out)),
    )
    pages = len(list(out.rglob("*.html")))
    end = "warnings above" if code else "no warning"
    say(f"{pages} pages in {time.monotonic() - begun:.0f} s, {end}: {out / 'index.html'}")
    return code


def run(*arguments: str) -> int:
    """Run the Python of `.venv` in the checkout and return its exit code."""
    return subprocess.run([str(PYTHON), *arguments], cwd=CHECKOUT).returncode


if __name__ == "__main__":
    raise SystemExit(main())
