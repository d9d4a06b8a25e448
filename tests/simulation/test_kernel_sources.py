"""What the compiled runners are made of, an edit anywhere in which compiles them anew; and which
emitted functions are compiled for a run.
"""

import ast
import shutil
from pathlib import Path

from ptp_symbolic.numeric.simulation.kernels.records import kernel_sources

SIMULATION = "ptp_symbolic.numeric.simulation"


def imported(package: Path, path: Path) -> set[Path]:
    """Files of the simulation that the file at `path` imports, as Python's own parser reads it."""
    found: set[Path] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(SIMULATION):
            place = package.parent.joinpath(*str(node.module).split("."))
            names = [place, *(place / alias.name for alias in node.names)]
            found |= {f for name in names if (f := name.with_suffix(".py")).is_file()}
    return found


def test_every_file_that_a_kernel_imports_counts(checkout: Path) -> None:
    package = checkout / "ptp_symbolic"
    sources = kernel_sources(package)
    for path in sources:
        assert imported(package, path) <= sources, path
    simulation = package / "numeric/simulation"
    counted = {str(p.relative_to(simulation)) for p in sources if simulation in p.parents}
    assert {"hybrid.py", "sampling.py", "events/crossing.py", "kernels/linear.py"} <= counted
    assert not {"run.py", "integration.py", "feedback.py", "inputs.py"} & counted


def test_a_new_file_counts_as_soon_as_a_kernel_imports_it(checkout: Path, tmp_path: Path) -> None:
    package = tmp_path / "ptp_symbolic"
    shutil.copytree(checkout / "ptp_symbolic/numeric", package / "numeric")
    new = package / "numeric/simulation/events/slip.py"
    new.write_text("")
    assert new not in kernel_sources(package)
    with (package / "numeric/simulation/outputs.py").open("a") as file:
        file.write(f"from {SIMULATION}.events import (\n    slip,\n)\n")
    assert new in kernel_sources(package)
