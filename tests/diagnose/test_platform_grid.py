"""A diagnosis comes to a verdict on every platform: one axis and two, torques and motors, rigid and
with shafts, each effect left out in turn, and with an axis that never moves.

Logs are short, and the search has next to no time: what is asked is that no kind of platform ends
in a traceback, that a verdict is one of those that there are, and that nothing is missing where
nothing was left out.
"""

from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.diagnose.candidates import find_candidates, with_all_they_need
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform

VERDICTS = {
    "nothing_missing",
    "explained",
    "explained_up_to_group",
    "partly_explained",
    "unexplained",
}
TIMES = 0.01 * np.arange(150)  # s
COUNT = 2.0 * np.pi / 36000.0  # rad
SEARCH = 1.0  # s
DRIVES = {"torque": (), "motor": ("dc_motor",), "shaft": ("dc_motor", "shaft_compliance")}
FRICTION = ("viscous_friction", "csvs_friction")
INPUTS = {"torque": ("tau", "N m", [0.6, 0.3]), "motor": ("u", "V", [9.0, 5.0])}
VALUES = {  # a machine that is light enough to move; F_s is F_c
    "dc_motor": {
        "L": "value = 2e-3",
        "R": "value = 3.0",
        "K_t": "value = 0.05",
        "N": "value = 60.0",
    },
    "viscous_friction": {"b": "start = 0.15, bounds = [0.0, 9.0]"},
    "csvs_friction": {
        "F_c": "start = 0.06, bounds = [0.0, 9.0]",
        "F_s": 'same_as = "F_c_{axis}"',
        "F_v": "value = 0.0",
    },
}


@dataclass(frozen=True)
class Case:
    """Axes, what drives them, the effect that is left out, and the axis that rests throughout."""

    axes: tuple[str, ...]
    drive: str
    missing: str | None = None
    resting: str | None = None

    def __str__(self) -> str:
        left = f"without {self.missing}" if self.missing else "whole"
        rests = f" with {self.resting} at rest" if self.resting else ""
        return f"{' and '.join(self.axes)} on {self.drive} {left}{rests}"


def grid() -> list[Case]:
    """All cases: of the whole machine, of every effect left out, and of every axis at rest."""
    found = []
    for axes, drive in product((("pan",), ("tilt",), ("pan", "tilt")), DRIVES):
        effects = ("payload", *FRICTION, *DRIVES[drive][1:])
        found += [Case(axes, drive, missing) for missing in (None, *effects)]
        found += [Case(axes, drive, None, axis) for axis in axes if len(axes) == 2]
    return found


def declared(case: Case, folder: Path, missing: str | None) -> Platform:
    """The machine of a case without one of its effects, its friction free."""
    lines = ["[platform]", 'name = "grid"', f"axes = {list(case.axes)}"]
    lines += ["[[effects]]", 'effect = "rigid_bodies"']
    values = []
    if missing != "payload":
        lines += ["[[effects]]", 'effect = "payload"']
        values += ["m_payload = { value = 0.4 }", "c_x_payload = { value = 0.05 }"]
    kind, unit, _ = INPUTS["torque" if case.drive == "torque" else "motor"]
    signals = []
    for axis in case.axes:
        for effect in (*DRIVES[case.drive], *FRICTION):
            if effect == missing:
                continue
            lines += ["[[effects]]", f'effect = "{effect}"', f'axis = "{axis}"']
            given = VALUES.get(effect, {}).items()
            values += [f"{n}_{axis} = {{ {v.replace('{axis}', axis)} }}" for n, v in given]
        signals += [
            f'{kind}_{axis} = {{ role = "input", column = "{kind}_{axis}", unit = "{unit}" }}',
            f'theta_{axis} = {{ role = "output", column = "theta_{axis}", unit = "rad",'
            " counts_per_revolution = 36000 }",
        ]
    path = folder / f"without_{missing}.toml"
    path.write_text("\n".join([*lines, "[parameters]", *values, "[signals]", *signals, ""]))
    return read_platform(path)


def logged(case: Case, platform: Platform, folder: Path) -> list[Path]:
    """Three short logs of the whole machine; an axis at rest has no input, and an angle of zero."""
    model = emission.emit(platform)
    kind, _, amplitudes = INPUTS["torque" if case.drive == "torque" else "motor"]
    paths = []
    for number, frequency in enumerate((0.9, 1.1, 1.3)):
        waves = zip(amplitudes, (frequency, 2.7 * frequency), strict=True)
        held = sum(a * np.sin(2.0 * np.pi * f * TIMES) for a, f in waves)
        moving = [axis for axis in case.axes if axis != case.resting]
        found = simulate(model, TIMES, {f"{kind}_{axis}": (TIMES, held) for axis in moving})
        columns = {"time [s]": TIMES}
        for axis in case.axes:
            own = axis in moving
            columns[f"{kind}_{axis}"] = held if own else 0.0 * TIMES
            angle = found[f"theta_{axis}"] if own else 0.0 * TIMES
            columns[f"theta_{axis}"] = COUNT * np.round(angle / COUNT)
        paths.append(folder / f"log{number}.csv")
        table = np.column_stack(list(columns.values()))
        np.savetxt(paths[-1], table, delimiter=",", header=",".join(columns), comments="")
    return paths


def verdict_of(case: Case, folder: Path) -> str:
    logs = logged(case, declared(case, folder, None), folder)
    platform = declared(case, folder, case.missing)
    return diagnose_platform(platform, logs[:2], logs[2:], time_limit=SEARCH).summary["verdict"]


@pytest.mark.long
@pytest.mark.parametrize("case", grid(), ids=str)
def test_every_platform_comes_to_a_verdict(case: Case, tmp_path: Path) -> None:
    verdict = verdict_of(case, tmp_path)
    assert verdict in VERDICTS
    if case.missing is None and case.resting != "tilt":  # which would fall, if it were not held
        assert verdict == "nothing_missing"


@pytest.mark.parametrize("missing", [None, *FRICTION])
@pytest.mark.parametrize("drive", DRIVES)
def test_a_search_without_a_candidate_is_without_those_that_need_it(
    drive: str, missing: str | None, tmp_path: Path
) -> None:
    """Whatever one is taken out, all that the others act on is there."""
    platform = declared(Case(("tilt",), drive), tmp_path, missing)
    model = emission.emit(variants.with_candidates(platform))
    candidates = find_candidates(model, [f"{e.effect}@{e.axis}" for e in platform.effects], {})
    assert with_all_they_need(candidates) == candidates
    needed = {key for c in candidates for key in c.brings}
    assert ("csvs_friction@tilt" in needed) == (missing == "csvs_friction")
    for gone in needed:
        left = with_all_they_need(tuple(c for c in candidates if c.key != gone))
        keys = {c.key for c in left}
        assert gone not in keys and all(keys.issuperset(c.brings) for c in left)
        assert {c.key for c in candidates} - keys == {gone} | {
            c.key for c in candidates if gone in c.brings
        }
