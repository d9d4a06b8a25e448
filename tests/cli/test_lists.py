"""The catalogue at the command line: names are never cut, and one effect is explained whole."""

import json

import pytest

from ptp_symbolic.symbolic.effects import EFFECTS


def test_names_are_whole_through_a_pipe(call, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    lines = call("effects").out.splitlines()
    kinds = [kind for effect in EFFECTS for kind in (effect, *effect.kinds)]
    assert [line.split()[0] for line in lines[1:]] == [kind.id for kind in kinds]
    assert all(kind.reference in line for kind, line in zip(kinds[:14], lines[1:], strict=False))
    assert "thesis-tilt-drive-stroke-48" in call("platforms").out


@pytest.mark.parametrize("effect", [effect.id for effect in EFFECTS])
def test_every_effect_is_explained(call, effect: str) -> None:
    done = call("effects", effect)
    assert (done.code, done.err) == (0, "")
    assert "reference: " in done.out
    told = json.loads(call("effects", effect, "--json").out)
    for kind in told["kinds"]:
        for need in kind["needs"]:
            assert need["from"]
        for parameter in kind["parameters"]:
            assert parameter["name"] in done.out
            assert parameter["meaning"] in done.out
            assert len(parameter["bounds"]) == 2


def test_friction_has_its_parameters_with_units_and_bounds(call) -> None:
    text = call("effects", "csvs_friction").out
    assert "F_c_<axis>  N m        none: declare it  0 to 10000" in text
    assert "to separate it: Crawl through standstill" in text
    needs = call("effects", "direction_dependent_friction").out
    assert "needs csvs_friction" in needs


def test_an_unknown_effect_is_refused_with_the_nearest(call) -> None:
    done = call("effects", "csvs_frictoin")
    assert done.code == 2
    assert "Unknown effect 'csvs_frictoin'; the nearest are csvs_friction," in done.err


def test_an_unknown_effect_is_refused_with_three_near_ones_and_where_all_are(call) -> None:
    told = call("effects", "frictoin").err
    assert "the nearest are csvs_friction, lugre_friction, friction_drift." in told
    assert "`ptp-symbolic effects` lists all." in told
    assert "backlash" not in told


def test_what_an_effect_needs_says_what_to_declare(call) -> None:
    told = call("effects", "torque_proportional_loss").out
    assert "needs any axis without prescribed_motion and without rigid backlash (transm" in told
    told = call("effects", "pwm_drive").out
    assert "needs dc_motor or linear_actuator (" in told
    assert "): declare one of them too" in told
