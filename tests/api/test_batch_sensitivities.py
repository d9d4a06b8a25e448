"""Sensitivities of batches: closed forms, differences of single runs through events, failures."""

import tracemalloc

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.api import batch as engine
from ptp_symbolic.errors import InputError

TORQUE, END = 0.1, 0.1
BARE = {"J_x_tilt": 1e-12, "J_z_tilt": 1e-12}  # what turns with the pan axis beside its own inertia


def rate(inertia: float, damping: float, start: float, t: np.ndarray) -> np.ndarray:
    """Rate of a wheel under a torque: the solution of J w' = tau - b w."""
    decay = np.exp(-damping * t / inertia)
    return TORQUE / damping * (1.0 - decay) + start * decay


def quotient(number, point: list[float], k: int) -> np.ndarray:
    """Central difference of a closed form by its k-th argument."""
    h = 1e-6 * abs(point[k])
    ends = [number(*(v + sign * h * (j == k) for j, v in enumerate(point))) for sign in (1.0, -1.0)]
    return (ends[0] - ends[1]) / (2.0 * h)


def test_numbers_and_signals_of_a_wheel_by_closed_form() -> None:
    """By a parameter, an initial state and a parameter again, in the order in which they stand."""
    inertias, dampings, starts = [2e-3, 3e-3], [0.05, 0.02], [9.0, -4.0]
    t = np.linspace(0.0, END, 51)
    texts = ["omega_pan", "final(omega_pan)", "rms(omega_pan)", "rms_error(omega_pan; 1.5)"]
    batch = ptp.simulate_batch(
        "ideal",
        t,
        J_pan=inertias,
        b_pan=dampings,
        x0={"omega_pan": starts},
        tau_pan=TORQUE,
        outputs=[*texts, "largest(omega_pan)"],
        sensitivities=["b_pan", "omega_pan", "J_pan"],
        rtol=1e-11,
        atol=1e-11,
        **BARE,
    )
    numbers = [
        lambda b, w, j: rate(j, b, w, t),
        lambda b, w, j: rate(j, b, w, t)[-1],
        lambda b, w, j: np.sqrt(np.mean(rate(j, b, w, t) ** 2)),
        lambda b, w, j: np.sqrt(np.mean((rate(j, b, w, t) - 1.5) ** 2)),
        lambda b, w, j: np.abs(rate(j, b, w, t)).max(),
    ]
    for run, point in enumerate(zip(dampings, starts, inertias, strict=True)):
        for text, number in zip((*texts, "largest(omega_pan)"), numbers, strict=True):
            for k, by in enumerate(("b_pan", "omega_pan", "J_pan")):
                exact = quotient(number, list(point), k)
                size = max(1e-12, float(np.abs(exact).max()))
                found = batch.sensitivity(text, by)[run]
                assert np.abs(found - exact).max() < 1e-6 * size, (text, by)


def test_through_stick_slip_and_gap_as_differences_of_single_runs() -> None:
    """Machines with friction and backlash, by a loss and the current at the start."""
    times, given = np.linspace(0.0, 1.0, 101), {"u_pan": "multisine:3@2,3"}
    losses = ptp.load("pan_drive").defaults["F_c_pan"] * np.array([0.9, 1.2])
    texts = ["final(theta_pan)", "rms(omega_pan)", "largest(theta_pan)"]
    tight = {"rtol": 1e-11, "atol": 1e-12}
    batch = ptp.simulate_batch(
        "pan_drive",
        times,
        F_c_pan=losses,
        outputs=["theta_pan", *texts],
        sensitivities=["i_pan", "F_c_pan"],
        **given,
        **tight,
    )

    def numbers(loss: float, current: float) -> np.ndarray:
        run = ptp.simulate(
            "pan_drive", times, F_c_pan=loss, x0={"i_pan": current}, **given, **tight
        )
        assert len(run.events) > 8
        theta, omega = run["theta_pan"], run["omega_pan"]
        return np.array([theta[-1], np.sqrt(np.mean(omega**2)), np.abs(theta).max()])

    for b, loss in enumerate(losses):
        alone = ptp.sensitivity(
            "pan_drive",
            times,
            F_c_pan=loss,
            by_parameters=["F_c_pan"],
            by_initial=["i_pan"],
            **given,
            **tight,
        ).states[:, 0]
        assert np.array_equal(batch.sensitivity("theta_pan", "F_c_pan")[b], alone[:, 0])
        assert np.array_equal(batch.sensitivity("theta_pan", "i_pan")[b], alone[:, 1])
        of_loss = (numbers(loss * 1.0001, 0.0) - numbers(loss * 0.9999, 0.0)) / (2e-4 * loss)
        of_current = (numbers(loss, 1e-3) - numbers(loss, -1e-3)) / 2e-3
        for name, difference in (("F_c_pan", of_loss), ("i_pan", of_current)):
            found = np.array([batch.sensitivity(text, name)[b] for text in texts])
            assert np.abs(found - difference) == pytest.approx(
                0.0, abs=1e-4 * np.abs(difference).max()
            )


