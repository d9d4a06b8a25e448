"""Batches: equal to single runs, one failure beside many, numbers of a trajectory, functions."""

import numpy as np
import pytest
from scipy import stats

import ptp_symbolic as ptp
from ptp_symbolic.errors import InputError

INERTIA, DAMPING, TORQUE = 2e-3, 0.05, 0.1


def test_a_machine_with_friction_runs_bit_for_bit_as_alone() -> None:
    inertias, angles = np.array([1.0, 1.1, 1.3]), np.array([0.0, 0.01, -0.02])
    own = ptp.load("pan_drive").defaults["J_pan"] * inertias
    batch = ptp.simulate_batch(
        "pan_drive", 0.5, u_pan="step:12@0.1", J_pan=own, x0={"omega_pan": angles}, outputs="all"
    )
    for b in range(3):
        run = ptp.simulate(
            "pan_drive",
            0.5,
            u_pan="step:12@0.1",
            J_pan=own[b],
            x0={"omega_pan": angles[b]},
            ledger=False,
        )
        for name in run.state_names:
            assert np.array_equal(batch[name][b], run[name])


def spun_up(damping: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Rate of a wheel under a torque: the closed form of J w' = tau - b w."""
    return TORQUE / damping * (1.0 - np.exp(-damping * t / INERTIA))


def test_a_batch_follows_the_closed_form_and_reports_the_impossible() -> None:
    damping = np.array([0.02, -1.0, 0.05, np.nan, 0.2])
    batch = ptp.simulate_batch(
        "ideal",
        0.4,
        J_pan=INERTIA,
        J_z_tilt=1e-12,
        J_x_tilt=1e-12,
        b_pan=damping,
        tau_pan=TORQUE,
        outputs=["omega_pan", "final(omega_pan)", "largest(omega_pan)"],
    )
    assert batch.status.tolist() == ["done", "impossible", "done", "impossible", "done"]
    assert "b_pan" in batch.reasons[1] and "-1" in batch.reasons[1] and set(batch.reasons) == {1, 3}
    ok = batch.ok
    truth = spun_up(damping[ok][:, None], batch.t[None])
    assert np.abs(batch["omega_pan"][ok] - truth).max() < 1e-6
    assert np.isnan(batch["omega_pan"][~ok]).all() and np.isnan(batch["final(omega_pan)"][1])
    assert np.array_equal(batch["final(omega_pan)"][ok], batch["omega_pan"][ok, -1])
    assert np.array_equal(batch["largest(omega_pan)"][ok], batch["omega_pan"][ok].max(axis=1))


def test_numbers_of_a_trajectory_by_hand() -> None:
    """A wheel that spins up: w = w1 (1 - exp(-t / T)), T = J / b = 40 ms."""
    time_constant, w1 = INERTIA / DAMPING, TORQUE / DAMPING
    band = 0.02 * w1
    texts = [
        "rms(omega_pan)",
        f"settling_time(omega_pan; {band})",
        f"rms_error(omega_pan; {w1} rad/s)",
        "largest_error(omega_pan; 1.5)",
    ]
    batch = ptp.simulate_batch(
        "ideal",
        (0.0, 1.0),
        b_pan=[DAMPING],
        J_pan=INERTIA,
        J_x_tilt=1e-12,
        J_z_tilt=1e-12,
        tau_pan=TORQUE,
        outputs=texts,
    )
    decay = np.exp(-np.linspace(0.0, 1.0, 1001) / time_constant)
    found = [float(batch[text][0]) for text in texts]
    assert found[0] == pytest.approx(w1 * np.sqrt(np.mean((1.0 - decay) ** 2)), rel=1e-6)
    assert found[1] == pytest.approx(time_constant * np.log(50.0), abs=1e-3)
    assert found[2] == pytest.approx(w1 * np.sqrt(np.mean(decay**2)), rel=1e-6)
    assert found[3] == pytest.approx(1.5, rel=1e-9)
    assert batch.units[texts[1]] == "s"


def test_the_pointing_error_is_the_angle_between_lines_of_sight() -> None:
    text = "largest_pointing_error(theta_pan = 90 deg; theta_tilt = 0.4)"
    batch = ptp.simulate_batch(
        "payload", 0.1, x0={"theta_tilt": [0.4, 0.7]}, gravity=0.0, outputs=[text]
    )
    aim = np.array([0.0, np.cos(0.4), np.sin(0.4)])
    for tilt, found in zip((0.4, 0.7), batch[text], strict=True):
        line = np.array([np.cos(tilt), 0.0, np.sin(tilt)])
        assert found == pytest.approx(np.arccos(line @ aim), rel=1e-12)


def test_noise_has_its_size_and_follows_from_the_seed() -> None:
    same = {"outputs": ["theta_pan"], "noise": {"theta_pan": "1 mrad"}, "b_pan": [0.1, 0.1, 0.1]}
    batch = ptp.simulate_batch("ideal", 5.0, seeds=[5, 6, 5], **same)
    noise = batch["theta_pan"]
    assert np.array_equal(noise[0], noise[2]) and not np.array_equal(noise[0], noise[1])
    low, high = stats.chi2.ppf([1e-4, 1 - 1e-4], noise[0].size)
    assert low < np.sum((noise[0] / 1e-3) ** 2) < high
    assert ptp.simulate_batch("ideal", 0.1, seeds=3, b_pan=[0.1] * 2).seeds.tolist() == [3, 4]


def test_every_run_may_have_inputs_of_its_own() -> None:
    torques = [0.1, 0.2, -0.1]
    batch = ptp.simulate_batch(
        "ideal",
        0.4,
        [{"tau_pan": f"constant:{torque}"} for torque in torques],
        J_pan=INERTIA,
        J_x_tilt=1e-12,
        J_z_tilt=1e-12,
        b_pan=DAMPING,
    )
    truth = spun_up(np.array(DAMPING), np.array(0.4)) * np.array(torques) / TORQUE
    assert batch["omega_pan"] == pytest.approx(truth, rel=1e-6)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"b_pan": [0.1, 0.2], "x0": {"omega_pan": [1.0]}}, "'b_pan' has 2, 'omega_pan' has 1"),
        ({"b_pan": [[0.1]]}, r"shape \(1, 1\)"),
        ({"nope": [1.0]}, "nope"),
        ({"outputs": ["largest(nope)"]}, "nope"),
        ({"outputs": ["biggest(theta_pan)"]}, "largest"),
        ({"outputs": ["settling_time(theta_pan)"]}, "BAND"),
        ({"outputs": ["rms_error(theta_pan; 3 kg)"]}, "kg"),
        ({"seeds": -1}, "-1"),
        ({"outputs": "all", "b_pan": np.broadcast_to(0.1, 10**8)}, "100000000 runs .* need .* GB"),
    ],
)
def test_what_is_wrong_for_all_runs_is_said_in_one_line(given: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        ptp.simulate_batch("ideal", 10.0, **given)


def test_indices_of_sobol_of_a_function_whose_variance_is_known() -> None:
    """The final rate of a wheel without damping is tau t / J: of inertia and start, w = w0 + c / J.

    With w0 and 1/J independent, first-order indices are the shares of both variances.
    """
    f = ptp.batch_function(
        "ideal",
        ["J_pan", "omega_pan"],
        ["final(omega_pan)"],
        0.1,
        tau_pan=0.1,
        b_pan=0.0,
        J_x_tilt=1e-12,
        J_z_tilt=1e-12,
    )
    inertia, start = stats.uniform(1e-3, 1e-3), stats.uniform(0.0, 4.0)
    found = stats.sobol_indices(
        func=lambda x: f(x.T).T, n=2048, dists=[inertia, start], rng=np.random.default_rng(2)
    )
    mean, square = np.log(2.0) / 1e-3, 0.5 / 1e-6  # of 1/J, uniform J
    of_inertia, of_start = (0.01) ** 2 * (square - mean**2), 16.0 / 12.0
    shares = np.array([of_inertia, of_start]) / (of_inertia + of_start)
    assert np.abs(found.first_order.reshape(-1) - shares).max() < 0.02


def test_salib_takes_the_function_as_it_is() -> None:
    sobol = pytest.importorskip("SALib.sample.sobol", reason="the extra sensitivity")
    from SALib.analyze import morris as of_morris
    from SALib.analyze import sobol as of_sobol
    from SALib.sample import morris

    f = ptp.batch_function(
        "ideal",
        ["J_pan", "b_tilt"],
        ["final(omega_pan)"],
        0.1,
        tau_pan=0.1,
        b_pan=0.0,
        J_x_tilt=1e-12,
        J_z_tilt=1e-12,
    )
    problem = {"num_vars": 2, "names": ["J_pan", "b_tilt"], "bounds": [[1e-3, 2e-3], [0.1, 0.2]]}
    first = of_sobol.analyze(problem, f(sobol.sample(problem, 256))[:, 0], seed=1)
    assert first["S1"][0] == pytest.approx(1.0, abs=3 * first["S1_conf"][0] + 1e-3)
    assert abs(first["ST"][1]) < 1e-6
    points = morris.sample(problem, 16, seed=1)
    effects = of_morris.analyze(problem, points, f(points)[:, 0], seed=1)
    assert effects["mu_star"][0] > 1.0 and effects["mu_star"][1] < 1e-6
