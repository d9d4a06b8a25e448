"""Rigid pan-tilt platform by numerical Newton-Euler: a truth that shares no formula with the model.

Recursive Newton-Euler in spatial vectors gives the joint torques; the mass matrix comes out of it
by unit accelerations and the accelerations by a linear solve. The recursion is plain NumPy on
arrays, so that a simulator may compile it. Source: Featherstone, Rigid Body Dynamics Algorithms
(2008), table 5.1 (inverse dynamics) and section 6.1 (unit accelerations).

Axes, signs and frames: pan about z (up), tilt about the pan-fixed y axis, boresight along x, both
axes through the origin; a positive tilt angle lowers the boresight. All quantities in SI units.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Parameters = Mapping[str, float]

AXIS_VECTOR = {"pan": (0.0, 0.0, 1.0), "tilt": (0.0, 1.0, 0.0)}
BOTH_AXES = ("pan", "tilt")


class Chain(NamedTuple):
    """Links from the base outwards; all joint axes cross in the origin.

    axes [n, 3] joint axes in link coordinates and crosses [n, 3, 3] their cross product matrices,
    inertias [n, 6, 6] spatial inertias about the origin, gravity [3] in base coordinates in m/s^2,
    damping [n] in N m s/rad.
    """

    axes: Floats
    crosses: Floats
    inertias: Floats
    gravity: Floats
    damping: Floats


def inertia_tensor(parameters: Parameters, body: str) -> Floats:
    """Inertia tensor [3, 3] of `body` about its own centre of mass, kg m^2.

    Diagonal J_x, J_y, J_z; tensor elements (not integrals of products) J_xy, J_xz, J_yz, all
    optional and named like J_xy_payload.
    """
    tensor = np.zeros((3, 3))
    for row, first in enumerate("xyz"):
        tensor[row, row] = parameters.get(f"J_{first}_{body}", 0.0)
        for column in range(row + 1, 3):
            element = parameters.get(f"J_{first}{'xyz'[column]}_{body}", 0.0)
            tensor[row, column] = tensor[column, row] = element
    return tensor


def centre_of_mass(parameters: Parameters, body: str) -> Floats:
    """Centre of mass [3] of `body` in m, with the undeclared shift dc_x, dc_y, dc_z added."""
    return np.array(
        [
            parameters.get(f"c_{k}_{body}", 0.0) + parameters.get(f"dc_{k}_{body}", 0.0)
            for k in "xyz"
        ]
    )


def cross_matrix(vector: ArrayLike) -> Floats:
    """Matrix [3, 3] of the cross product with `vector` [3] from the left."""
    x, y, z = np.asarray(vector, dtype=float)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def spatial_inertia(parameters: Parameters, body: str) -> Floats:
    """Spatial inertia [6, 6] of `body` about the origin; zero mass leaves a pure rotor."""
    mass = parameters.get(f"m_{body}", 0.0)
    lever = cross_matrix(centre_of_mass(parameters, body))
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = inertia_tensor(parameters, body) + mass * lever @ lever.T
    inertia[:3, 3:] = mass * lever
    inertia[3:, :3] = mass * lever.T
    inertia[3:, 3:] = mass * np.eye(3)
    return inertia


def base_gravity(parameters: Parameters) -> Floats:
    """Gravity [3] in base coordinates, m/s^2, on a base tilted by beta_base towards alpha_base.

    The azimuth alpha_base is the pan angle at which a payload on the boresight comes to rest.
    """
    magnitude = parameters.get("gravity", 9.81)
    beta, alpha = parameters.get("beta_base", 0.0), parameters.get("alpha_base", 0.0)
    downhill = np.array([np.cos(alpha), np.sin(alpha), 0.0])
    down = np.array([0.0, 0.0, -1.0])
    return magnitude * (np.sin(beta) * downhill + np.cos(beta) * down)


def chain(parameters: Parameters, axes: Sequence[str] = BOTH_AXES) -> Chain:
    """The links of a platform with `axes` = ("pan", "tilt"), ("pan",) or ("tilt",).

    The payload sits on the outermost link. The pan body is given by J_pan about z (or like any
    other body: J_x_pan, m_pan, c_x_pan, ...), the tilt body by J_x_tilt, J_y_tilt, J_z_tilt.
    """
    inertias = []
    for axis in axes:
        body = spatial_inertia(parameters, axis)
        if axis == "pan":
            body[2, 2] += parameters.get("J_pan", 0.0)
        inertias.append(body)
    inertias[-1] = inertias[-1] + spatial_inertia(parameters, "payload")
    return Chain(
        axes=np.array([AXIS_VECTOR[axis] for axis in axes]),
        crosses=np.array([cross_matrix(AXIS_VECTOR[axis]) for axis in axes]),
        inertias=np.array(inertias),
        gravity=base_gravity(parameters),
        damping=np.array([parameters.get(f"b_{axis}", 0.0) for axis in axes]),
    )


def chain_torque(links: Chain, theta: Floats, omega: Floats, alpha: Floats) -> Floats:
    """Joint torques [n] in N m for angles, rates and accelerations [n], friction not included.

    One pass outwards for spin and acceleration, one inwards for wrenches. The origin of every link
    is the crossing of the axes, so its linear velocity is zero and its acceleration is -gravity.
    """
    count = theta.shape[0]
    rotations = np.zeros((count, 3, 3))
    wrenches = np.zeros((count, 6))
    twist, acceleration = np.zeros(6), np.zeros(6)
    acceleration[3:] = -links.gravity
    for k in range(count):
        cross = links.crosses[k]
        turn = (1.0 - np.cos(theta[k])) * np.dot(cross, cross) - np.sin(theta[k]) * cross
        rotations[k] = np.eye(3) + turn
        twist[:3] = np.dot(rotations[k], twist[:3])
        acceleration[:3] = np.dot(rotations[k], acceleration[:3])
        acceleration[3:] = np.dot(rotations[k], acceleration[3:])
        acceleration[:3] += alpha[k] * links.axes[k] - omega[k] * np.dot(cross, twist[:3])
        twist[:3] += omega[k] * links.axes[k]
        spin = np.zeros((3, 3))
        spin[0, 1], spin[0, 2], spin[1, 2] = -twist[2], twist[1], -twist[0]
        spin[1, 0], spin[2, 0], spin[2, 1] = twist[2], -twist[1], twist[0]
        momentum = np.dot(links.inertias[k], twist)
        wrenches[k] = np.dot(links.inertias[k], acceleration)
        wrenches[k, :3] += np.dot(spin, momentum[:3])
        wrenches[k, 3:] += np.dot(spin, momentum[3:])
    torque = np.zeros(count)
    for k in range(count - 1, -1, -1):
        torque[k] = np.dot(links.axes[k], wrenches[k, :3])
        if k > 0:
            inward = rotations[k].T.copy()
            wrenches[k - 1, :3] += np.dot(inward, wrenches[k, :3])
            wrenches[k - 1, 3:] += np.dot(inward, wrenches[k, 3:])
    return torque


def inverse_dynamics(
    theta: ArrayLike,
    omega: ArrayLike,
    alpha: ArrayLike,
    parameters: Parameters,
    axes: Sequence[str] = BOTH_AXES,
) -> Floats:
    """Joint torques [n] in N m that cause accelerations `alpha` [n], viscous friction included."""
    links = chain(parameters, axes)
    theta, omega, alpha = (np.asarray(value, dtype=float) for value in (theta, omega, alpha))
    return chain_torque(links, theta, omega, alpha) + links.damping * omega


def mass_matrix(
    theta: ArrayLike, parameters: Parameters, axes: Sequence[str] = BOTH_AXES
) -> Floats:
    """Joint mass matrix [n, n] in kg m^2 by unit accelerations at rest without gravity."""
    links = chain(parameters, axes)._replace(gravity=np.zeros(3))
    theta = np.asarray(theta, dtype=float)
    still = np.zeros_like(theta)
    return np.array([chain_torque(links, theta, still, unit) for unit in np.eye(len(theta))]).T


def accelerations(
    theta: ArrayLike,
    omega: ArrayLike,
    tau: ArrayLike,
    parameters: Parameters,
    axes: Sequence[str] = BOTH_AXES,
) -> Floats:
    """Joint accelerations [n] in rad/s^2 at angles, rates and driving torques [n]."""
    bias = inverse_dynamics(theta, omega, np.zeros(len(axes)), parameters, axes)
    return np.linalg.solve(mass_matrix(theta, parameters, axes), np.asarray(tau) - bias)


def _orientations(theta: ArrayLike, axes: Sequence[str]) -> list[Floats]:
    """Rotation [3, 3] of each link into base coordinates, by the rotation formula."""
    orientation, result = np.eye(3), []
    for angle, axis in zip(np.asarray(theta, dtype=float), axes, strict=True):
        k = cross_matrix(AXIS_VECTOR[axis])
        orientation = orientation @ (np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k)
        result.append(orientation)
    return result


def _link_bodies(axes: Sequence[str]) -> list[tuple[int, str]]:
    return [*enumerate(axes), (len(axes) - 1, "payload")]


def potential_energy(
    theta: ArrayLike, parameters: Parameters, axes: Sequence[str] = BOTH_AXES
) -> float:
    """Potential energy in J, zero with every centre of mass in the origin."""
    orientations, gravity = _orientations(theta, axes), base_gravity(parameters)
    return -sum(
        parameters.get(f"m_{body}", 0.0)
        * float(gravity @ orientations[link] @ centre_of_mass(parameters, body))
        for link, body in _link_bodies(axes)
    )


def kinetic_energy(
    theta: ArrayLike, omega: ArrayLike, parameters: Parameters, axes: Sequence[str] = BOTH_AXES
) -> float:
    """Kinetic energy in J from each body's angular velocity and centre of mass velocity.

    Written per body in base coordinates, so that it does not share the spatial inertias above.
    """
    orientations, spin, spins = _orientations(theta, axes), np.zeros(3), []
    for orientation, axis, rate in zip(orientations, axes, np.asarray(omega), strict=True):
        spin = spin + rate * orientation @ np.array(AXIS_VECTOR[axis])
        spins.append(spin)
    energy = 0.0
    if axes[0] == "pan":
        energy += 0.5 * parameters.get("J_pan", 0.0) * float(spins[0][2]) ** 2
    for link, body in _link_bodies(axes):
        orientation, spin = orientations[link], spins[link]
        speed = np.cross(spin, orientation @ centre_of_mass(parameters, body))
        tensor = orientation @ inertia_tensor(parameters, body) @ orientation.T
        energy += 0.5 * float(spin @ tensor @ spin)
        energy += 0.5 * parameters.get(f"m_{body}", 0.0) * float(speed @ speed)
    return energy