def test_the_pointing_error_of_a_machine_at_rest_by_geometry() -> None:
    """The angle between two lines in space, differentiated by the angles of one of them."""
    text = "pointing_error(theta_pan = 0.5; theta_tilt = -0.2)"
    starts = {"theta_pan": [0.2, 0.7], "theta_tilt": [0.4, -1.1]}
    batch = ptp.simulate_batch(
        "payload", 0.01, x0=starts, gravity=0.0, outputs=[text], sensitivities=list(starts)
    )

    def line(pan: float, tilt: float) -> np.ndarray:
        return np.array([np.cos(pan) * np.cos(tilt), np.sin(pan) * np.cos(tilt), np.sin(tilt)])

    def error(pan: float, tilt: float) -> np.ndarray:
        return np.arccos(line(pan, tilt) @ line(0.5, -0.2))

    for b, point in enumerate(zip(*starts.values(), strict=True)):
        for k, name in enumerate(starts):
            exact = quotient(error, list(point), k)
            assert batch.sensitivity(text, name)[b] == pytest.approx(float(exact), rel=1e-6)


def test_a_function_returns_its_jacobian_beside_its_values() -> None:
    """w(t) = w0 + tau t / J without damping, at two points and at one."""
    f = ptp.batch_function(
        "ideal",
        ["omega_pan", "J_pan"],
        ["final(omega_pan)", "final(theta_pan)"],
        END,
        jac=True,
        tau_pan=TORQUE,
        b_pan=0.0,
        **BARE,
    )
    points = np.array([[1.0, 2e-3], [-2.0, 1e-3]])
    values, slopes = f(points)
    start, inertia = points.T
    momentum = TORQUE * END
    assert values[:, 0] == pytest.approx(start + momentum / inertia, rel=1e-6)
    assert slopes.shape == (2, 2, 2)
    assert slopes[:, 0, 0] == pytest.approx(1.0) and slopes[:, 1, 0] == pytest.approx(END)
    assert slopes[:, 0, 1] == pytest.approx(-momentum / inertia**2, rel=1e-6)
    assert slopes[:, 1, 1] == pytest.approx(-0.5 * momentum * END / inertia**2, rel=1e-6)
    one_value, one_slope = f(points[1])
    assert np.array_equal(one_value, values[1]) and np.array_equal(one_slope, slopes[1])


def test_a_failed_run_leaves_nan_and_chunks_change_no_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    damping = np.array([0.1, -1.0, 0.2, 0.3, 0.4])

    def run() -> ptp.Batch:
        return ptp.simulate_batch(
            "ideal",
            np.linspace(0.0, END, 11),
            b_pan=damping,
            tau_pan=TORQUE,
            outputs=["rms(omega_pan)", "theta_pan"],
            sensitivities=["b_pan", "J_pan"],
            threads=2,
        )

    whole = run()
    monkeypatch.setattr(engine, "CHUNK_BYTES", 1.0)
    pieces = run()
    assert whole.status.tolist() == ["done", "impossible", "done", "done", "done"]
    for name in ("rms(omega_pan)", "theta_pan"):
        found = whole.sensitivities[name]
        assert np.isnan(found[1]).all() and np.isfinite(found[whole.ok]).all()
        assert np.array_equal(found, pieces.sensitivities[name], equal_nan=True)
    columns = whole.table()
    assert np.array_equal(
        columns["d rms(omega_pan) / d b_pan"][whole.ok],
        whole.sensitivity("rms(omega_pan)", "b_pan")[whole.ok],
    )


def test_tangents_in_memory_are_those_of_a_chunk(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 128 runs at 201 times, derivatives of 4 states by all parameters would be 5 MB."""
    machine, chunk = ptp.load("ideal"), 5e5
    monkeypatch.setattr(engine, "CHUNK_BYTES", chunk)
    given = {
        "b_pan": np.linspace(0.1, 0.2, 128),
        "outputs": ["rms(theta_pan)"],
        "sensitivities": machine.parameter_names,
    }
    times = np.linspace(0.0, 0.01, 201)
    ptp.simulate_batch(machine, times, **given | {"b_pan": [0.1]})
    tracemalloc.start()
    ptp.simulate_batch(machine, times, **given)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    whole = 128 * 201 * 4 * (1 + len(machine.parameter_names)) * 8
    assert peak < 3.0 * chunk < 0.5 * whole


def test_a_dataset_has_derivatives_under_names_that_files_can_have() -> None:
    pytest.importorskip("xarray", reason="the extra python")
    batch = ptp.simulate_batch(
        "ideal",
        np.linspace(0.0, 0.01, 3),
        J_pan=[1e-3, 2e-3],
        tau_pan=TORQUE,
        outputs=["theta_pan", "final(omega_pan)"],
        sensitivities=["J_pan"],
    )
    found = batch.to_xarray()
    assert found["d final(omega_pan) by J_pan"].dims == ("run",)
    assert found["d theta_pan by J_pan"].dims == ("run", "time")
    assert not [name for name in found.variables if "/" in str(name)]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"sensitivities": ["nope"]}, "nope"),
        (
            {"sensitivities": ["J_pan"], "outputs": ["settling_time(theta_pan; 0.1)"]},
            "settling_time.* has no derivative",
        ),
        ({"sensitivities": ["J_pan"], "device": "gpu"}, "GPU computes no sensitivities"),
        (
            {
                "sensitivities": ["J_pan"],
                "outputs": "all",
                "b_pan": np.broadcast_to(0.1, 5 * 10**7),
            },
            "need .* GB",
        ),
    ],
)
def test_what_cannot_be_differentiated_is_said_in_one_line(given: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        ptp.simulate_batch("ideal", 10.0, **given)


def test_names_that_were_not_asked_for_are_listed() -> None:
    batch = ptp.simulate_batch("ideal", 0.01, sensitivities=["b_pan"])
    with pytest.raises(KeyError, match="b_pan"):
        batch.sensitivity("omega_pan", "J_pan")
