"""`ptp-symbolic sweep`: rows against a closed form, whole chunks whatever happens, a cluster."""

import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Call

parquet = pytest.importorskip("pyarrow.parquet", reason="the extra sweep")
TORQUE, TIME, INERTIA = 0.1, 0.4, 2e-3
PLATFORM = """
[platform]
name = "wheel"
title = "Wheel"
axes = ["pan"]

[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "viscous_friction"
axis = "pan"

[parameters]
J_pan = { start = 2e-3, unit = "kg m^2" }
b_pan = { start = 0.05, unit = "N m s/rad" }
"""
SETTINGS = (
    *("--vary", "b_pan=loguniform:0.02:0.2", "--vary", "omega_pan=normal:0:1"),
    *("--input", f"tau_pan=constant:{TORQUE}", "--duration", TIME, "--every", 0.01),
    *("--samples", 40, "--chunk", 16, "--output", "final(omega_pan)", "--signal", "omega_pan"),
)


@pytest.fixture
def wheel(tmp_path: Path) -> Path:
    path = tmp_path / "wheel.toml"
    path.write_text(PLATFORM)
    return path


def rate(damping: np.ndarray, start: np.ndarray, t: np.ndarray) -> np.ndarray:
    """The closed form of J w' = tau - b w."""
    steady = TORQUE / damping
    return steady + (start - steady) * np.exp(-damping * t / INERTIA)


def rows_of(out: Path) -> dict[str, np.ndarray]:
    table = parquet.read_table(out / "trajectories")
    return {name: table[name].to_numpy() for name in table.column_names}


def parts_of(out: Path) -> list[bytes]:
    return [path.read_bytes() for path in sorted((out / "trajectories").glob("part-*.parquet"))]


def test_every_row_has_the_derivatives_of_its_numbers(
    call: Call, wheel: Path, tmp_path: Path
) -> None:
    out, by = tmp_path / "out", ("--sensitivity", "omega_pan", "--sensitivity", "b_pan")
    done = call("sweep", "--platform", wheel, *SETTINGS, *by, "--out", out)
    assert done.code == 0, done
    rows, h = rows_of(out), 1e-7
    damping, start, t = rows["b_pan"], rows["omega_pan"], np.array(TIME)
    of_start = rows["d final(omega_pan) / d omega_pan"]
    assert of_start == pytest.approx(np.exp(-damping * TIME / INERTIA), rel=1e-4, abs=1e-7)
    exact = (rate(damping + h, start, t) - rate(damping - h, start, t)) / (2.0 * h)
    of_damping = rows["d final(omega_pan) / d b_pan"]
    assert of_damping == pytest.approx(exact, rel=1e-3)
    summary = json.loads((out / "summary.json").read_text())["outputs"]["final(omega_pan)"]
    found = summary["sensitivities"]["b_pan"]
    assert found["mean"] == pytest.approx(of_damping.mean())
    assert found["rms"] == pytest.approx(np.sqrt(np.mean(of_damping**2)))
    refused = call("sweep", "--platform", wheel, *SETTINGS, "--sensitivity", "x", "--out", out)
    assert refused.code == 2 and "x" in refused.err


def test_every_row_is_the_closed_form_of_its_values(
    call: Call, wheel: Path, tmp_path: Path
) -> None:
    pytest.importorskip("zarr", reason="the extra sweep")
    xarray = pytest.importorskip("xarray", reason="the extra sweep")
    out = tmp_path / "out"
    done = call("sweep", "--platform", wheel, *SETTINGS, "--whole", "--out", out)
    assert done.code == 0 and done.out.startswith("40 runs, 0 failed"), done
    rows = rows_of(out)
    assert rows["run"].tolist() == list(range(40)) and set(rows["status"]) == {"done"}
    truth = rate(rows["b_pan"], rows["omega_pan"], np.array(TIME))
    assert rows["final(omega_pan)"] == pytest.approx(truth, rel=1e-5, abs=1e-6)
    whole = xarray.open_zarr(out / "trajectories.zarr", consolidated=False)
    t = whole["time"].to_numpy()
    curves = rate(rows["b_pan"][:, None], rows["omega_pan"][:, None], t[None])
    assert np.abs(whole["omega_pan"].to_numpy() - curves).max() < 1e-4
    bands = np.genfromtxt(out / "bands.csv", delimiter=",", skip_header=1)
    assert bands[:, 0] == pytest.approx(t)
    assert bands[:, 1:] == pytest.approx(
        np.quantile(curves, [0.05, 0.25, 0.5, 0.75, 0.95], axis=0).T, abs=1e-3
    )
    assert (out / "sweep.png").read_bytes()[:4] == b"\x89PNG"


