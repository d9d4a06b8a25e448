"""The packaged platforms and those of the field logs say what the thesis and the logs say."""

import math
from pathlib import Path

import pytest

from ptp_symbolic.platform import Platform, preset_names, read_platform

PLATFORMS = Path(__file__).parents[1] / "platforms"


def values(platform: Platform) -> dict[str, float]:
    return {parameter.name: parameter.value for parameter in platform.parameters}


def test_the_presets_are_named_after_their_files() -> None:
    named = [name.removeprefix("thesis-").replace("-", "_") for name in preset_names()]
    assert named == [
        "full",
        "ideal",
        "pan_drive",
        "pan_servo",
        "payload",
        "tilt_drive",
        "tilt_drive_stroke_48",
    ]
    assert [read_platform(preset).name for preset in preset_names()] == named


@pytest.mark.parametrize("preset", preset_names())
def test_a_preset_is_fully_known(preset: str) -> None:
    platform = read_platform(preset)
    assert not any(parameter.free for parameter in platform.parameters)
    assert {signal.role for signal in platform.signals} == {"input", "output"}


def test_the_ideal_platform_is_table_5_1() -> None:
    assert values(read_platform("thesis-ideal")) == {
        "J_pan": 5.3e-4,
        "J_x_tilt": 4.1e-4,
        "J_y_tilt": 6.5e-4,
        "J_z_tilt": 2.7e-4,
        "b_pan": 0.1,
        "b_tilt": 0.1,
    }


def test_the_payload_is_table_5_3_with_the_offset_of_erratum_18() -> None:
    payload = values(read_platform("thesis-payload"))
    assert payload["m_payload"] == 4.992
    assert [payload[f"c_{k}_payload"] for k in "xyz"] == [0.1, 0.0, 0.0]
    assert [payload[f"J_{k}_payload"] for k in "xyz"] == [5.3e-3, 6.8e-3, 6.8e-3]
    assert payload.items() >= values(read_platform("thesis-ideal")).items()


def test_the_pan_drive_is_table_5_7() -> None:
    drive = values(read_platform("thesis-pan-drive"))
    table = {
        "L_pan": 6.9e-3,
        "R_pan": 12.9,
        "K_t_pan": 0.0724,
        "J_motor_pan": 1.1e-5,
        "N_pan": 500.0,
        "k_shaft_pan": 5000.0,
        "b_pan": 2.0,
        "J_pan": 0.05,
        "gap_pan": math.radians(1.49),
    }
    assert drive.items() >= table.items()


def test_the_tilt_drive_is_tables_5_5_and_5_6_with_either_initial_stroke() -> None:
    table = {
        "L_tilt": 9.35e-3,
        "R_tilt": 17.0,
        "K_t_tilt": 0.044,
        "J_motor_tilt": 1.62e-6,
        "b_motor_tilt": 1.1696e-4,
        "N_tilt": 93.0,
        "lead_tilt": 4e-3,
        "d_screw_tilt": 8e-3,
        "f_screw_tilt": 0.15,
        "l_ground_tilt": 0.19755,
        "l_min_tilt": 0.139,
        "r_arm_tilt": 0.0634133,
        "m_payload": 6.3785,
        "c_z_payload": 0.0876228,
        "b_tilt": 10.0,
        "J_y_payload": 1.36e-2,
        "s_start_tilt": 0.0405022,
    }
    for name in table:
        drive = values(read_platform("thesis-tilt-drive"))
        assert drive[name] == pytest.approx(table[name], rel=1e-12)
    other = values(read_platform("thesis-tilt-drive-stroke-48"))
    assert other == {**drive, "s_start_tilt": 0.0485}


def test_the_whole_machine_has_both_drives() -> None:
    full = values(read_platform("thesis-full"))
    pan, tilt = (values(read_platform(f"thesis-{axis}-drive")) for axis in ("pan", "tilt"))
    assert full.items() >= {k: v for k, v in pan.items() if k != "J_pan"}.items()
    assert full.items() >= tilt.items()
    assert full["J_pan"] + full["J_z_tilt"] + full["J_z_payload"] == pytest.approx(pan["J_pan"])


