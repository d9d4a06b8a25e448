"""An accelerometer on a pan body that a late torque turns: readings and sensitivities, closed form.

At x from the axis it reads x tau(t - d) / J across, -x omega^2 along, and 9.81 m/s^2 upwards.
"""

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.inputs import ramp
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration
from ptp_symbolic.symbolic.derivation.assembly import assemble

PLACE, INERTIA, DELAY, SLOPE = 0.2, 0.05, 0.03, 0.4  # m, kg m^2, s, N m/s
EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("imu", None, None),
    EffectDeclaration("input_delay", "pan", None),
)
SIGNALS = tuple(SignalDeclaration(f"specific_force_{k}_imu", k, "m/s^2", "output") for k in "xyz")
PLATFORM = Platform("late", "Late torque", ("pan",), 9.81, EFFECTS, (), SIGNALS)


def test_readings_follow_the_torque_when_it_acts() -> None:
    times = np.linspace(0.1, 0.9, 9)
    given = {"tau_pan": ramp(0.0, SLOPE, 0.0, 1.0)}
    (delay,) = (p.name for p in emission.emit(PLATFORM).parameters if p.unit == "s")
    values = {"J_pan": INERTIA, "x_imu": PLACE, delay: DELAY}
    names = ("J_pan", "x_imu", delay)
    model = emission.emit(PLATFORM)
    found = ptp.sensitivity(model, np.array([0.0, *times]), given, values, by_parameters=names)
    acting = SLOPE * (times - DELAY)
    across = model.output_names.index("specific_force_y_imu")
    expected = PLACE * acting / INERTIA
    assert found.y[1:, across] == pytest.approx(expected, rel=1e-7)
    by = found.signals[1:, across]
    assert by[:, 0] == pytest.approx(-expected / INERTIA, rel=1e-6)
    assert by[:, 1] == pytest.approx(expected / PLACE, rel=1e-6)
    assert by[:, 2] == pytest.approx(np.full(9, -PLACE * SLOPE / INERTIA), rel=1e-6)
    rate = acting * (times - DELAY) / (2.0 * INERTIA)
    along = model.output_names.index("specific_force_x_imu")
    assert found.y[1:, along] == pytest.approx(-PLACE * rate**2, rel=1e-6)
    assert found.y[1:, along + 2] == pytest.approx(np.full(9, 9.81), rel=1e-12)


def test_readings_of_a_batch_are_differentiated_by_delay_and_inertia() -> None:
    times, inertias = np.linspace(0.1, 0.9, 9), np.array([0.05, 0.08])
    model = emission.emit(PLATFORM)
    (delay,) = (p.name for p in model.parameters if p.unit == "s")
    across, along = "specific_force_y_imu", "rms(specific_force_x_imu)"
    batch = ptp.simulate_batch(
        model,
        np.array([0.0, *times]),
        [{"tau_pan": ramp(0.0, SLOPE, 0.0, 1.0)}] * 2,
        {"J_pan": inertias, "x_imu": PLACE, delay: DELAY},
        outputs=[across, along],
        sensitivities=[delay, "J_pan"],
    )
    acting = SLOPE * (times - DELAY)
    for b, inertia in enumerate(inertias):
        exact = -PLACE * acting / inertia**2
        assert batch.sensitivity(across, "J_pan")[b, 1:] == pytest.approx(exact, rel=1e-6)
        exact = np.full(9, -PLACE * SLOPE / inertia)
        assert batch.sensitivity(across, delay)[b, 1:] == pytest.approx(exact, rel=1e-6)
        rates = np.array([0.0, *acting * (times - DELAY) / (2.0 * inertia)])
        size = PLACE * np.sqrt(np.mean(rates**4))
        assert batch.sensitivity(along, "J_pan")[b] == pytest.approx(
            -2.0 * size / inertia, rel=1e-6
        )


def test_a_linear_joint_carries_no_imu() -> None:
    slide = Platform("s", "s", ("pan",), 9.81, EFFECTS[:2], (), (), linear_axes=("pan",))
    with pytest.raises(InputError, match="'imu' makes no sense on a linear joint: it is mounted"):
        assemble(slide)