def test_the_samples_have_their_distributions(call: Call, wheel: Path, tmp_path: Path) -> None:
    """Sobol points: quantiles are far nearer than those of random numbers."""
    vary = tmp_path / "vary.toml"
    vary.write_text('J_pan = "1 g m^2:3 g m^2"\nb_pan = "triangular:0.1:0.2:0.4"\n')
    given = ("--vary", vary, "--samples", 512, "--duration", 0.01, "--seed", 3, "--no-bands")
    assert call("sweep", "--platform", wheel, *given, "--out", tmp_path / "out").code == 0
    rows = rows_of(tmp_path / "out")
    assert not (tmp_path / "out" / "bands.csv").exists()
    assert np.median(rows["J_pan"]) == pytest.approx(2e-3, rel=0.01)
    assert rows["J_pan"].min() > 1e-3 and rows["J_pan"].max() < 3e-3
    assert rows["b_pan"].mean() == pytest.approx(0.7 / 3.0, rel=0.01)


@pytest.mark.long
def test_a_killed_sweep_goes_on_from_whole_chunks(call: Call, wheel: Path, tmp_path: Path) -> None:
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    given = ("sweep", "--platform", wheel, *SETTINGS, "--chunk", 1)
    assert call(*given, "--out", whole).code == 0
    command = [sys.executable, "-m", "ptp_symbolic", *map(str, given), "--out", str(killed)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not parts_of(killed) and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert 1 <= len(parts_of(killed)) <= 40
    if len(parts_of(killed)) < 40:
        refused = call(*given, "--out", killed)
        assert refused.code == 2 and "--resume" in refused.err
        before = {p: p.stat().st_mtime_ns for p in (killed / "trajectories").iterdir()}
        assert call(*given, "--out", killed, "--resume").code == 0
        after = {p: p.stat().st_mtime_ns for p in (killed / "trajectories").iterdir()}
        assert {p: after[p] for p in before if p in after} == {
            p: t for p, t in before.items() if p.suffix == ".parquet"
        }
    assert parts_of(killed) == parts_of(whole)


@pytest.mark.long
@pytest.mark.skipif(os.name != "posix", reason="limits the size of files as POSIX does")
def test_a_disk_that_takes_no_more_is_one_line(wheel: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    given = ("sweep", "--platform", wheel, *SETTINGS, "--out", out)
    command = [sys.executable, "-m", "ptp_symbolic", *map(str, given)]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048)),
    )
    assert done.returncode == 2
    assert "0 of 3 chunks are whole; make room and add --resume" in done.stderr
    assert done.stderr.count("\n") == 1 and parts_of(out) == []


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("--vary", "nope=1:2"), "nope"),
        (("--vary", "b_pan=2:1"), "2 is not below 1 N m s/rad"),
        (("--vary", "b_pan=normal:1"), "NAME=normal:MEAN:SD"),
        (("--vary", "b_pan=1 kg:2 kg"), "kg"),
        ((), "Nothing varies"),
        (("--vary", "b_pan=1:2", "--samples", 10**8, "--chunk", 10**8), "GB of memory"),
        (("--vary", "b_pan=1:2", "--samples", 10**9), "GB on disk"),
        (("--vary", "b_pan=1:2", "--cluster", "tcp://127.0.0.1:1"), "No Dask scheduler answers"),
    ],
)
def test_what_cannot_be_is_said_before_anything_is_written(
    given: tuple[object, ...], said: str, call: Call, wheel: Path, tmp_path: Path
) -> None:
    if "--cluster" in given:
        pytest.importorskip("distributed", reason="the extra cluster")
    done = call("sweep", "--platform", wheel, *given, "--out", tmp_path / "out")
    assert done.code == 2 and said in done.err and done.err.count("\n") == 1, done
    assert not (tmp_path / "out").exists()


@pytest.mark.long
def test_a_cluster_computes_the_same_bits_though_a_worker_is_killed(
    call: Call, wheel: Path, tmp_path: Path
) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra cluster")
    given = ("sweep", "--platform", wheel, *SETTINGS, "--samples", 4000, "--chunk", 50)
    assert call(*given, "--out", tmp_path / "one").code == 0
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        address = cluster.scheduler_address
        with distributed.Client(address) as client:
            victim = next(iter(client.run(os.getpid).values()))
        command = [sys.executable, "-m", "ptp_symbolic", *map(str, given)]
        command += ["--cluster", address, "--out", str(tmp_path / "many")]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while len(parts_of(tmp_path / "many")) < 5 and process.poll() is None:
            time.sleep(0.01)
        assert process.poll() is None, "the worker must be killed in the middle"
        os.kill(victim, signal.SIGKILL)
        assert process.wait(120) == 0
    assert parts_of(tmp_path / "many") == parts_of(tmp_path / "one")
