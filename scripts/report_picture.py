"""Take the picture of the README from a report: `python3 scripts/report_picture.py [REPORT] [PNG]`.

By default from the report of `scripts/demo.py`. A headless Chromium shows its head, and Pillow,
which comes with matplotlib, reduces the colours. Run it with the Python of `.venv`.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from environment import CHECKOUT, leave

REPORT = CHECKOUT / "out" / "demo" / "report.html"
PICTURE = CHECKOUT / "docs" / "_static" / "report.png"
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
SIZE = (1000, 1090)  # pixels: the answer, and errors of validation runs
COLOURS = 256


def main(arguments: list[str]) -> int:
    """Draw the picture; exit code 2, with one line, where there is no report or no browser."""
    from PIL import Image

    given = [Path(name) for name in arguments]
    report, picture = [*given, REPORT, PICTURE][:2] if not given else [*given, PICTURE][:2]
    if not report.is_file():
        leave(f"no report at {report}: run python3 scripts/demo.py first.")
    browser = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if browser is None:
        leave(f"no browser on PATH (looked for {', '.join(BROWSERS)}): install chromium.")
    with tempfile.TemporaryDirectory() as folder:
        shot = Path(folder) / "shot.png"
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
        options += [f"--user-data-dir={folder}", f"--window-size={SIZE[0]},{SIZE[1]}"]
        command = [browser, *options, f"--screenshot={shot}", report.resolve().as_uri()]
        subprocess.run(command, check=True, capture_output=True, timeout=120)
        with Image.open(shot) as image:
            image.convert("RGB").quantize(COLOURS).save(picture, optimize=True)
    print(f"{picture}: {picture.stat().st_size / 1024:.0f} kB")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
