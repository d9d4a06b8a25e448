"""The reader of pages finds what is wrong with one."""

from pathlib import Path

import pytest

from tests.documentation.pages import Reader, assert_prints, blocks, command_lines, same

PAGE = """
```python
# numbers.txt
1 2
```

```python
from pathlib import Path
print("sum", sum(map(int, Path("numbers.txt").read_text().splitlines()[1].split())), 0.5)
```

```text
sum 3 0.501
```
"""


def read(page: str, folder: Path) -> Reader:
    reader = Reader(folder, lambda words: "\n".join(words))
    for block in blocks(page):
        reader.paste(block)
    return reader


def test_blocks_run_in_the_order_of_reading(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert read(PAGE, tmp_path).done == 3
    with pytest.raises(AssertionError, match="not printed: sum 4"):
        read(PAGE.replace("sum 3", "sum 4"), tmp_path)
    with pytest.raises(AssertionError, match="block of fortran"):
        read("```fortran\nend\n```\n", tmp_path)


def test_numbers_may_differ_by_two_percent_and_words_not() -> None:
    assert same("b = 1.00 N m", "b = 1.01 N m") and not same("b = 1.00 N m", "b = 1.03 N m")
    assert not same("b = 1.00 N m", "c = 1.00 N m")
    assert_prints("first\nsecond 2\nthird", "first\n...\nthird")
    with pytest.raises(AssertionError, match="not printed: first"):
        assert_prints("first\nsecond", "second\nfirst")


def test_command_lines_are_joined_and_split() -> None:
    assert list(command_lines("ptp a \\\n  b 'c d'  # e\n\nptp f\n")) == [
        ["ptp", "a", "b", "c d"],
        ["ptp", "f"],
    ]
