"""Every machine diagnosed anew from its raw files, as data for a page.

The error of a model in force along a measured motion, as the authors of EMPS compute it.

Janot, Gautier and Brunot (Nonlinear Benchmark Workshop 2019): the position goes through a
zero-phase Butterworth filter of order 4 at 100 Hz and is differentiated twice; what the model makes
of it and the measured force are filtered alike and decimated by 10; the error is
100 |y - yhat| / |y|. In a closed loop the error of the position says nothing. They compare the two
forces at the samples; but a force that is held until the next sample acts half a period later.
"""

import csv
import tempfile
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from ptp_symbolic.errors import InputError
from ptp_symbolic.machines.friction_ladder import ladder, mean_error
from ptp_symbolic.machines.injected import INJECTED, Injected, write_injected
from ptp_symbolic.models.inverse_dynamics import Motion, inverse_dynamics
from ptp_symbolic.numeric.data import read_log
from ptp_symbolic.numeric.friction_map.points import Columns, read_points
from ptp_symbolic.numeric.friction_map.summary import friction_map
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from ptp_symbolic.workflows.result import Output, Progress

FloatArray = NDArray[np.float64]


CORNER, ORDER = 100.0, 4  # Hz, of the filter
DECIMATION = 10
EDGE = 5  # decimated samples at either end, where the filters begin and end


def force_error(
    platform: Platform,
    parameters: Mapping[str, float],
    time: FloatArray,
    force: FloatArray,
    position: FloatArray,
    held: bool = False,
) -> float:
    """Relative error in percent of the force that `platform` with `parameters` needs for a motion.

    `time` [k] in s, evenly sampled; `force` [k] in N; `position` [k] in m. A force that is `held`
    from each sample to the next is compared with the mean of what is needed in between; one that
    acts late, where the platform has a delay, with what is needed then.
    """
    period = float(np.median(np.diff(time)))
    smooth = signal.filtfilt(*signal.butter(ORDER, 2.0 * CORNER * period), position)
    speed = np.gradient(smooth, period)
    acceleration = np.gradient(speed, period)
    motion = Motion(smooth[:, None], speed[:, None], acceleration[:, None], time)
    needed = inverse_dynamics(platform, motion, parameters)[:, 0]
    (delay,) = assemble(platform).delays
    needed = np.interp(time + parameters.get(str(delay), 0.0), time, needed)
    if held:
        needed = np.append(0.5 * (needed[1:] + needed[:-1]), needed[-1])
    measured, predicted = (
        signal.decimate(column, DECIMATION, zero_phase=True)[EDGE:-EDGE]
        for column in (force, needed)
    )
    left = np.linalg.norm(measured - predicted)
    return 100.0 * float(left / np.linalg.norm(measured))


PLATFORMS = Path(__file__).parent
EMPS_FILES = ("DATA_EMPS.mat", "DATA_EMPS_PULSES.mat")
SWITCHED_OFF = "lift_and_drop"  # runs of the pendulum in which the servo lets go
NOMINAL = "9.84 mN m"  # torque that the percents of the screw drives are of
DRIVES = ("1", "2", "3")
EMPS = (
    "A. Janot, M. Gautier and M. Brunot, Data Set and Reference Models of EMPS, Nonlinear Benchmark"
    " Workshop, 2019. A carriage on a ball screw in closed loop: force in, position out. Published:"
    " mass 95.1 kg; relative force error 4.08 % on the training and 5.98 % on the validation file"
    " with symmetric friction and an offset."
)
PUT_IN = (
    "Forces of 0.6 N rms, added to the measured force of both files: the same motion of a machine"
    " that has them. The diagnosis of the machine as it is stands above."
)
PENDULUM = (
    "M. Duclusaud, G. Passault, V. Padois and O. Ly, Extended Friction Models for the Physics"
    " Simulation of Servo Actuators, ICRA 2025. A pendulum on a geared servo: voltage in, angle"
    " out."
)
SCREWS = (
    "S. Mablekos-Alexiou et al., IEEE Transactions on Robotics 37(4), 2021. Three screw drives at"
    " steady speeds. Published: Stribeck friction at 6.4 rad/s in drive 1, none in drive 2, at"
    " 0.69 rad/s in drive 3."
)


def machines(data: Path, progress: Progress = lambda text: None) -> dict[str, Any]:
    """Results of all machines whose files are in the folders of `data`.

    Raises InputError where none is there.
    """
    found = [
        study(data / folder, progress)
        for folder, study in (
            ("emps", emps),
            ("emps", forces_put_in),
            ("servo_pendulum", servo_pendulum),
            ("screw_drives", screw_drives),
        )
        if (data / folder).is_dir()
    ]
    if not found:
        raise InputError(
            f"{data}: has none of the folders emps, servo_pendulum and screw_drives;"
            " docs/development/benchmark.md names the sources of their files."
        )
    now = datetime.now(UTC).isoformat(timespec="seconds")
    return {"version": version("ptp-symbolic"), "date": now, "machines": found}


def emps_logs(folder: Path) -> tuple[list[Path], list[Path]]:
    """Training and validation file of EMPS."""
    train, validate = (folder / name for name in EMPS_FILES)
    return [train], [validate]