def test_the_friction_of_the_pan_drive_is_table_4_1_in_either_direction() -> None:
    drive = values(read_platform("thesis-pan-drive"))
    table = {  # omega > 0, omega < 0
        "F_c_pan": (0.2267, 0.2535),
        "F_s_pan": (0.5578, 0.7922),
        "v_s_pan": (0.0159, 0.0161),
        "F_v_pan": (13.5844, 14.3004),
    }
    for name, (forward, backward) in table.items():
        assert drive[name] * (1 + drive[f"a_{name}"]) == pytest.approx(forward, rel=1e-12)
        assert drive[name] * (1 - drive[f"a_{name}"]) == pytest.approx(backward, rel=1e-12)


def test_the_field_logs_start_from_the_friction_tables() -> None:
    known = values(read_platform("thesis-pan-drive"))
    pwm = values(read_platform(PLATFORMS / "fieldlog_pan.toml"))
    dc = values(read_platform(PLATFORMS / "fieldlog_pan_dc.toml"))
    friction = ["F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan"]
    assert [pwm[name] for name in friction] == [known[name] for name in friction]
    # Table 4.2: J, Fs, Fc, vs, Fv; five tests with omega > 0, five with omega < 0.
    tests = [
        (0.0503, 7.203, 5.936, 0.0427, 5.304),
        (0.0504, 7.511, 5.699, 0.0363, 6.523),
        (0.05, 8.1, 6.029, 0.0492, 5.483),
        (0.05, 7.81, 5.89, 0.0457, 5.5),
        (0.0506, 6.6, 5.549, 0.0138, 5.374),
        (0.0495, 6.504, 5.354, 0.0972, 7.601),
        (0.0497, 8.0, 5.001, 0.0926, 6.95),
        (0.0498, 7.702, 4.991, 0.1096, 5.835),
        (0.0499, 7.298, 5.372, 0.1109, 6.446),
        (0.0501, 7.771, 5.791, 0.066, 5.334),
    ]
    means = (sum(column) / 10 for column in zip(*tests, strict=True))
    _, static, coulomb, stribeck, viscous = means
    expected = (coulomb, static, stribeck, viscous)
    assert [dc[name] for name in friction] == pytest.approx(expected, rel=1e-12)
    assert {name: value for name, value in dc.items() if name not in friction} == {
        name: value for name, value in pwm.items() if name not in friction
    }


@pytest.mark.parametrize(
    ("file", "free"),
    [
        (
            "fieldlog_pan",
            {"J_pan", "b_pan", "d_shaft_pan", "F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan"},
        ),
        (
            "fieldlog_pan_dc",
            {"J_pan", "b_pan", "d_shaft_pan", "F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan"},
        ),
        ("fieldlog_two_axis", {"b_pan", "b_tilt", "F_c_pan", "F_c_tilt"}),
    ],
)
def test_the_field_logs_fit_what_they_do_not_know(file: str, free: set[str]) -> None:
    platform = read_platform(PLATFORMS / f"{file}.toml")
    assert platform.name == file
    assert {parameter.name for parameter in platform.parameters if parameter.free} == free
    for parameter in platform.parameters:
        assert (parameter.lower is not None) == parameter.free
        assert parameter.unit is not None
    for signal in platform.signals:
        assert signal.counts_per_revolution == (7200 if "angle" in signal.column else None)


def test_two_axis_friction_is_coulomb_alone() -> None:
    platform = read_platform(PLATFORMS / "fieldlog_two_axis.toml")
    declared = {parameter.name: parameter for parameter in platform.parameters}
    for axis in platform.axes:
        assert declared[f"F_s_{axis}"].same_as == f"F_c_{axis}"
        assert declared[f"F_s_{axis}"].value == declared[f"F_c_{axis}"].value == 0.05
        assert declared[f"F_v_{axis}"].value == 0.0
    inertia = [declared[name].value for name in ("J_pan", "J_x_tilt", "J_y_tilt", "J_z_tilt")]
    assert inertia == [0.012, 0.0041, 0.0065, 0.0027]
