"""What averaging a pulsed bridge leaves out: ripple and mean difference of current and angle.

Prints the ripple of the locked pan motor beside the closed form of a resistive-inductive load, and
the pan drive and servo of the thesis averaged against switching, from the same duty.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, constant, ramp, step
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform

KINDS = ("averaged", "switching", "bipolar")
SETTLED, FINE = 400, 200  # carrier periods; samples of each part of one


def with_bridge(source: str, kind: str) -> Model:
    """The model of preset `source` with a bridge of `kind` on the pan axis."""
    base = read_platform(source)
    others = tuple(e for e in base.effects if e.effect != "pwm_drive")
    bridge = EffectDeclaration("pwm_drive", "pan", None, kind)
    return emission.emit(replace(base, effects=(*others, bridge)))


def locked(kind: str) -> Model:
    """The pan motor with a bridge of `kind`, held by friction that nothing overcomes."""
    effects = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("csvs_friction", "pan", None),
        EffectDeclaration("dc_motor", "pan", None),
        EffectDeclaration("pwm_drive", "pan", None, kind),
    )
    return emission.emit(Platform("locked", "Locked motor", ("pan",), 9.81, effects, (), ()))


def closed_form(high: float, low: float, share: float, p: Mapping[str, float]) -> float:
    """Peak-to-peak current in A of R and L between two voltages, `high` for `share` of a period."""
    rate = p["R_pan"] / p["L_pan"] / p["f_pwm_pan"]
    a, b = math.exp(-rate * share), math.exp(-rate * (1.0 - share))
    return (high - low) / p["R_pan"] * (1.0 - a) * (1.0 - b) / (1.0 - a * b)


def print_locked() -> None:
    """Print the ripple of the current and the error of its mean, against closed forms."""
    print(
        "locked motor: current, A\nkind       duty  ripple      closed form  error     mean - u/R"
    )
    for kind in KINDS[1:]:
        model = locked(kind)
        p = model.defaults
        supply, period = p["u_supply_pan"], 1.0 / p["f_pwm_pan"]
        low = 0.0 if kind == "switching" else -supply
        for duty in (0.1, 0.25, 0.5, 0.75, 0.9):
            share = duty if kind == "switching" else (1.0 + duty) / 2.0
            parts = np.linspace(0.0, share, FINE + 1), np.linspace(share, 1.0, FINE + 1)[1:]
            times = (SETTLED + np.concatenate(parts)) * period
            found = simulate(
                model,
                np.concatenate([[0.0], times]),
                {"u_pan": constant(duty * supply)},
                {"F_c_pan": 900.0, "F_s_pan": 1000.0},
                rtol=1e-11,
                atol=1e-12,
            )["i_pan"][1:]
            truth = closed_form(supply, low, share, p)
            mean = np.trapezoid(found, times) / period - duty * supply / p["R_pan"]
            print(
                f"{kind:10s} {duty:4.2f}  {np.ptp(found):.8f}  {truth:.8f}"
                f"   {np.ptp(found) - truth:8.1e}  {mean:8.1e}"
            )


def print_moving(title: str, source: str, driven: Mapping[str, InputSignal], end: float) -> None:
    """Print how far the pulsed bridges are from the averaged one along one run."""
    times = np.arange(0.0, end, 1.0 / (20 * 6e6 / 512))
    runs = {kind: simulate(with_bridge(source, kind), times, driven) for kind in KINDS}
    print(f"\n{title}\nkind       angle: mean difference, largest, rad   current: mean, largest, A")
    for kind in KINDS[1:]:
        angle, current = (_apart(runs[kind], runs["averaged"], n) for n in ("theta_pan", "i_pan"))
        print(
            f"{kind:10s}        {np.mean(angle):9.2e}  {np.max(np.abs(angle)):9.2e}"
            f"                   {np.mean(current):9.2e}  {np.max(np.abs(current)):9.2e}"
        )


def _apart(run: Trajectory, other: Trajectory, name: str) -> np.ndarray:
    return run[name] - other[name]


if __name__ == "__main__":
    print_locked()
    print_moving("pan drive, 12 V from 0.1 s", "thesis-pan-drive", {"u_pan": step(0, 12, 0.1)}, 1.0)
    goal = {"setpoint_pan": ramp(0.0, 0.2, 0.0, 0.5)}
    print_moving("pan servo, 0.4 rad/s for 0.5 s, then held", "thesis-pan-servo", goal, 1.0)
