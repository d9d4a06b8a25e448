"""Every block of every how-to page works as it stands there, in the order of reading."""

import math
import re
import shutil
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import numba
import pytest

from ptp_symbolic.cli import main
from ptp_symbolic.cli.commands import commands
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.placement import undeclared_parameters
from ptp_symbolic.symbolic.effects import EFFECTS, GROUP
from tests.documentation.pages import Reader, blocks, in_a_shell

FOLDER = Path(__file__).parents[2] / "docs" / "how-to"
PAGES = sorted(page for page in FOLDER.glob("*.md") if page.name != "index.md")
COMPILERS = ("arm-none-eabi-gcc",)  # run where they are installed
LONG = ("diagnose", "fit")  # minutes: their arguments are read, and the files they name


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Callable:
    def run(words: list[str]) -> str:
        if words[0] in COMPILERS:
            return in_a_shell(words) if shutil.which(words[0]) else ""
        assert words[0] == "ptp-symbolic", words
        if words[1] in LONG:
            long = commands.commands[words[1]]
            context = long.make_context(words[1], words[2:])
            for given in context.params.values():
                for name in given if isinstance(given, tuple) else ():
                    assert all(Path(part).exists() for part in str(name).split("+")), name
            return ""
        monkeypatch.setattr(sys, "argv", words)
        with pytest.raises(SystemExit) as ended:
            main()
        printed = capsys.readouterr()
        assert not ended.value.code, printed.err
        return printed.out

    return run


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_block_works(
    page: Path, command: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    if page.stem == "gpu":
        pytest.importorskip("numba_cuda", reason="numba-cuda is not installed: the extra gpu")
        monkeypatch.setattr(numba.config, "ENABLE_CUDASIM", 1)
    reader = Reader(tmp_path, command)
    found = blocks(page.read_text(encoding="utf-8"))
    assert found, "a how-to page shows how"
    for block in found:
        reader.paste(block)
        if block.language == "toml" and block.file:
            platform = read_platform(tmp_path / block.file)
            assert undeclared_parameters(platform) == ()
        if "entry-points" in block.text:
            assert set(tomllib.loads(block.text)["project"]["entry-points"]) == {GROUP}


def test_the_index_lists_every_page() -> None:
    index = (FOLDER / "index.md").read_text(encoding="utf-8")
    listed = re.search(r"```\{toctree\}(.*?)```", index, re.DOTALL)
    assert listed is not None
    assert {page.stem for page in PAGES} <= set(listed[1].split())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_effects_and_commands_that_pages_name_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    named = re.findall(r"`ptp-symbolic ([\w-]+)", text)
    assert set(named) <= {*commands.commands}
    declared = re.findall(r'effect = "(\w+)"', text)
    own = set(re.findall(r'id="(\w+)"', text))
    assert set(declared) <= {effect.id for effect in EFFECTS} | own


def declared(page: str, folder: Path) -> Platform:
    """The platform that a how-to page declares."""
    (block,) = (b for b in blocks((FOLDER / page).read_text(encoding="utf-8")) if b.file)
    file = folder / str(block.file)
    file.write_text(block.text, encoding="utf-8")
    return read_platform(file)


def test_the_turret_with_a_payload_is_read_in_si(tmp_path: Path) -> None:
    platform = declared("platform.md", tmp_path)
    values = {parameter.name: parameter.value for parameter in platform.parameters}
    assert values["m_payload"] == 4.992
    assert values["J_x_payload"] == pytest.approx(5.3e-3)
    assert values["c_x_payload"] == pytest.approx(0.1)
    free = [parameter.name for parameter in platform.parameters if parameter.free]
    assert free == ["F_c_pan", "F_s_pan", "F_v_pan", "b_tilt"]
    refuse_impossible(assemble(platform), platform)


def test_raw_columns_are_read_in_si(tmp_path: Path) -> None:
    pwm, angle, gyro = declared("raw-columns.md", tmp_path).signals
    assert (pwm.scale, pwm.offset) == (0.1875, 128)
    assert angle.scale == pytest.approx(-2 * math.pi / 7200)
    assert (gyro.delay, gyro.offset) == pytest.approx((0.009, math.radians(3.0)))
