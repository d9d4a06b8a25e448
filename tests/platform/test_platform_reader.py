"""A platform TOML is read into SI data, and every mistake in it is refused in one line."""

import math
from pathlib import Path

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    SignalDeclaration,
    read_platform,
)

HEAD = """
[platform]
name = "bench"
title = "Pan axis on the bench"
axes = ["pan"]
"""
EFFECTS = """
[[effects]]
effect = "rigid_bodies"

[[effects]]
effect = "csvs_friction"
axis = "pan"
site = "gear"
"""
PARAMETERS = """
[parameters.gap_pan]
value = 1.5
unit = "deg"

[parameters.F_s_pan]
same_as = "F_c_pan"

[parameters.F_c_pan]
start = 240
unit = "mN m"
bounds = [0, 5000]

[parameters.N_pan]
value = 500
"""
SIGNALS = """
[signals.u_pan]
role = "input"
column = "pan voltage"
unit = "V"
noise = 0.008

[signals.theta_pan]
role = "output"
column = "pan_angle"
unit = "deg"
counts_per_revolution = 7200
noise = 0.1
"""
GOOD = HEAD + EFFECTS + PARAMETERS + SIGNALS


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "bench.toml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_every_entry_arrives_in_si(tmp_path: Path) -> None:
    degree = math.pi / 180
    platform = read_platform(write(tmp_path, GOOD))
    assert platform == Platform(
        name="bench",
        title="Pan axis on the bench",
        axes=("pan",),
        gravity=9.81,
        effects=(
            EffectDeclaration("rigid_bodies", None, None),
            EffectDeclaration("csvs_friction", "pan", "gear"),
        ),
        parameters=(
            ParameterDeclaration("gap_pan", "rad", 1.5 * degree),
            ParameterDeclaration("F_s_pan", "N m", 0.24, same_as="F_c_pan"),
            ParameterDeclaration("F_c_pan", "N m", 0.24, True, 0.0, 5.0),
            ParameterDeclaration("N_pan", None, 500.0),
        ),
        signals=(
            SignalDeclaration("u_pan", "pan voltage", "V", "input", None, 0.008),
            SignalDeclaration(
                "theta_pan", "pan_angle", "rad", "output", 7200, 0.1 * degree, column_unit="deg"
            ),
        ),
    )


def test_title_parameters_and_signals_may_be_left_out(tmp_path: Path) -> None:
    text = '[platform]\nname = "bench"\naxes = ["tilt", "pan"]\n' + '[[effects]]\neffect = "a"\n'
    platform = read_platform(write(tmp_path, text))
    assert platform.title == "bench"
    assert platform.axes == ("pan", "tilt")
    assert platform.parameters == platform.signals == ()


@pytest.mark.parametrize("text", ["\ufeff" + GOOD, GOOD.replace("\n", "\r\n")])
def test_files_from_other_systems_read_the_same(tmp_path: Path, text: str) -> None:
    expected = read_platform(write(tmp_path, GOOD))
    assert read_platform(write(tmp_path, text)) == expected


def line_of(text: str) -> int:
    return GOOD[: GOOD.index(text)].count("\n") + 1


GAP, COUNTS = line_of("value = 1.5"), line_of("= 7200")

