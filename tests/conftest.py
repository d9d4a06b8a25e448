"""What every test may ask for."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "Agg")

# The first call of a jitted function compiles it: a deadline per example would fail at random.
settings.register_profile("ptp_symbolic", deadline=None, derandomize=True)
settings.load_profile("ptp_symbolic")


@pytest.fixture(scope="session")
def checkout() -> Path:
    """Root folder of the source tree."""
    return Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def shared(checkout: Path) -> Path:
    """Folder of measured data that is not part of the repository; skips where there is none.

    Looked for in the environment variable PTP_SYMBOLIC_SHARED, else in `../shared` beside the
    checkout.
    """
    named = os.environ.get("PTP_SYMBOLIC_SHARED")
    folder = Path(named) if named else checkout.parent / "shared"
    if not (folder / "fieldlogs").is_dir():
        pytest.skip(f"no field logs in {folder}: set PTP_SYMBOLIC_SHARED to the folder of the data")
    return folder
