"""What a platform says of effects and parameters: refusals name the file and the next step."""

from pathlib import Path

import pytest

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.models import emission
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.symbolic.derivation.placement import place_effects, undeclared_parameters

HEAD = """[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
"""
FRICTION = """[[effects]]
effect = "csvs_friction"
axis = "pan"
"""


def declared(folder: Path, text: str) -> Platform:
    path = folder / "bench.toml"
    path.write_text(HEAD + text, encoding="utf-8")
    return read_platform(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            '[[effects]]\neffect = "csvs_frictoin"\naxis = "pan"',
            "Unknown effect 'csvs_frictoin'; the nearest are csvs_friction, ",
        ),
        (
            '[[effects]]\neffect = "base_tilt"',
            "Effect 'base_tilt' has no effect: no declared body has a mass off its axis; declare"
            " payload or pan_com_offset too, or remove it.",
        ),
        (
            '[[effects]]\neffect = "winding_heating"\naxis = "pan"',
            "declare dc_motor or linear_actuator on axis 'pan' too, or remove it.",
        ),
        (
            '[[effects]]\neffect = "product_of_inertia"',
            "which no declared effect defines; no effect does on a platform of pan; remove it.",
        ),
        (
            FRICTION + "[parameters]\nF_c_pam = { value = 0.1 }",
            "Parameter 'F_c_pam' belongs to no declared effect: did you mean 'F_c_pan'? Known",
        ),
        (
            "[parameters]\nF_c_pan = { value = 0.1 }",
            "Parameter 'F_c_pan' belongs to no declared effect: it is of csvs_friction or lugre_",
        ),
        (
            '[parameters]\nJ_pan = { value = -1.0, unit = "kg m^2" }',
            "'J_pan' = -1 kg m^2 lies outside its bounds [1e-12, 10000] kg m^2; change the value.",
        ),
    ],
)
def test_they_name_the_file_and_what_to_do(tmp_path: Path, text: str, message: str) -> None:
    platform = declared(tmp_path, text)
    with pytest.raises(InputError) as refused:
        place_effects(platform)
    assert str(refused.value).startswith(f"{tmp_path / 'bench.toml'}: ")
    assert message in str(refused.value)


def test_a_value_that_nobody_wrote_is_called_default(tmp_path: Path) -> None:
    platform = declared(tmp_path, FRICTION + "[parameters]\nF_c_pan = { value = 1.0 }")
    with pytest.raises(InputError) as refused:
        emission.emit(platform)
    assert "Impossible F_c_pan = 1 N m, F_s_pan = 0.675 N m (default): " in str(refused.value)
    assert str(refused.value).startswith(f"{tmp_path / 'bench.toml'}: ")


def test_what_is_not_declared_keeps_the_default_of_the_catalogue(tmp_path: Path) -> None:
    platform = declared(tmp_path, FRICTION + "[parameters]\nF_c_pan = { value = 0.1 }")
    left = {parameter.name: parameter.default for parameter in undeclared_parameters(platform)}
    assert left == {"J_pan": 5.3e-4, "F_s_pan": 0.675, "v_s_pan": 0.016, "F_v_pan": 13.9424}


def test_a_number_without_unit_is_in_the_si_unit_of_the_effect(tmp_path: Path) -> None:
    plain, given = (
        declared(tmp_path, f"[parameters]\nJ_pan = {{ value = {text} }}")
        for text in ("0.002", '2.0e4, unit = "g cm^2"')
    )
    assert emission.emit(plain).defaults == pytest.approx(emission.emit(given).defaults, rel=1e-12)


def test_the_source_of_a_platform_is_no_part_of_what_it_says(tmp_path: Path) -> None:
    text = (tmp_path / "bench.toml", tmp_path / "copy.toml")
    for path in text:
        path.write_text(HEAD, encoding="utf-8")
    first, second = map(read_platform, text)
    assert first == second and first.source != second.source


def test_names_that_are_near_nothing_get_the_list_alone() -> None:
    assert str(unknown("state", "x", ("omega_pan", "theta_pan"))) == (
        "Unknown state 'x'. Choose one of: omega_pan, theta_pan."
    )
