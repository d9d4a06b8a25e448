"""Make the logs that ship as `ptp_symbolic/samples/tilted_base`, by MuJoCo.

The platform of the thesis (Tables 5.1 and 5.3) with viscous joints tracks a smooth reference. It is
declared level, yet its base leans by 4 deg: that is what a diagnosis of the sample should find.
MuJoCo is an optional dependency: install the extra `mujoco`.

Usage: python scripts/make_sample_logs.py [--out FOLDER]
"""

import argparse
import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

SAMPLES = Path(__file__).resolve().parent.parent / "ptp_symbolic" / "samples" / "tilted_base"
SAMPLE_PERIOD = 5e-3  # s
INNER_STEPS = 20  # Runge-Kutta steps of 0.25 ms from sample to sample
DURATION = 8.0  # s
COUNTS_PER_REVOLUTION = 7200
TORQUE_DIGITS = 5

GRAVITY = 9.81  # m/s^2
LEAN, AZIMUTH = math.radians(4.0), -0.6  # rad
DAMPING = 0.1  # N m s/rad, both joints
PAYLOAD_MASS, PAYLOAD_LEVER = 4.992, 0.1  # kg, m
STIFFNESS, RATE_GAIN = 20.0, 1.5  # N m/rad, N m s/rad of the tracking controller

COLUMNS = "time [s],pan_torque [N*m],tilt_torque [N*m],pan_angle [rad],tilt_angle [rad]"

MODEL = """
<mujoco>
  <compiler boundmass="0" balanceinertia="false" angle="radian"/>
  <option timestep="{step!r}" integrator="RK4" gravity="0 0 {down!r}"/>
  <worldbody>
    <body name="base" quat="{base}">
      <body name="pan">
        <inertial pos="0 0 0" mass="1" diaginertia="5.3e-4 8.7e-4 5.3e-4"/>
        <joint name="pan" type="hinge" axis="0 0 1" damping="{damping!r}"/>
        <body name="tilt">
          <inertial pos="0 0 0" mass="1" diaginertia="4.1e-4 6.5e-4 2.7e-4"/>
          <joint name="tilt" type="hinge" axis="0 1 0" damping="{damping!r}"/>
          <body name="payload">
            <inertial pos="{lever!r} 0 0" mass="{mass!r}" diaginertia="5.3e-3 6.8e-3 6.8e-3"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""

PLATFORM = """\
# The platform of the thesis (Tables 5.1 and 5.3), torque driven, as its owner declares it: level.
# The logs beside this file come from MuJoCo (scripts/make_sample_logs.py), where the base leans.

[platform]
name = "tilted_base"
title = "Pan-tilt platform with payload, declared level"
axes = ["pan", "tilt"]

[[effects]]
effect = "rigid_bodies"

[[effects]]
effect = "payload"

[[effects]]
effect = "viscous_friction"
axis = "pan"

