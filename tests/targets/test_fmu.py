"""FMUs run by FMPy in a child process, beside the simulator: events, impacts, samplers, errors.

In a child: an archive that every validator accepts may still end the process that loads it.
"""

import importlib.util
import json
import os
import platform as python_platform
import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.models.emission import possible_equations
from ptp_symbolic.models.export import export, identifier
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.symbolic.program.program import Program, program
from ptp_symbolic.symbolic.targets import fmi
from ptp_symbolic.symbolic.targets.fmi import FMU_2, FMU_3, HEADERS, Fmu
from ptp_symbolic.symbolic.targets.fmi.archive import LINUX, archive
from ptp_symbolic.symbolic.targets.fmi.description import base_units
from ptp_symbolic.symbolic.targets.fmi.variables import per_second, variables
from tests.effects.test_backlash_kinds import platform as platform_of_kind
from tests.targets.c_library import COMPILERS, STRICT
from tests.targets.machines import NAMES
from tests.targets.machines import program_of as machine_program

fmpy = pytest.importorskip("fmpy", reason="FMPy runs the FMUs: pip install fmpy")
pytestmark = [
    pytest.mark.skipif(not COMPILERS, reason="no C compiler on this machine"),
    pytest.mark.skipif(
        (python_platform.system(), python_platform.machine()) != LINUX.here,
        reason="the FMUs of these tests are built for Linux on x86_64",
    ),
]
CHILD = Path(__file__).with_name("fmu_child.py")
BOTH = pytest.mark.parametrize("target", [FMU_2, FMU_3], ids=["fmi2", "fmi3"])
HOLD = 0.05  # s


@cache
def program_of(name: str) -> Program:
    """The program of a packaged platform, or of a kind of rigid backlash."""
    return program(possible_equations(platform_named(name)))


def platform_named(name: str) -> Platform:
    return read_platform(name) if name.startswith("thesis") else platform_of_kind(name)


def built(name: str, target: Fmu, folder: Path) -> Path:
    """The FMU of a machine with the binary of this system alone."""
    own = identifier(platform_named(name).name)
    files = target.files(program_of(name), own)
    path = folder / f"{own}.fmu"
    path.write_bytes(archive(files, own, target.version, [LINUX]))
    return path