# (what is replaced, by what, what the refusal says)
REFUSALS = [
    ('name = "bench"\n', "", r"platform: 'name' is missing"),
    (
        "[platform]",
        "[platfrom]",
        r"bench.toml: unknown key 'platfrom'; allowed are effects, fit, l",
    ),
    ('title = "Pan', 'titel = "Pan', r"platform: unknown key 'titel'; allowed are axes, gravity"),
    ('name = "bench"', 'name = "my-bench"', r"platform.name: 'my-bench' is not a name; use 1 to"),
    ('name = "bench"', 'name = "class"', r"platform.name: 'class' is a Python keyword"),
    ('name = "bench"', f'name = "a{"b" * 64}"', r"is not a name"),
    ('name = "bench"', 'name = "b\u00e4nch"', r"is not a name"),
    ('name = "bench"', 'name = "bench\\n"', r"is not a name"),
    ('name = "bench"', "name = 3", r"platform.name: 3 is not a name"),
    ('title = "Pan axis', 'title = "Pan\\u001b[2J', r"platform.title: .* has control characters"),
    ('title = "Pan axis', 'title = "Pan\\naxis', r"platform.title: .* has control characters"),
    ('title = "Pan', f'title = "{"P" * 300}', r"must have 1 to 200 characters"),
    ('"Pan axis on the bench"', "true", r"platform.title: True is not a text; write it in quotes"),
    ('axes = ["pan"]', 'axes = ["pan", "roll"]', r"platform.axes: 'roll' is not one of pan, tilt"),
    ('axes = ["pan"]', 'axes = ["pan", "pan"]', r"platform.axes: \['pan', 'pan'\] names an axis"),
    ('axes = ["pan"]', "axes = []", r"platform.axes: \[\]: write a list of pan, tilt"),
    ('axes = ["pan"]', 'axes = "pan"', r"platform.axes: 'pan': write a list"),
    ('axes = ["pan"]', "axes = [[1]]", r"platform.axes: \[1\] is not one of"),
    ('axes = ["pan"]', 'axes = ["pan"]\ngravity = -9.81', r"gravity: -9.81 m/s\^2 is negative"),
    ('axes = ["pan"]', 'axes = ["pan"]\ngravity = true', r"gravity: True is not a number"),
    (EFFECTS, "", r"bench.toml: 'effects' is missing"),
    ('effect = "rigid_bodies"', "", r"effects\[1\]: 'effect' is missing"),
    ('site = "gear"', 'site = "motor"', r"effects\[2\] csvs_friction.site: 'motor' is not one of"),
    ('axis = "pan"', 'axis = "tilt"', r"effects\[2\] csvs_friction.axis: 'tilt' is not one of pan"),
    ('axis = "pan"', "axis = 1", r"csvs_friction.axis: 1 is not one of pan"),
    ('site = "gear"', 'place = "gear"', r"effects\[2\]: unknown key 'place'; allowed are axis,"),
    (EFFECTS, EFFECTS + EFFECTS, r"effects\[3\] rigid_bodies: is declared twice; remove one"),
    (
        EFFECTS,
        EFFECTS + '[[effects]]\neffect = "csvs_friction"\naxis = "pan"\nsite = "joint"\n',
        r"effects\[3\] csvs_friction: is declared twice on axis pan",
    ),
    ("gap_pan", "gap-pan", r"parameters: 'gap-pan' is not a name"),
    ("gap_pan", "lambda", r"parameters: 'lambda' is a Python keyword"),
    ("gap_pan", "\"__import__('os')\"", r"is not a name"),
    ("value = 1.5", 'value = "1.5"', r"parameters.gap_pan.value: '1.5' is not a number; write it"),
    ("value = 1.5", "value = true", r"parameters.gap_pan.value: True is not a number"),
    ("value = 1.5", "value = nan", r"parameters: nan is no value; give that of gap_pan"),
    ("value = 1.5", "value = -inf", r"parameters.gap_pan.value: -inf is not a finite number"),
    ("value = 1.5", f"value = 1{'0' * 400}", r"parameters.gap_pan.value: 10* ?.* not a finite"),
    ("value = 1.5", "value = 2020-01-01", r"gap_pan.value: datetime.* is not a number"),
    ("value = 1.5\n", "", r"parameters.gap_pan: has no value; give exactly one of value"),
    ("value = 1.5", "value = 1.5\nstart = 1", r"gap_pan: has value and start; give exactly one"),
    ("value = 1.5", "vaule = 1.5", r"gap_pan: unknown key 'vaule'; allowed are bounds, same_as"),
    ("[parameters.gap_pan]\nvalue = 1.5\n", "[parameters]\ngap_pan = 1.5\n", r"1.5 is not a table"),
    ('unit = "deg"', 'unit = "degrees per fortnit"', r"gap_pan.unit: .* is not a unit; write fac"),
    ('unit = "deg"', 'unit = "9**9**9**9"', r"gap_pan.unit: .* is not a unit"),
    ('unit = "deg"', 'unit = "degC"', r"gap_pan.unit: Unit 'degree_Celsius' has an offset"),
    ('unit = "deg"', "unit = 1", r"gap_pan.unit: 1 is not a text"),
    (
        "start = 240",
        "start = -240",
        r"F_c_pan.start: -240 mN m lies outside its bounds \[0, 5000\] mN m; change one",
    ),
    ("[0, 5000]", "[5000, 0]", r"F_c_pan.bounds: \[5000, 0\] mN m: the lower bound comes first"),
    ("[0, 5000]", "[0, 0]", r"F_c_pan.bounds: \[0, 0\] mN m: the lower bound comes first"),
    ("[0, 5000]", "[0]", r"F_c_pan.bounds: \[0\]: write two numbers"),
    ("[0, 5000]", "[0, inf]", r"F_c_pan.bounds: inf is not a finite number"),
    ("[0, 5000]", "[false, 1]", r"F_c_pan.bounds: False is not a number"),
    ('same_as = "F_c_pan"', 'same_as = "F_v_pan"', r"F_s_pan.same_as: 'F_v_pan' is not a param"),
    ('same_as = "F_c_pan"', 'same_as = "F_s_pan"', r"F_s_pan.same_as: 'F_s_pan' is not a param"),
    ('same_as = "F_c_pan"', "same_as = [1]", r"F_s_pan.same_as: \[1\] is not a parameter"),
    ('same_as = "F_c_pan"', 'same_as = "F_c_pan"\nunit = "N m"', r"F_s_pan: a tied .* remove unit"),
    ('role = "input"', 'role = "setpoint"', r"signals.u_pan.role: 'setpoint' is not one of input"),
    ('role = "input"\n', "", r"signals.u_pan: 'role' is missing"),
    ('unit = "V"\n', "", r"signals.u_pan: 'unit' is missing"),
    ('column = "pan voltage"\n', "", r"signals.u_pan: 'column' is missing"),
    ('"pan voltage"', '"pan voltage [V]"', r"u_pan.column: .*: give the CSV column without its"),
    ('"pan voltage"', '"time"', r"u_pan.column: .* 'time' is the time base"),
    ('"pan voltage"', '"pan_angle"', r"theta_pan.column: 'pan_angle' is also the column of u_pan"),
    ("noise = 0.008", "noise = -0.008", r"signals.u_pan.noise: -0.008 V rms is negative"),
    ("noise = 0.008", "counts_per_revolution = 4", r"u_pan.counts_per_revolution: only for an an"),
    ("= 7200", "= 0", r"theta_pan.counts_per_revolution: 0 is not a whole number"),
    ("= 7200", "= 7200.0", r"theta_pan.counts_per_revolution: 7200.0 is not a whole number"),
    ("= 7200", "= true", r"theta_pan.counts_per_revolution: True is not a whole number"),
    ("[signals.u_pan]", "[signals.u-pan]", r"signals: 'u-pan' is not a name"),
    ("value = 1.5", "value = 1.5 deg", rf"bench.toml:{GAP}:13: is not TOML: Expected newl"),
    (
        "value = 1.5",
        "value = 1.5\nvalue = 2",
        rf"toml:{GAP + 1}:10: is not TOML: .value. is th",
    ),
    ("= 7200", '= "7200', rf"bench.toml:{COUNTS}:30: is not TOML: Illegal character"),
    ("value = 1.5", f"value = {'9' * 450}", r"is not a finite number"),
    ("value = 1.5", f"value = {'9' * 5000}", rf"bench.toml:{GAP}: line has more than 500 char"),
    ("value = 1.5", f"value = {'[' * 490}", r"bench.toml.*(nested too deep|is not TOML)"),
]