def pendulum_logs(folder: Path) -> tuple[list[Path], list[Path]]:
    """Training and validation runs of the servo pendulum in which the servo is on."""
    train, validate = (
        [p for p in sorted((folder / part).glob("*.csv")) if not p.name.startswith(SWITCHED_OFF)]
        for part in ("train", "validate")
    )
    return train, validate


def emps(folder: Path, progress: Progress) -> dict[str, Any]:
    """The positioning system: its diagnosis, and its error in force before and after."""
    platform = read_platform(PLATFORMS / "emps.toml")
    logs = emps_logs(folder)
    progress("positioning system")
    found = diagnose_platform(platform, *logs, progress)
    after = _written(found)
    rows = []
    for stage, machine in (("before", platform), ("after", after)):
        values = _values(found, stage)
        for held in (False, True):
            errors = [_force_error(machine, values, log, held) for (log,) in logs]
            rows.append({"stage": stage, "held": held, "train": errors[0], "validate": errors[1]})
    return {**_diagnosis("Positioning system (EMPS)", EMPS, found), "force_error": rows}


def forces_put_in(folder: Path, progress: Progress) -> dict[str, Any]:
    """The positioning system with forces put into its measured force: what is named, beside what
    the machine has as it is, and of which size.
    """
    rows = [force_put_in(force, folder, progress) for force in INJECTED]
    return {"title": "Forces put into the positioning system", "source": PUT_IN, "put_in": rows}


def force_put_in(force: Injected, folder: Path, progress: Progress) -> dict[str, Any]:
    """The positioning system with one force put in."""
    progress(f"positioning system with {force.title}")
    platform = read_platform(PLATFORMS / "emps.toml")
    (driving,) = (s for s in platform.signals if s.role == "input")
    with tempfile.TemporaryDirectory() as scratch:
        for name in EMPS_FILES:
            write_injected(force, driving, folder / name, Path(scratch) / name)
        found = diagnose_platform(platform, *emps_logs(Path(scratch)), progress)
    named = [added["effect"] for added in found.summary["added"]]
    row = {
        "title": force.title,
        "effect": force.effect,
        "verdict": found.summary["verdict"],
        "named": named,
        "size": {"unit": force.unit, "put_in": force.size, "found": None},
        "wave": None,
        "error": found.summary["error"],
        "parameters": found.summary["fit"]["after"]["parameters"],
    }
    if force.effect in named:
        values = _values(found, "after")
        row["size"]["found"] = force.found(values)
        if force.wave is not None:
            name, wave = force.wave
            row["wave"] = {"unit": "rad/m", "put_in": wave, "found": values[name]}
    return row


def servo_pendulum(folder: Path, progress: Progress) -> dict[str, Any]:
    """The pendulum on a servo: its diagnosis, and laws of friction each with one part more."""
    platform = read_platform(PLATFORMS / "servo_pendulum.toml")
    progress("servo pendulum")
    logs = pendulum_logs(folder)
    found = diagnose_platform(platform, *logs, progress)
    errors = []
    for stage, machine in (("before", platform), ("after", _written(found))):
        train, validate = (mean_error(machine, _values(found, stage), part) for part in logs)
        errors.append({"stage": stage, "train": train, "validate": validate})
    rungs = ladder(platform, *logs, progress)
    own = {"position_error": errors, "ladder": rungs}
    return {**_diagnosis("Pendulum on a geared servo", PENDULUM, found), **own}


def screw_drives(folder: Path, progress: Progress) -> dict[str, Any]:
    """The friction maps of the screw drives."""
    progress("screw drives")
    with (folder / "derived_steady_state_points.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    maps = []
    with tempfile.TemporaryDirectory() as scratch:
        for drive in DRIVES:
            own = [row for row in rows if row["drive"] == drive]
            points = [(r["v_mean_rpm_raw_sign"], r["torque_mean_pct_raw_sign"]) for r in own]
            path = Path(scratch) / f"drive_{drive}.csv"
            lines = [f"rate [rpm],torque [% of {NOMINAL}]", *map(",".join, points)]
            path.write_text("\n".join(lines) + "\n", encoding="utf-8")
            maps.append({"drive": drive, **friction_map(read_points(path, Columns()), "pan", 0.95)})
    return {"title": "Screw drives", "source": SCREWS, "maps": maps}


def _diagnosis(title: str, source: str, found: Output) -> dict[str, Any]:
    kept = ("verdict", "summary", "added", "error", "held_out", "ranking", "refused", "hints")
    own = {key: found.summary[key] for key in (*kept, "fit", "provenance")}
    return {"title": title, "source": source, **own}


def _values(found: Output, stage: str) -> dict[str, float]:
    """The fitted values of a diagnosis, "before" or "after" what was missing was added."""
    fitted = found.summary["fit"][stage]["parameters"]
    return {name: row["value"] for name, row in fitted.items()}


def _written(found: Output) -> Platform:
    """The extended platform of a diagnosis."""
    text = found.files["platform.toml"]
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / "platform.toml"
        path.write_text(str(text), encoding="utf-8")
        return read_platform(path)


def _force_error(platform: Platform, values: Mapping[str, float], path: Path, held: bool) -> float:
    log = read_log(path, platform)
    return force_error(platform, values, log.time, log.inputs[:, 0], log.outputs[:, 0], held)
