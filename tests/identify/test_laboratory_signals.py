"""Machines are found from what a laboratory measures: PWM, encoder, gyro, current, torque."""

from pathlib import Path

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.fit import fit_platform
from tests.identify.bench_logs import LAGS, NOISE, TRUTH, platform_text, write_logs

EXTRA = ("omega_pan", "i_pan", "tau_shaft_pan", "omega_motor_pan")
MECHANICAL = ("J_pan", "b_pan", "k_shaft_pan")
LEANING = """[platform]
name = "arm"
axes = ["tilt"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "payload"
[signals]
tau_tilt = { role = "input", column = "pwm", unit = "N m", scale = 1.0 }
omega_tilt = { role = "output", column = "enc", unit = "rad/s", scale = 1.0, noise = 1e-3 }
"""


def fitted(folder: Path, text: str, extra: tuple[str, ...]) -> dict:
    path = folder / "bench.toml"
    path.write_text(text, encoding="utf-8")
    return fit_platform(read_platform(path), write_logs(folder, (1, 2), extra)).summary


def test_a_fit_uses_all_signals_at_their_noise(tmp_path: Path) -> None:
    """Begun a factor of 1.7 off in all but inductance, rotor and gear; every signal ends at its
    noise, which it would not with a wrong scale, sign, zero or delay.
    """
    found = fitted(tmp_path, platform_text(tuple(TRUTH), EXTRA), EXTRA)
    for name, value in TRUTH.items():
        estimate = found["parameters"][name]
        assert estimate["value"] == pytest.approx(value, rel=5e-3), name
        low, high = estimate["ci95"]
        assert low - 0.5 * (high - low) <= value <= high + 0.5 * (high - low), name
    left = found["error"]["after"]["by_signal"]
    assert left["theta_pan"]["rmse_counts"] == pytest.approx(0.289, rel=0.05)
    for name in EXTRA:
        assert left[name]["rmse"] == pytest.approx(NOISE[name], rel=0.05), name


def test_a_wrong_delay_shows(tmp_path: Path) -> None:
    """A delay that is declared 3 ms too long leaves more than noise."""
    text = platform_text(MECHANICAL, ("omega_pan",))
    assert text.count('"7 ms"') == 1
    found = fitted(tmp_path, text.replace('"7 ms"', '"10 ms"'), ("omega_pan",))
    left = found["error"]["after"]["by_signal"]
    assert left["theta_pan"]["rmse_counts"] > 3.0
    assert left["omega_pan"]["rmse"] > 2.0 * NOISE["omega_pan"]


def test_a_torque_cell_narrows_the_torque_constant(tmp_path: Path) -> None:
    """Between voltage and angle all torques have a common factor, short of the rotor's share."""
    free = (*MECHANICAL, "K_t_pan", "R_pan", "d_shaft_pan")
    without, beside = (
        fitted(tmp_path, platform_text(free, extra), extra)["parameters"]["K_t_pan"]
        for extra in ((), ("tau_shaft_pan",))
    )
    assert beside["value"] == pytest.approx(TRUTH["K_t_pan"], rel=3e-3)
    (low, high), (lowest, highest) = beside["ci95"], without["ci95"]
    assert 2.0 * (high - low) < highest - lowest


def test_a_rate_alone_is_enough_where_nothing_depends_on_the_angle(tmp_path: Path) -> None:
    lines = platform_text(MECHANICAL, ("omega_pan",)).splitlines()
    kept = [line for line in lines if not line.startswith("theta_pan")]
    found = fitted(tmp_path, "\n".join(kept) + "\n", ("omega_pan",))
    for name in MECHANICAL:
        assert found["parameters"][name]["value"] == pytest.approx(TRUTH[name], rel=5e-3), name
    assert found["error"]["after"]["total"]["rmse"] == pytest.approx(NOISE["omega_pan"], rel=0.05)


def test_a_rate_alone_is_refused_where_gravity_acts(tmp_path: Path) -> None:
    message = r"Axis 'tilt' has a rate and no angle .* declare \[signals.theta_tilt\]"
    with pytest.raises(InputError, match=message):
        fitted(tmp_path, LEANING, ())


def test_a_signal_that_the_machine_has_not_is_refused_with_those_it_has(tmp_path: Path) -> None:
    text = platform_text(MECHANICAL, ("omega_pan",)).replace("omega_pan =", "omega_yaw =")
    has = "theta_pan, i_pan, omega_pan, tau_shaft_pan, omega_x_pan, omega_y_pan, omega_z_pan,"
    has += " omega_motor_pan."
    with pytest.raises(InputError, match=f"'omega_yaw'.* Choose one of: {has}"):
        fitted(tmp_path, text, ("omega_pan",))


def test_filters_of_gyro_and_current_are_found_beside_the_machine(tmp_path: Path) -> None:
    filters = "".join(
        f'[[effects]]\neffect = "measurement_lag"\naxis = "pan"\nkind = "{kind}"\n'
        for kind in ("rate", "current")
    )
    extra = ("omega_pan", "i_pan")
    text = platform_text(MECHANICAL, extra, filters)
    free = "".join(f"{name} = {{ start = 0.005 }}\n" for name in LAGS)
    path = tmp_path / "bench.toml"
    path.write_text(text.replace("[signals]\n", f"{free}[signals]\n"), encoding="utf-8")
    logs = write_logs(tmp_path, (1, 2), extra, filtered=extra)
    found = fit_platform(read_platform(path), logs).summary
    for name, value in LAGS.items():
        assert found["parameters"][name]["value"] == pytest.approx(value, rel=5e-3), name
    low, high = found["parameters"]["t_lag_i_pan"]["ci95"]
    assert low < LAGS["t_lag_i_pan"] < high
    left = found["error"]["after"]["by_signal"]
    for name in extra:
        assert left[name]["rmse"] == pytest.approx(NOISE[name], rel=0.05), name


def test_a_filter_of_a_signal_that_is_no_output_is_refused(tmp_path: Path) -> None:
    lag = '[[effects]]\neffect = "measurement_lag"\naxis = "pan"\nkind = "torque"\n'
    message = r"of kind 'torque' filters 'tau_shaft_pan', .* declare \[signals.tau_shaft_pan\]"
    with pytest.raises(InputError, match=message):
        fitted(tmp_path, platform_text(MECHANICAL, (), lag), ())