@pytest.mark.parametrize(("old", "new", "message"), REFUSALS, ids=[m for *_, m in REFUSALS])
def test_a_mistake_is_refused_in_one_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in GOOD
    path = write(tmp_path, GOOD.replace(old, new, 1))
    with pytest.raises(InputError, match=message) as refusal:
        read_platform(path)
    assert "\n" not in str(refusal.value)
    assert str(refusal.value).startswith(str(path))
    assert len(str(refusal.value)) < len(str(path)) + 300


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("effects = 3" + HEAD, r"effects: write at least one \[\[effects\]\] table"),
        ("effects = []" + HEAD, r"effects: write at least one"),
        ("effects = [1]" + HEAD, r"effects\[1\]: 1 is not a table; write it as a TOML table"),
        ('platform = "bench"' + EFFECTS, r"platform: 'bench' is not a table"),
        ("parameters = []" + HEAD + EFFECTS, r"parameters: \[\] is not a table"),
        ("signals.u_pan = 1" + HEAD + EFFECTS, r"signals.u_pan: 1 is not a table"),
    ],
)
def test_a_wrong_shape_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_platform(write(tmp_path, text))


def test_a_file_that_ends_too_early_is_refused_with_its_last_line(tmp_path: Path) -> None:
    path = write(tmp_path, '[platform]\nname = """bench')
    with pytest.raises(InputError, match=r"bench.toml:2:16: is not TOML"):
        read_platform(path)


def test_brackets_over_many_lines_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path, "x = " + "[\n" * 20_000)
    with pytest.raises(InputError, match="nested too deep"):
        read_platform(path)


def test_an_integer_of_many_digits_over_the_limit_of_the_interpreter_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ptp_symbolic.platform.reader._MAX_LINE", 10_000)
    path = write(tmp_path, GOOD.replace("value = 1.5", f"value = {'9' * 5000}"))
    with pytest.raises(InputError, match="is not TOML: Exceeds the limit"):
        read_platform(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "'platform' is missing"),
        (GOOD.encode() + b"\0", r"bench.toml:42: is not text \(byte 0x00\)"),
        (b"# \xff\n" + GOOD.encode(), r"bench.toml:1: is not text \(byte 0xff, not UTF-8\)"),
        (GOOD.encode("utf-16"), "is not text"),
        (b"#" * 1_000_001, r"is larger than 1 MB, the most for a platform TOML"),
    ],
)
def test_a_file_that_is_no_platform_text_is_refused(
    tmp_path: Path, content: bytes, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        read_platform(write(tmp_path, content))


def test_missing_files_and_folders_are_refused_with_the_presets(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"Unknown platform 'thesis-idael': did you mean 'thesis-"):
        read_platform("thesis-idael")
    with pytest.raises(InputError, match=r"bench.toml: there is no such file; give the path of"):
        read_platform(tmp_path / "bench.toml")
    with pytest.raises(InputError, match="is a folder; give a platform TOML"):
        read_platform(tmp_path)
    for strange in ("a\0b", "x" * 5000, ""):
        with pytest.raises(InputError):
            read_platform(strange)
