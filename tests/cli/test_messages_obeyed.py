"""Every message is obeyed: what a mistake is answered with leads to a fit that runs."""

import re
from pathlib import Path

import numpy as np
import pytest

PLATFORM = """
[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "cable_spring"
axis = "pan"
[parameters]
J_pan = { start = 0.1, bounds = [0.001, 10.0] }
k1_cable_pan = { value = 0.8 }
theta0_cable_pan = { value = 0.3 }
[signals]
tau_pan = { role = "input", column = "torque", unit = "N m" }
theta_pan = { role = "output", column = "enc", unit = "deg", counts_per_revolution = 65536 }
"""
TIME = 0.01 * np.arange(300)
TORQUE = 0.4 * np.sin(3.0 * TIME)


def swing(steps: int = 200) -> np.ndarray:
    """Angle in rad of 0.25 kg m^2 on a spring of 0.8 N m/rad at rest at 0.3 rad, by leapfrog."""
    angle, rate, found, step = 0.3, 0.0, [], 0.01 / steps
    for torque in TORQUE:
        found.append(angle)
        for _ in range(steps):
            rate += step * (torque - 0.8 * (angle - 0.3)) / 0.25
            angle += step * rate
    return np.array(found)


ANGLE = np.degrees(swing())


def rows(time: np.ndarray = TIME, angle: np.ndarray = ANGLE) -> str:
    return "".join(
        f"{t:.6f},{u:.6f},{a:.6f}\n" for t, u, a in zip(time, TORQUE, angle, strict=True)
    )


GOOD = "time [s],torque [N m],enc [deg]\n" + rows()
IN_MS = rows(1e3 * TIME)

# what is wrong in the platform or the log, the message, and what doing as it says makes of them
MISTAKES = {
    "a column without a unit has the declared one": (
        PLATFORM,
        "time [s],torque [N m],enc\n" + rows(),
        None,
        PLATFORM,
        GOOD,
    ),
    "time without a unit": (
        PLATFORM,
        "time,torque [N m],enc [deg]\n" + IN_MS,
        r"steps of 10; write 'time \[s\]' where that is 10 s, 'time \[ms\]' where it is 10 ms",
        PLATFORM,
        "time [ms],torque [N m],enc [deg]\n" + IN_MS,
    ),
    "time in ms declared as s": (
        PLATFORM,
        "time [s],torque [N m],enc [deg]\n" + IN_MS,
        r"one sample every 10 s.*write 'time \[ms\]'",
        PLATFORM,
        "time [ms],torque [N m],enc [deg]\n" + IN_MS,
    ),
    "decimal comma": (
        PLATFORM.replace("start = 0.1,", "start = 0,1,"),
        GOOD,
        r"toml:11:\d+: 0,1 has a decimal comma; write 0.1, with a point",
        PLATFORM,
        GOOD,
    ),
    "a key twice": (
        PLATFORM.replace("[signals]", "J_pan = { value = 1.0 }\n[signals]"),
        GOOD,
        "'J_pan' is there twice; remove one",
        PLATFORM,
        GOOD,
    ),
    "an input declared as an output": (
        PLATFORM.replace('role = "input"', 'role = "output"'),
        GOOD,
        "Signal 'tau_pan' is an input of this platform, .* write role = \"input\"",
        PLATFORM,
        GOOD,
    ),
    "an output declared as an input": (
        PLATFORM.replace('role = "output"', 'role = "input"'),
        GOOD,
        "'theta_pan' is measured: write role = \"output\" there",
        PLATFORM,
        GOOD,
    ),
    "degrees without saying so": (
        PLATFORM.replace("value = 0.3 }", "value = 17.18873 }"),
        GOOD,
        r"'theta0_cable_pan' = 17.1887 rad lies outside its bounds .*; write unit = \"deg\"",
        PLATFORM.replace("value = 0.3 }", 'value = 17.18873, unit = "deg" }'),
        GOOD,
    ),
    "a machine that never moved": (
        PLATFORM,
        "time [s],torque [N m],enc [deg]\n" + rows(angle=np.zeros(300)),
        "without motion nothing can be identified: give logs in which the machine moves",
        PLATFORM,
        GOOD,
    ),
}


def fit(call, folder: Path, platform: str, log: str):
    folder.mkdir()
    (folder / "bench.toml").write_text(platform)
    (folder / "run.csv").write_text(log)
    paths = ("--platform", folder / "bench.toml", folder / "run.csv", "--out", folder / "out")
    return call("fit", *paths)


def assert_fitted(call, folder: Path, platform: str, log: str) -> None:
    done = fit(call, folder, platform, log)
    assert done.code == 0, done.err
    found = re.search(r"J_pan = ([0-9.]+) kg m\^2", done.out)
    assert found is not None, done.out
    assert float(found[1]) == pytest.approx(0.25, rel=1e-3)
    assert (folder / "out" / "fit.json").is_file()


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_message_that_is_obeyed_leads_to_a_fit(call, mistake: str, tmp_path: Path) -> None:
    wrong_platform, wrong_log, message, platform, log = MISTAKES[mistake]
    if message is None:
        assert_fitted(call, tmp_path / "wrong", wrong_platform, wrong_log)
    else:
        done = fit(call, tmp_path / "wrong", wrong_platform, wrong_log)
        assert done.code == 2
        assert re.search(message, done.err), done.err
        assert len(done.err.strip().splitlines()) == 1
        assert not (tmp_path / "wrong" / "out").exists()
    assert_fitted(call, tmp_path / "right", platform, log)


def test_a_platform_file_that_is_not_there_is_said_so(call, tmp_path: Path) -> None:
    done = call("fit", "--platform", "absent.toml", "run.csv", "--out", tmp_path / "out")
    assert done.code == 2
    assert "absent.toml: there is no such file; give the path of a platform TOML" in done.err
