"""Outputs of the tutorials, kept as notebooks beside them, so that a build runs no code.

A tutorial `tutorials/NAME.md` has its executed notebook at `tutorials/outputs/NAME.ipynb`. Before
anything is read, these fill the cache of MyST-NB, which finds a notebook by its code cells: text
may change freely, and a tutorial whose code was changed is executed.
"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import nbformat
from jupyter_cache import get_cache
from jupyter_cache.base import CacheBundleIn
from myst_nb.core.read import read_myst_markdown_notebook
from myst_parser.config.main import MdParserConfig
from nbclient import NotebookClient
from nbformat import NotebookNode
from sphinx.application import Sphinx
from sphinx.config import Config

KEPT = "outputs"
CACHE = ".jupyter_cache"  # where MyST-NB looks by itself, beside the built pages
LONGEST_RUN = 900  # s, of one cell


def setup(app: Sphinx) -> dict[str, Any]:
    """Fill the cache before the first page is read."""
    app.connect("config-inited", fill_cache, priority=100)
    return {"version": "1", "parallel_read_safe": True}


def fill_cache(app: Sphinx, config: Config) -> None:
    """Put every executed notebook that belongs to its tutorial into the cache of this build."""
    cache = get_cache(Path(app.outdir).parent / CACHE)
    for tutorial in tutorials(Path(app.srcdir)):
        if not is_stale(tutorial):
            bundle = CacheBundleIn(kept(tutorial), uri=str(tutorial), data={})
            cache.cache_notebook_bundle(bundle, check_validity=False, overwrite=True)


def tutorials(docs: Path) -> list[Path]:
    """The sources of all tutorials that run code."""
    found = sorted((docs / "tutorials").glob("*.md"))
    return [p for p in found if "{code-cell}" in p.read_text("utf-8")]


def source(tutorial: Path) -> NotebookNode:
    """The tutorial as a notebook without outputs, as MyST-NB reads it."""
    return read_myst_markdown_notebook(tutorial.read_text("utf-8"), config=MdParserConfig())


def kept(tutorial: Path) -> NotebookNode:
    """The executed notebook of a tutorial."""
    return nbformat.read(kept_path(tutorial), as_version=4)


def kept_path(tutorial: Path) -> Path:
    """Where the executed notebook of a tutorial is kept."""
    return tutorial.parent / KEPT / f"{tutorial.stem}.ipynb"


def code(notebook: NotebookNode) -> list[str]:
    """The code cells of a notebook."""
    return [cell.source.strip() for cell in notebook.cells if cell.cell_type == "code"]


def is_stale(tutorial: Path) -> bool:
    """Whether no executed notebook is kept that has the code of the tutorial as it stands now."""
    return not kept_path(tutorial).is_file() or code(kept(tutorial)) != code(source(tutorial))


def execute(tutorial: Path, folder: Path) -> None:
    """Run a tutorial in `folder` and keep its outputs. Raises CellExecutionError where it fails."""
    notebook = source(tutorial)
    where = {"metadata": {"path": str(folder)}}
    NotebookClient(notebook, timeout=LONGEST_RUN, resources=where, record_timing=False).execute()
    notebook.cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number}"  # the text is that of the tutorial
        for output in cell.outputs:
            if {"text/html", "image/png"} & output.get("data", {}).keys():
                output.data.pop("text/plain", None)
    kept_path(tutorial).parent.mkdir(exist_ok=True)
    nbformat.write(notebook, kept_path(tutorial))


def main() -> None:
    """Run the tutorials whose code was changed, and keep their outputs."""
    for tutorial in tutorials(Path(__file__).resolve().parent.parent):
        if is_stale(tutorial):
            print(f"Running {tutorial.name} ...", flush=True)
            with TemporaryDirectory() as folder:
                execute(tutorial, Path(folder))


if __name__ == "__main__":
    main()
