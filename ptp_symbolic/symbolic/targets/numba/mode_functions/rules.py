"""How the modes of one friction or contact follow from a state.

The functions that a machine needs are copied into its emitted module, those of rigid contacts with
the constants.
"""

from numba import njit

FACE_WIDTH, SAME_SPEED = 1e-9, 1e-9  # rad, rad/s: what counts as lasting contact


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def touching(separation, half_gap, upper, lower):
    """Return side and activity of a contact: the face beyond half the gap, active if it pushes."""
    side = 1.0 if separation > 0.0 else -1.0
    if side * separation > half_gap:
        torque = upper if side > 0.0 else lower
        return side, (1.0 if side * torque > 0.0 else 0.0)
    return 0.0, 0.0


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def meeting(separation, half_gap, gear_rate, joint_rate):
    """Return side and activity of a rigid contact: the face that is met, active at one speed."""
    side = 1.0 if separation > 0.0 else -1.0
    if side * separation > half_gap - FACE_WIDTH:
        return side, (1.0 if abs(gear_rate - joint_rate) <= SAME_SPEED else 0.0)
    return 0.0, 0.0


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def pushing(side, active, upper, lower):
    """Return the activity of a rigid contact: it ends where the face would have to pull."""
    push = side * (upper if side > 0.0 else lower)
    return active if push >= 0.0 else 0.0


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def breaking_away(slide, holding, forward, backward):
    """Return the direction of a friction: if it sticks, that of a torque beyond breakaway."""
    if slide == 0.0 and holding > forward:
        return 1.0
    if slide == 0.0 and -holding > backward:
        return -1.0
    return slide