[[effects]]
effect = "viscous_friction"
axis = "tilt"
"""

KNOWN = (
    ("J_pan", 5.3e-4, "kg m^2"),
    ("J_x_tilt", 4.1e-4, "kg m^2"),
    ("J_y_tilt", 6.5e-4, "kg m^2"),
    ("J_z_tilt", 2.7e-4, "kg m^2"),
    ("m_payload", PAYLOAD_MASS, "kg"),
    ("J_x_payload", 5.3e-3, "kg m^2"),
    ("J_y_payload", 6.8e-3, "kg m^2"),
    ("J_z_payload", 6.8e-3, "kg m^2"),
    ("c_x_payload", PAYLOAD_LEVER, "m"),
    ("c_y_payload", 0.0, "m"),
    ("c_z_payload", 0.0, "m"),
)


class Tone(NamedTuple):
    """One sine of a reference: amplitude in rad, frequency in Hz, phase in rad."""

    amplitude: float
    frequency: float
    phase: float


class Run(NamedTuple):
    """One recording: where it goes, the encoder counts it starts from, its reference."""

    path: str
    start_counts: tuple[int, int]
    pan: tuple[Tone, ...]
    tilt: tuple[Tone, ...]


RUNS = (
    Run(
        "train/tracking_1.csv",
        (0, 240),
        (Tone(0.9, 0.17, 0.3), Tone(0.35, 0.43, 2.1), Tone(0.12, 0.95, 4.0)),
        (Tone(0.55, 0.21, 2.9), Tone(0.25, 0.52, 0.8), Tone(0.08, 1.10, 1.7)),
    ),
    Run(
        "train/tracking_2.csv",
        (-700, -360),
        (Tone(1.0, 0.14, 3.6), Tone(0.30, 0.49, 0.9), Tone(0.10, 1.05, 5.2)),
        (Tone(0.50, 0.24, 0.4), Tone(0.30, 0.45, 4.4), Tone(0.09, 0.98, 3.0)),
    ),
    Run(
        "validate/tracking_3.csv",
        (450, -120),
        (Tone(0.85, 0.19, 5.5), Tone(0.40, 0.39, 1.5), Tone(0.11, 0.88, 0.2)),
        (Tone(0.60, 0.18, 1.2), Tone(0.22, 0.57, 5.0), Tone(0.10, 1.02, 2.2)),
    ),
    Run(
        "validate/tracking_4.csv",
        (-200, 500),
        (Tone(0.95, 0.16, 1.9), Tone(0.33, 0.46, 3.3), Tone(0.13, 1.00, 2.7)),
        (Tone(0.52, 0.23, 4.2), Tone(0.28, 0.48, 2.5), Tone(0.07, 1.15, 0.6)),
    ),
)


def reference(tones: tuple[Tone, ...], start: float, time: float) -> float:
    """Angle in rad asked for at `time` in s: the tones, faded in over a second from `start`."""
    fade = 0.5 - 0.5 * math.cos(math.pi * min(time, 1.0))
    wave = sum(
        tone.amplitude * math.sin(2 * math.pi * tone.frequency * time + tone.phase)
        for tone in tones
    )
    return start + fade * (wave - start)


def torque(run: Run, time: float, angles: NDArray[Any], rates: NDArray[Any]) -> list[float]:
    """Torque [2] in N m of the tracking controller, which takes the base for level."""
    result = []
    for k, tones in enumerate((run.pan, run.tilt)):
        start = run.start_counts[k] * 2 * math.pi / COUNTS_PER_REVOLUTION
        wanted = reference(tones, start, time)
        wanted_rate = (reference(tones, start, time + 1e-4) - wanted) / 1e-4
        result.append(STIFFNESS * (wanted - angles[k]) + RATE_GAIN * (wanted_rate - rates[k]))
    result[1] -= PAYLOAD_MASS * GRAVITY * PAYLOAD_LEVER * math.cos(angles[1])
    return [round(value, TORQUE_DIGITS) for value in result]


def load_model() -> Any:
    """The MuJoCo model of the leaning platform; raises ImportError without MuJoCo.

    Down leans towards the azimuth when the base turns about the horizontal axis left of it.
    """
    import mujoco

    half = math.sin(LEAN / 2)
    quaternion = (math.cos(LEAN / 2), -half * math.sin(AZIMUTH), half * math.cos(AZIMUTH), 0.0)
    return mujoco.MjModel.from_xml_string(
        MODEL.format(
            step=SAMPLE_PERIOD / INNER_STEPS,
            down=-GRAVITY,
            base=" ".join(map(repr, quaternion)),
            damping=DAMPING,
            lever=PAYLOAD_LEVER,
            mass=PAYLOAD_MASS,
        )
    )


def record(model: Any, run: Run) -> list[str]:
    """The rows of one recording: torque held until the next sample, angles in whole counts."""
    import mujoco

    data = mujoco.MjData(model)
    count = 2 * math.pi / COUNTS_PER_REVOLUTION
    data.qpos[:] = np.array(run.start_counts) * count
    rows = []
    for sample in range(round(DURATION / SAMPLE_PERIOD)):
        time = sample * SAMPLE_PERIOD
        applied = torque(run, time, data.qpos, data.qvel)
        angles = np.rint(data.qpos / count) * count + 0.0  # no minus zero in the log
        rows.append(f"{time:.4f},{applied[0]:.5f},{applied[1]:.5f},{angles[0]:.6f},{angles[1]:.6f}")
        data.qfrc_applied[:] = applied
        for _ in range(INNER_STEPS):
            mujoco.mj_step(model, data)
    return rows


def platform_text() -> str:
    """The declared platform as TOML: all known but the viscous friction of both joints."""
    lines = [PLATFORM]
    for name, value, unit in KNOWN:
        lines.append(f'[parameters.{name}]\nvalue = {value!r}\nunit = "{unit}"\n')
    for axis in ("pan", "tilt"):
        lines.append(
            f'[parameters.b_{axis}]\nstart = 0.05\nunit = "N m s/rad"\nbounds = [0.0, 5.0]\n'
        )
    for axis in ("pan", "tilt"):
        lines.append(
            f'[signals.tau_{axis}]\nrole = "input"\ncolumn = "{axis}_torque"\nunit = "N m"\n'
        )
    for axis in ("pan", "tilt"):
        lines.append(
            f'[signals.theta_{axis}]\nrole = "output"\ncolumn = "{axis}_angle"\nunit = "rad"\n'
            f"counts_per_revolution = {COUNTS_PER_REVOLUTION}\n"
        )
    return "\n".join(lines)


def main() -> None:
    """Write the platform and its logs."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, default=SAMPLES, help="folder to write into")
    folder = parser.parse_args().out
    model = load_model()
    for run in RUNS:
        path = folder / run.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join([COLUMNS, *record(model, run)]) + "\n", encoding="utf-8")
    (folder / "platform.toml").write_text(platform_text(), encoding="utf-8")
    print(f"wrote {len(RUNS)} logs and platform.toml into {folder}")


if __name__ == "__main__":
    main()
