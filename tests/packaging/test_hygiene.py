"""The tree carries no path of one machine, no silenced check without a reason, no giant file."""

import ast
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.benchmark.scaled import SOURCES

MACHINE_PATH = re.compile(r"(^|[^A-Za-z0-9_.])/(work|farm|root)/", re.MULTILINE)
HOME_PATH = re.compile(r"(^|[^A-Za-z0-9_.])/(home|Users)/[a-z]", re.MULTILINE)
BARE_TYPE_IGNORE = re.compile(r"#\s*type:\s*ignore(?!\[[a-z])")
BARE_NOQA = re.compile(r"#\s*noqa(?!: [A-Z])")
HINTS = "hints.py"  # observations: nothing is decided by their numbers
LONGEST_FILE = 600
LONGEST_EFFECT = 80  # as the README says


def tree(checkout: Path) -> list[Path]:
    """Files that are tracked or would be: everything that git does not ignore."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    try:
        listed = subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError) as failure:
        pytest.skip(f"the list of tracked files needs a git checkout: {failure}")
    files = [checkout / name for name in listed.stdout.split("\0") if name]
    return [file for file in files if file.is_file()]


def texts(checkout: Path, *suffixes: str) -> Iterator[tuple[str, str]]:
    """Relative name and content of every text file of the tree, or of those with a suffix."""
    for file in tree(checkout):
        if suffixes and file.suffix not in suffixes:
            continue
        try:
            text = file.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        yield file.relative_to(checkout).as_posix(), text


@pytest.mark.parametrize("pattern", [MACHINE_PATH, HOME_PATH], ids=["machine", "home"])
def test_no_path_of_one_machine(pattern: re.Pattern[str], checkout: Path) -> None:
    assert [name for name, text in texts(checkout) if pattern.search(text)] == []


@pytest.mark.parametrize("pattern", [BARE_TYPE_IGNORE, BARE_NOQA], ids=["type-ignore", "noqa"])
def test_no_check_is_silenced_without_naming_it(pattern: re.Pattern[str], checkout: Path) -> None:
    assert [name for name, text in texts(checkout, ".py") if pattern.search(text)] == []


def test_the_formatter_has_the_last_word(checkout: Path) -> None:
    silenced = re.compile(r"#\s*" + "fmt:")
    assert [name for name, text in texts(checkout, ".py") if silenced.search(text)] == []


def test_generated_modules_silence_no_check_at_all(checkout: Path) -> None:
    silenced = re.compile(r"#\s*(noqa|type:\s*ignore|fmt:|ruff:)")
    modules = [(name, text) for name, text in texts(checkout, ".py") if name[:10] == "generated/"]
    assert modules
    assert [name for name, text in modules if silenced.search(text)] == []


def test_no_file_is_longer_than_a_person_reads_at_once(checkout: Path) -> None:
    lengths = {name: text.count("\n") for name, text in texts(checkout, ".py")}
    written = {name: n for name, n in lengths.items() if not name.startswith("generated/")}
    effects = Path("ptp_symbolic/symbolic/effects")
    written.pop(str(effects / "__init__.py"))  # the list of all of them
    assert {name: n for name, n in written.items() if n > LONGEST_FILE} == {}
    assert {
        name: n
        for name, n in written.items()
        if n > LONGEST_EFFECT and Path(name).parent == effects and "__init__" not in name
    } == {}


@pytest.mark.parametrize(
    ("pattern", "text", "caught"),
    [
        (MACHINE_PATH, "open('" + "/".join(["", "work", "main"]) + "')", True),
        (MACHINE_PATH, "homework/notes, ./work/notes", False),
        (BARE_TYPE_IGNORE, "x = f()  # type:" + " ignore", True),
        (BARE_TYPE_IGNORE, "x = f()  # type:" + " ignore[arg-type]", False),
        (BARE_NOQA, "x = 1  # no" + "qa", True),
        (BARE_NOQA, "x = 1  # no" + "qa: E501", False),
    ],
)
def test_the_patterns_find_what_they_are_for(
    pattern: re.Pattern[str], text: str, caught: bool
) -> None:
    assert bool(pattern.search(text)) is caught


CONSTANTS = "ptp_symbolic/numeric/identify/constants.py"
CHOSEN = 34  # constants that nothing derives: this may fall, not rise


def numeric_constants(source: str) -> list[str]:
    """Names in capitals that a module sets to numbers, not by way of other names."""
    found = []
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name | ast.Tuple):
            numbers = [
                leaf
                for leaf in ast.walk(node.value)
                if isinstance(leaf, ast.Constant) and isinstance(leaf.value, int | float)
            ]
            name = ast.unparse(node.targets[0])
            if name.strip("()").isupper() and numbers:
                found.append(name)
    return found


def test_numbers_that_were_chosen_stand_in_one_table(checkout: Path) -> None:
    """Each with its unit, its quantity and where it comes from."""
    for folder in ("diagnose", "identify"):
        for module in sorted((checkout / "ptp_symbolic/numeric" / folder).glob("*.py")):
            if module != checkout / CONSTANTS and module.name != HINTS:
                assert numeric_constants(module.read_text(encoding="utf-8")) == [], module
    lines = (checkout / CONSTANTS).read_text(encoding="utf-8").splitlines()
    table = [line for line in lines if re.match(r"[A-Z_0-9]+ = ", line)]
    sources = [line.partition("  # ")[2].split("; ") for line in table]
    assert [line for line, parts in zip(table, sources, strict=True) if len(parts) < 3] == []
    assert sum(parts[-1].startswith(SOURCES) for parts in sources) <= CHOSEN


def test_a_number_outside_the_table_is_found() -> None:
    source = "A, B = 1.0, 2\nC = -0.5\nD = A * B\nE = 'text'\nF = (2.0 * A,)\n"
    assert numeric_constants(source) == ["(A, B)", "C", "F"]
