"""Two axes with dry friction, coupled by a payload, against MuJoCo's friction loss.

MuJoCo solves dry friction as a convex problem at every fixed step and lets a body at rest creep a
little; this program locates the instants of sticking and slipping. Neither shares a line with the
other, and MuJoCo's result must approach this one as its step shrinks.
"""

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.inputs import table
from ptp_symbolic.platform import EffectDeclaration, Platform

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is an extra")

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("payload", None, None),
    *(
        EffectDeclaration(effect, axis, None)
        for axis in ("pan", "tilt")
        for effect in ("viscous_friction", "csvs_friction")
    ),
)
PLATFORM = Platform("dry", "Two dry axes", ("pan", "tilt"), 9.81, EFFECTS, (), ())
PAN_INERTIA, TILT_INERTIA, PAYLOAD_INERTIA = 0.08, (0.05, 0.06, 0.07), (0.02, 0.03, 0.04)
MASS, PLACE = 3.0, (0.09, 0.02, -0.03)
VISCOUS = {"pan": 0.5, "tilt": 0.3}
DRY = {"pan": 0.6, "tilt": 0.45}
VALUES = {
    "J_pan": PAN_INERTIA,
    "m_payload": MASS,
    **{f"J_{a}_tilt": v for a, v in zip("xyz", TILT_INERTIA, strict=True)},
    **{f"J_{a}_payload": v for a, v in zip("xyz", PAYLOAD_INERTIA, strict=True)},
    **{f"c_{a}_payload": v for a, v in zip("xyz", PLACE, strict=True)},
    **{f"b_{axis}": v for axis, v in VISCOUS.items()},
    **{f"{k}_{axis}": v for axis, v in DRY.items() for k in ("F_c", "F_s")},
    **{f"F_v_{axis}": 0.0 for axis in DRY},
}
TIMES = np.array([0.0, 0.4, 0.9, 1.4, 2.0, 2.6])
TORQUES = {
    "pan": np.array([1.6, -1.1, 0.2, -1.8, 0.55, 0.0]),
    "tilt": np.array([-2.9, -1.5, -2.4, -3.4, -2.6, -2.6]),
}
START = {"theta_pan": 0.2, "theta_tilt": 0.3}


def three(values: tuple[float, ...]) -> str:
    return " ".join(repr(v) for v in values)


def simulate_with_mujoco(step: float, ends: np.ndarray) -> np.ndarray:
    """Pan and tilt angles in rad at `ends`, by MuJoCo with steps of `step` s."""
    joints = {
        axis: f'<joint name="{axis}" axis="{along}" damping="{VISCOUS[axis]}"'
        f' frictionloss="{DRY[axis]}" solreffriction="{4 * step} 1"'
        ' solimpfriction="0.9999 0.9999 0.001 0.5 1"/>'
        for axis, along in (("pan", "0 0 1"), ("tilt", "0 1 0"))
    }
    pan = f'<inertial pos="0 0 0" mass="1" diaginertia="1 1 {PAN_INERTIA}"/>'
    tilt = f'<inertial pos="0 0 0" mass="1e-9" diaginertia="{three(TILT_INERTIA)}"/>'
    load = (
        f'<body><inertial pos="{three(PLACE)}" mass="{MASS}" '
        f'diaginertia="{three(PAYLOAD_INERTIA)}"/></body>'
    )
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><compiler boundmass="0" balanceinertia="false"/>'
        f'<option timestep="{step}" gravity="0 0 -9.81" solver="Newton" tolerance="1e-14"/>'
        f"<worldbody><body>{pan}{joints['pan']}<body>{tilt}{joints['tilt']}{load}</body></body>"
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    data.qpos[:] = START["theta_pan"], START["theta_tilt"]
    found = []
    for k in range(round(ends[-1] / step) + 1):
        if np.any(np.abs(ends - k * step) < 0.5 * step):
            found.append(data.qpos.copy())
        piece = np.searchsorted(TIMES, k * step + 1e-9, side="right") - 1
        data.qfrc_applied[:] = TORQUES["pan"][piece], TORQUES["tilt"][piece]
        mujoco.mj_step(model, data)
    return np.array(found)


def test_mujoco_converges_to_the_located_events(figure) -> None:
    ends = np.linspace(0.0, 2.6, 27)
    inputs = {f"tau_{axis}": table(TIMES, torque, "hold") for axis, torque in TORQUES.items()}
    ours = simulate(emission.emit(PLATFORM), ends, inputs, VALUES, START, rtol=1e-9, atol=1e-11)
    angles = np.column_stack([ours["theta_pan"], ours["theta_tilt"]])
    modes = {event.mode for event in ours.events}
    assert {"sticks", "slides forward", "slides backward"} <= modes
    off = [np.max(np.abs(simulate_with_mujoco(step, ends) - angles)) for step in (4e-4, 1e-4)]
    assert np.ptp(angles, axis=0).min() > 0.3
    assert figure("of that at 0.4 ms", off[1] / off[0]) < 0.3
    assert figure("MuJoCo at 0.1 ms off ours, rad", off[1]) < 1e-3