def in_child(task: str, **given: Any) -> Any:
    """What a task of `fmu_child.py` returns for JSON of what is given."""
    done = subprocess.run(
        [sys.executable, str(CHILD), task],
        input=json.dumps({key: str(v) if isinstance(v, Path) else v for key, v in given.items()}),
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, (done.returncode, done.stderr[-2000:])
    return json.loads(done.stdout.splitlines()[-1])


def beside(name: str, path: Path, kind: str, duration: float, size: float) -> tuple[float, int]:
    """Largest difference of a state from the simulator's over the size of that state, and how many
    events the simulation notes; inputs hold for 50 ms.
    """
    machine = ptp.load(platform_named(name))
    times = HOLD * np.arange(round(duration / HOLD) + 1)
    swing = np.where(times // 5 % 3 == 0, 0.3, 1.0) * size * np.sin(0.4 * np.pi * times)
    given = machine.input_names[0]
    run = machine.simulate(list(times), **{given: (times, swing)})
    found = in_child(
        "trajectory",
        path=path,
        kind=kind,
        times=list(times),
        given=given,
        values=list(swing),
        names=list(machine.state_names),
    )
    worst = 0.0
    for name_, values in found.items():
        largest = float(np.max(np.abs(run[name_])))
        worst = max(worst, float(np.max(np.abs(np.array(values) - run[name_]))) / (largest or 1.0))
    return worst, len(run.events)


@pytest.mark.parametrize(
    "target", [FMU_3, pytest.param(FMU_2, marks=pytest.mark.long)], ids=["fmi3", "fmi2"]
)
def test_stick_slip_and_gap_in_co_simulation_are_those_of_the_simulator(
    target: Fmu, tmp_path: Path
) -> None:
    """Located events, not fixed steps: three seconds agree to eight digits; nothing is invalid."""
    from fmpy.validation import validate_fmu

    path = built("thesis-pan-drive", target, tmp_path)
    assert validate_fmu(str(path)) == []
    current = (1.0 - 0.0724 * 500.0) / 12.9  # A, of 1 V and the voltage of the motor at 1 rad/s
    assert in_child("sizes", path=path) == [1.0, 1.0, 1.0, 1.0, float(f"{-current:.1e}")]
    difference, events = beside("thesis-pan-drive", path, "CoSimulation", 3.0, 3.0)
    assert events > 10
    assert difference < 1e-5


def test_sizes_follow_from_what_is_declared() -> None:
    """Bristles slip at their level over their stiffness; an angle goes to the end of its stroke."""
    whole = machine_program("lugre_friction")
    values = {p.name: float(p.default) for p in whole.equations.parameters}
    (bristle,) = (v for v in variables(whole).states if v.name.startswith("bristle_"))
    axis = bristle.name.partition("_")[2]
    slipping = values[f"F_c_{axis}"] / values[f"sigma0_{axis}"]
    assert bristle.nominal == pytest.approx(slipping, rel=0.05)
    tilt = ptp.load("thesis-tilt-drive")
    ends = np.abs(tilt.domain(tilt.parameter_vector())).max(axis=1)
    sizes = {v.name: v.nominal for v in variables(program_of("thesis-tilt-drive")).states}
    assert sizes["theta_tilt"] == pytest.approx(ends.min(), rel=0.05)
    assert sizes["omega_tilt"] is None


def test_phases_are_said_before_a_compiler_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    monkeypatch.setattr(fmi, "systems", lambda version: [LINUX])
    export(read_platform("thesis-ideal"), "fmu3", tmp_path, said.append)
    phases = ["deriving the equations", "sharing their terms", "writing the text"]
    assert said == [*phases, "compiling for Linux"]


CASES = [
    pytest.param("thesis-pan-drive", 20.0, 3.0, 50, 1e-4, id="stick-slip and gap"),
    pytest.param("thesis-pan-servo", 3.0, 0.1, 50, 1e-3, id="sampled servo"),
    pytest.param("thesis-payload", 3.0, 0.2, -1, 1e-5, id="smooth payload"),
    pytest.param("elastic_impact", 10.0, 6.0, 20, 1e-4, id="elastic impacts"),
    pytest.param("hysteresis_friction", 20.0, 6.0, 10, 1e-4, id="plastic impacts, held"),
    pytest.param("hysteresis_inertia", 20.0, 6.0, 10, 1e-4, id="plastic impacts"),
]


@pytest.mark.long
@BOTH
@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
@pytest.mark.parametrize(("name", "duration", "size", "events", "tolerance"), CASES)
def test_an_fmu_moves_as_the_simulator(
    name: str,
    duration: float,
    size: float,
    events: int,
    tolerance: float,
    kind: str,
    target: Fmu,
    tmp_path: Path,
) -> None:
    """In model exchange the integrator is CVODE, which finds the events by the indicators."""
    path = built(name, target, tmp_path)
    difference, noted = beside(name, path, kind, duration, size)
    assert noted > events
    assert difference < tolerance


@pytest.mark.long
@BOTH
@pytest.mark.parametrize("name", ["thesis-full", "thesis-tilt-drive", "thesis-pan-servo"])
def test_validators_find_nothing(name: str, target: Fmu, tmp_path: Path) -> None:
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(built(name, target, tmp_path))) == []


@pytest.mark.long
@BOTH
@pytest.mark.parametrize("name", ["thesis-full", "thesis-pan-servo"])
def test_the_manipulation_toolbox_finds_nothing(name: str, target: Fmu, tmp_path: Path) -> None:
    """A second checker, with the schemas and semantic rules of its own."""
    pytest.importorskip("fmu_manipulation_toolbox", reason="pip install fmu-manipulation-toolbox")
    command = [str(Path(sys.executable).with_name("fmutool")), "-check", "-input"]
    path = str(built(name, target, tmp_path))
    done = subprocess.run([*command, path], capture_output=True, text=True, check=True)
    said = done.stdout + done.stderr
    assert f"compliant with FMI-{target.version}" in said
    assert "No semantic error" in said


@pytest.mark.long
@BOTH
def test_a_directional_derivative_is_a_central_difference(target: Fmu, tmp_path: Path) -> None:
    """By every state, input and parameter, of every derivative and output, while sliding."""
    path = built("thesis-pan-drive", target, tmp_path)
    found = in_child("slopes", path=path)
    exact, difference = np.array(found["exact"]), np.array(found["difference"])
    scale = np.maximum(1.0, np.abs(exact))
    assert exact.shape[1] == 5 + 1 + 18 and np.count_nonzero(exact) > 20
    assert np.max(np.abs(exact - difference) / scale) < 1e-5


@pytest.mark.long
@BOTH
def test_an_event_indicator_of_a_gap_is_the_distance_to_its_face(
    target: Fmu, tmp_path: Path
) -> None:
    """Continuous through zero, where importers look for roots: no sign, no jump. Zero lies 1e-10
    rad past the face, so that whoever lands on zero has touched it.
    """
    half_gap = 0.02600540585471551 / 2.0  # rad, of the thesis
    angles = [half_gap * (0.9 + 0.002 * k) for k in range(101)]
    path = built("thesis-pan-drive", target, tmp_path)
    found = np.array(in_child("indicators", path=path, angles=angles))[:, 1]
    assert found[0] < 0.0 < found[-1]
    assert np.max(np.abs(found - (np.array(angles) - half_gap - 1e-10))) < 1e-15


@pytest.mark.long
@BOTH
def test_a_saved_state_goes_on_as_before(target: Fmu, tmp_path: Path) -> None:
    """Also from its bytes: mid-run in co-simulation, between stick and slip, bit for bit."""
    found = in_child("saved", path=built("thesis-pan-servo", target, tmp_path))
    assert found["moved"] > 1e-4
    assert found["first"] == found["restored"] == found["from_bytes"]


@pytest.mark.long
@BOTH
def test_two_instances_do_not_disturb_each_other(target: Fmu, tmp_path: Path) -> None:
    found = in_child("two", path=built("thesis-pan-drive", target, tmp_path))
    assert found["beside"] == found["alone"]
    assert found["other"] != found["alone"]


@pytest.mark.long
@BOTH
@pytest.mark.parametrize(
    ("parameter", "value", "message"),
    [
        ("b_pan", -1.0, "Parameter 'b_pan': -1 N m s/rad lies outside its bounds [0, "),
        ("F_s_pan", 0.1, "F_s_pan = 0.1 N m: F_s is at least F_c; raise F_s or lower F_c"),
        ("gap_pan", float("nan"), "Parameter 'gap_pan': nan rad lies outside its bounds"),
    ],
)
def test_an_impossible_parameter_is_an_error_with_a_message(
    parameter: str, value: float, message: str, target: Fmu, tmp_path: Path
) -> None:
    path = built("thesis-pan-drive", target, tmp_path)
    found = in_child("impossible", path=path, parameter=parameter, value=value)
    assert found["status"] == 3, "fmi2Error and fmi3Error"
    assert message in found["message"]


@pytest.mark.long
@BOTH
def test_bodies_that_overlap_at_the_start_are_an_error(target: Fmu, tmp_path: Path) -> None:
    path = built("elastic_impact", target, tmp_path)
    found = in_child("impossible", path=path, parameter="theta_gear_pan", value=1.0)
    assert found["status"] == 3
    assert "beyond a rigid face" in found["message"]


@pytest.mark.long
@BOTH
def test_a_token_of_another_model_is_refused(target: Fmu, tmp_path: Path) -> None:
    found = in_child("wrong_token", path=built("thesis-payload", target, tmp_path))
    assert found["refused"]


@pytest.mark.long
@pytest.mark.parametrize("name", NAMES)
def test_the_sources_of_every_effect_compile_without_a_warning(name: str, tmp_path: Path) -> None:
    """With the official headers beside them: a function of another type would be an error."""
    for target in (FMU_2, FMU_3):
        for file, text in target.files(machine_program(name), "machine").items():
            (tmp_path / target.name / file).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / target.name / file).write_text(text)
        for compiler in COMPILERS:
            source = f"fmi{target.version[0]}.c"
            command = [compiler, *STRICT, "-O0", "-shared", "-fPIC", source, "-o", "own.so", "-lm"]
            done = subprocess.run(
                command,
                cwd=tmp_path / target.name / "sources",
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == 0, done.stderr[:2000]


@pytest.mark.long
@BOTH
def test_an_importer_builds_the_sources_by_their_description(
    target: Fmu, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The binary is taken out; FMPy makes its own of what is inside, with CMake."""
    from fmpy import extract
    from fmpy.build import build_platform_binary
    from fmpy.util import create_zip_archive

    monkeypatch.setenv("PATH", str(Path(sys.executable).parent), prepend=os.pathsep)
    if shutil.which("cmake") is None:
        pytest.skip("cmake is not installed")
    folder = Path(extract(str(built("thesis-pan-drive", target, tmp_path))))
    shutil.rmtree(folder / "binaries")
    build_platform_binary(folder)
    own = tmp_path / "own.fmu"
    create_zip_archive(own, folder)
    difference, _ = beside("thesis-pan-drive", own, "CoSimulation", 3.0, 3.0)
    assert difference < 1e-5


@pytest.mark.long
@pytest.mark.parametrize(
    ("target", "task", "package"),
    [
        (FMU_3, "by_ecos", "ecospy"),
        (FMU_2, "by_ecos", "ecospy"),
        (FMU_2, "by_libcosim", "libcosimpy"),
    ],
)
def test_importers_in_c_move_it_as_the_simulator(
    target: Fmu, task: str, package: str, tmp_path: Path
) -> None:
    """Six volts for a second, through stick, slip and gap; libcosim knows FMI 2.0 alone."""
    if importlib.util.find_spec(package) is None:  # found, not loaded: that is left to the child
        pytest.skip(f"pip install {package}")
    path = built("thesis-pan-drive", target, tmp_path)
    found = in_child(task, path=path, volts=6.0, seconds=1.0)
    run = ptp.load("thesis-pan-drive").simulate([0.0, 1.0], u_pan=6.0)
    assert abs(found - run["theta_pan"][-1]) < 1e-7


@pytest.mark.long
def test_zig_builds_for_windows_and_macos(tmp_path: Path) -> None:
    """Binaries begin as those of their systems do: ELF, MZ, Mach-O of 64 bits."""
    pytest.importorskip("ziglang", reason="pip install ziglang")
    platform = read_platform("thesis-ideal")
    (path,), _ = export(platform, "fmu3", tmp_path)
    begins: dict[str, bytes] = {}
    with zipfile.ZipFile(path) as whole:
        for entry in whole.namelist():
            if entry.startswith("binaries/"):
                begins[entry.split("/")[1]] = whole.read(entry)[:4]
    assert begins["x86_64-linux"] == b"\x7fELF"
    assert begins["x86_64-windows"][:2] == b"MZ"
    assert begins["x86_64-darwin"] == begins["aarch64-darwin"] == b"\xcf\xfa\xed\xfe"


def test_units_are_powers_of_base_units() -> None:
    assert base_units("N m s/rad") == {"kg": 1, "m": 2, "s": -1, "rad": -1}
    assert base_units("V/(rad s)") == {"kg": 1, "m": 2, "s": -4, "A": -1, "rad": -1}
    assert base_units("rad/s^2") == {"rad": 1, "s": -2}
    assert base_units("1") == {}
    assert [per_second(u) for u in ("rad", "rad/s", "A", "N m/rad", "1")] == [
        "rad/s",
        "rad/s^2",
        "A/s",
        "N m/(rad s)",
        "1/s",
    ]


def test_a_title_cannot_break_the_description() -> None:
    title = 'A "title" <with> & what\x00 XML & C */ hold ??/'
    own = program_of("thesis-payload")
    hostile = replace(own, equations=replace(own.equations, title=title))
    files = FMU_3.files(hostile, "payload")
    root = ElementTree.fromstring(files["modelDescription.xml"])
    assert root.get("description") == title.replace("\x00", "")
    assert "*/ hold" not in files["sources/payload.h"]


def test_event_indicators_and_modes_are_named_after_what_they_watch() -> None:
    found = variables(program_of("thesis-pan-drive"))
    assert [v.name for v in found.indicators] == ["event(slide_pan)", "event(side_pan)"]
    assert [v.name for v in found.modes] == ["slide_pan", "side_pan", "active_pan"]
    references = {v.name: v.reference for v in found.all}
    by_hand = {"theta_pan": 1, "i_pan": 5, "der(theta_pan)": 6, "u_pan": 11, "J_pan": 14}
    by_hand |= {"N_pan": 31, "event(slide_pan)": 32, "slide_pan": 34, "active_pan": 36}
    assert by_hand.items() <= references.items()


def test_headers_are_those_of_the_standard_with_their_licence() -> None:
    for target in (FMU_2, FMU_3):
        files = target.files(program_of("thesis-payload"), "payload")
        for header in HEADERS[target.version]:
            assert "2-Clause BSD License" in files[f"sources/{header}"]
