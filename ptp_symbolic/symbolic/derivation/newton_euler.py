"""Equations of motion by recursive Newton-Euler, written out with rotation matrices.

One pass outwards carries spin and acceleration from the base to the tilt frame; one pass inwards
collects the forces and moments of the bodies. The equations use no energy; the energies of the
result are summed on the way, so that they can be compared too.
"""

from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.symbols import ZERO, real


@dataclass(frozen=True)
class Motion:
    """Motion of a frame in its own coordinates: `spin` in rad/s, `spin_rate` in rad/s^2, gravity,
    and `place`, `velocity` and `acceleration` of its origin in m, m/s and m/s^2.
    """

    spin: sp.Matrix
    spin_rate: sp.Matrix
    gravity: sp.Matrix
    place: sp.Matrix
    velocity: sp.Matrix
    acceleration: sp.Matrix


@dataclass(frozen=True)
class JointLoad:
    """What a joint carries: of every body behind it, up to the next joint, the `forces` [3] in N on
    the centre of mass and the `moments` [3] in N m about it that its motion takes; their sum, with
    what is further out, as `force` and as `moment` about the origin of the frame behind the joint,
    in that frame; and the part `joint_torque` about, or along, the axis.
    """

    axis: str
    forces: tuple[tuple[str, sp.Matrix], ...]
    moments: tuple[tuple[str, sp.Matrix], ...]
    force: sp.Matrix
    moment: sp.Matrix
    joint_torque: sp.Expr


def acceleration(axis: str) -> sp.Symbol:
    """Joint acceleration acceleration_<axis> in rad/s^2."""
    return real(f"acceleration_{axis}")


def newton_euler_steps(
    configuration: RigidConfiguration,
) -> tuple[list[Motion], list[JointLoad]]:
    """Motion of the base and of the frame behind each joint, and what each joint carries; base
    first.
    """
    accelerations = [acceleration(axis) for axis in configuration.axes]
    motions = _outward(configuration, accelerations)
    return motions, _inward(configuration, motions)


def newton_euler(configuration: RigidConfiguration) -> RigidEquations:
    """Return M q'' = f + tau of `configuration` by Newton's and Euler's equations of each body.

    The joint torques are linear in the accelerations, whose factors are the mass matrix. Source:
    Craig, Introduction to Robotics, 3rd edition 2005, Eq. 6.45 to 6.53; the gyroscopic torque about
    the tilt axis has the sign of erratum 5.
    """
    axes = configuration.axes
    coordinates = tuple(kinematics.angle(axis) for axis in axes)
    rates = tuple(kinematics.rate(axis) for axis in axes)
    accelerations = [acceleration(axis) for axis in axes]
    motions, loads = newton_euler_steps(configuration)
    moments = [load.joint_torque for load in loads]
    mass_matrix = sp.Matrix(moments).jacobian(accelerations)
    at_rest = dict.fromkeys(accelerations, 0)
    kinetic = potential = ZERO
    for body in configuration.bodies:
        motion = motions[len(kinematics.joints_up_to(axes, body.frame))]
        momentum = _angular_momentum(body, motion.spin)
        velocity = motion.velocity + motion.spin.cross(body.com)
        kinetic += (motion.spin.dot(momentum) + body.mass * velocity.dot(velocity)) / 2
        potential -= body.mass * motion.gravity.dot(motion.place + body.com)
    return RigidEquations(
        axes,
        coordinates,
        rates,
        sp.ImmutableMatrix(mass_matrix),
        sp.ImmutableMatrix([-moment.xreplace(at_rest) for moment in moments]),
        kinetic,
        potential,
    )


def _outward(configuration: RigidConfiguration, accelerations: list[sp.Symbol]) -> list[Motion]:
    """Motion of the base and of the frame behind each joint, base first."""
    still = sp.zeros(3, 1)
    spin, spin_rate = sp.Matrix(configuration.base_spin), sp.Matrix(configuration.base_spin_rate)
    gravity = sp.Matrix(configuration.gravity)
    motions = [Motion(spin, spin_rate, gravity, still, still, still)]
    for axis, acceleration in zip(configuration.axes, accelerations, strict=True):
        before = motions[-1]
        inwards = configuration.rotation(axis).T
        turns, slides = _directions(configuration, axis)
        relative = turns * kinematics.rate(axis)
        carried = inwards * before.spin
        spin_rate = inwards * before.spin_rate + turns * acceleration + carried.cross(relative)
        arm = sp.Matrix(configuration.offset(axis))
        sliding = slides * kinematics.rate(axis)
        turning = before.spin.cross(arm) + sliding
        drawn = before.spin_rate.cross(arm) + before.spin.cross(turning + sliding)
        drawn += slides * acceleration
        motions.append(
            Motion(
                carried + relative,
                spin_rate,
                inwards * before.gravity,
                inwards * (before.place + arm),
                inwards * (before.velocity + turning),
                inwards * (before.acceleration + drawn),
            )
        )
    return motions


def _directions(configuration: RigidConfiguration, axis: str) -> tuple[sp.Matrix, sp.Matrix]:
    """Unit vectors [3] about which the joint of `axis` turns and along which it slides, one zero;
    the same in the frames before and behind it.
    """
    if axis in configuration.sliding:
        return sp.zeros(3, 1), sp.Matrix(kinematics.ALONG)
    return sp.Matrix(kinematics.joint_direction(axis)), sp.zeros(3, 1)


def _inward(configuration: RigidConfiguration, motions: list[Motion]) -> list[JointLoad]:
    """What each joint carries, base first."""
    axes = configuration.axes
    loads: list[JointLoad] = []
    moment, force = sp.zeros(3, 1), sp.zeros(3, 1)
    for place in range(len(axes), 0, -1):
        forces, moments = [], []
        for body in configuration.bodies:
            if len(kinematics.joints_up_to(axes, body.frame)) == place:
                pull, turn = _force(body, motions[place]), _moment(body, motions[place])
                forces.append((body.name, pull))
                moments.append((body.name, turn))
                moment = moment + turn + sp.Matrix(body.com).cross(pull)
                force = force + pull
        axis = axes[place - 1]
        turns, slides = _directions(configuration, axis)
        joint_torque = turns.dot(moment) + slides.dot(force)
        loads.append(JointLoad(axis, tuple(forces), tuple(moments), force, moment, joint_torque))
        outwards = configuration.rotation(axis)
        force = outwards * force
        moment = outwards * moment + sp.Matrix(configuration.offset(axis)).cross(force)
    return loads[::-1]


def _force(body: Body, motion: Motion) -> sp.Matrix:
    """Force [3] in N that makes the centre of mass of `body` follow `motion`."""
    spin, arm = motion.spin, sp.Matrix(body.com)
    turning = motion.spin_rate.cross(arm) + spin.cross(spin.cross(arm))
    return body.mass * (motion.acceleration + turning - motion.gravity)


def _moment(body: Body, motion: Motion) -> sp.Matrix:
    """Moment [3] in N m about its centre of mass that makes `body` turn with `motion`."""
    spin = motion.spin
    return body.inertia * motion.spin_rate + spin.cross(_angular_momentum(body, spin))


def _angular_momentum(body: Body, spin: sp.Matrix) -> sp.Matrix:
    """Angular momentum [3] about the body's own centre of mass in kg m^2/s."""
    return sp.Matrix(body.inertia * spin)
