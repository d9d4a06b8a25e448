"""The matrices of an exponential step, and how they weigh what is not linear.

The rest g of a slope is known at the NODES of a step after its start, as differences to what it is
there. Between them it is taken for a s + b s^2 + c (exp(-d s) - 1) over the fraction s of the step,
d being how often the fastest state decays in it: what follows a winding, such as its heat, is done
in a thousandth of a second, and a polynomial alone would see it last for the whole step
(exponential fitting: Ixaru, Comput. Phys. Commun. 105, 1997). Where another state decays faster
than the winding, the parabola alone follows the winding. The exponential of the linear part L
integrates the three to h times phi2, 2 phi3 and psi - phi1, with psi = exp(-d) phi1(h L + d).

The exponential of a small matrix, and the three phi functions that go with it.

phi0(z) = exp(z), phi1(z) = (phi0(z) - 1) / z, phi2(z) = (phi1(z) - 1) / z, phi3(z) = (phi2(z) -
1/2) / z (Hochbruck and Ostermann, Acta Numerica 19, 2010, Eq. 2.10), by scaling and squaring of a
Taylor series.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numba import types

from ptp_symbolic.numeric.simulation.kernels.linear import factor, padded, solve
from ptp_symbolic.numeric.simulation.kernels.records import (
    CUBE,
    INTEGERS,
    MATRIX,
    VECTOR,
    copy_matrix,
    inlined,
    kernel,
)

HIGHEST_POWER, LARGEST_NORM, MOST_DOUBLINGS = 15, 0.5, 60


@kernel
def fill_phi_functions(matrix, scale, phi0, phi1, phi2, phi3, product):
    """Write phi0 to phi3 of scale times `matrix`, all [k, k]; `product` is scratch."""
    doublings, norm = 0, largest_row_sum(matrix)
    while not norm * scale <= LARGEST_NORM and doublings < MOST_DOUBLINGS:
        scale *= 0.5
        doublings += 1
    coefficient = 1.0
    for power in range(2, HIGHEST_POWER + 1):
        coefficient /= power
    for i in range(len(phi3)):
        for j in range(len(phi3)):
            phi3[i, j] = coefficient if i == j else 0.0
    for power in range(HIGHEST_POWER, 3, -1):
        coefficient *= power
        fill_product_and_diagonal(scale, matrix, phi3, coefficient, product)
        copy_matrix(product, phi3)
    fill_product_and_diagonal(scale, matrix, phi3, 0.5, phi2)
    fill_product_and_diagonal(scale, matrix, phi2, 1.0, phi1)
    fill_product_and_diagonal(scale, matrix, phi1, 1.0, phi0)
    for _ in range(doublings):
        double(phi0, phi1, phi2, phi3, product)


@kernel
def double(phi0, phi1, phi2, phi3, product):
    """Square: from z to 2 z (Skaflestad and Wright, Appl. Numer. Math. 59); all [k, k]."""
    fill_product_and_diagonal(1.0, phi0, phi3, 0.0, product)
    for i in range(len(phi3)):
        for j in range(len(phi3)):
            before = 0.5 * phi1[i, j] + phi2[i, j] + phi3[i, j]
            phi3[i, j] = 0.125 * (product[i, j] + before)
    fill_product_and_diagonal(1.0, phi0, phi2, 0.0, product)
    for i in range(len(phi2)):
        for j in range(len(phi2)):
            phi2[i, j] = 0.25 * (product[i, j] + phi1[i, j] + phi2[i, j])
    fill_product_and_diagonal(1.0, phi0, phi1, 0.0, product)
    for i in range(len(phi1)):
        for j in range(len(phi1)):
            phi1[i, j] = 0.5 * (product[i, j] + phi1[i, j])
    fill_product_and_diagonal(1.0, phi0, phi0, 0.0, product)
    copy_matrix(product, phi0)


@inlined
def largest_row_sum(matrix):
    """Maximum norm of `matrix` [k, k]."""
    largest = 0.0
    for i in range(len(matrix)):
        total = 0.0
        for j in range(len(matrix)):
            total += abs(matrix[i, j])
        largest = max(largest, total)
    return largest


@kernel
def fill_product_and_diagonal(factor, a, b, diagonal, out):
    """Write factor a b + diagonal I into out, all [k, k]."""
    for i in range(len(out)):
        for j in range(len(out)):
            total = 0.0
            for k in range(len(out)):
                total += a[i, k] * b[k, j]
            out[i, j] = factor * total + (diagonal if i == j else 0.0)


NODES, MIDDLE = 3, 1
FRACTIONS = np.array([0.25, 0.5, 1.0])  # of the step, where the nodes are
SLOWEST, FASTEST = 1.0, 40.0  # decays per step; slower is like a cubic, faster like a jump

_V, _M, _C = VECTOR, MATRIX, CUBE
PROPAGATOR = types.Tuple((_V, _V, *[_C] * 4, *[_M] * 11, *[_V] * 4, INTEGERS))


class Propagator(NamedTuple):
    """Matrices that carry the moving states of a machine over one sampling period.

    modes: those that the matrices hold for; clock [5]: the last period in s, whether matrices of it
    are known, samples to wait before the next try, how many after the next failure, and by how much
    in rad the fastest oscillation turns in the period. For every node s, by columns [moving, moving
    rounded up to LANES]: decay = phi0(s h L), reach = s h phi1(s h L), weights of the rests, these
    also `by_rows`; linear = L, phi0 to phi3 of h L [moving, moving]; shifted, psi, product [moving,
    moving]: scratch. states, rest [3, w]: those at the nodes; fitted [3, 3], unit, order [3],
    slope, change, none [w]: scratch; `none` stays zero.
    """

    modes: Any
    clock: Any
    decay: Any
    reach: Any
    weights: Any
    by_rows: Any
    linear: Any
    phi0: Any
    phi1: Any
    phi2: Any
    phi3: Any
    shifted: Any
    psi: Any
    product: Any
    states: Any
    rest: Any
    fitted: Any
    slope: Any
    change: Any
    none: Any
    unit: Any
    order: Any


def new_propagator(modes: int, moving: int, n: int) -> Propagator:
    """Preallocated propagator of n states, the first `moving` of which are not set by samplers."""
    z, w = np.zeros, padded(n)
    arrays = [z(modes), np.array([0.0, 0.0, 0.0, 1.0, 0.0])]
    arrays += [z((NODES, moving, padded(moving))) for _ in range(3)]
    arrays += [z((NODES, moving, moving))]
    arrays += [z((moving, moving)) for _ in range(8)]
    arrays += [z((NODES, size)) for size in (w, w, NODES)]
    arrays += [z(size) for size in (w, w, w, NODES)]
    arrays += [z(NODES, dtype=np.int64)]
    return Propagator(*arrays)


@kernel
def fill_propagator(h, fx, propagator):
    """Fill the matrices of a step of h s, with the linear part from fx [n, n]."""
    linear, phi0, phi1, phi2, phi3, product = (
        propagator.linear,
        propagator.phi0,
        propagator.phi1,
        propagator.phi2,
        propagator.phi3,
        propagator.product,
    )
    copy_matrix(fx, linear)
    decays = decays_in(h, linear)
    copy_matrix(linear, propagator.shifted)
    for i in range(linear.shape[0]):
        propagator.shifted[i, i] += decays / h
    fill_phi_functions(propagator.shifted, h, phi0, propagator.psi, phi2, phi3, product)
    fill_phi_functions(linear, FRACTIONS[0] * h, phi0, phi1, phi2, phi3, product)
    for node in range(NODES):
        if node > 0:
            double(phi0, phi1, phi2, phi3, product)
        fill_columns(1.0, phi0, propagator.decay[node])
        fill_columns(FRACTIONS[node] * h, phi1, propagator.reach[node])
    fill_weights(decays, h, propagator)


@inlined
def decays_in(h, linear):
    """How often the fastest state decays by a factor of e in h s, by itself."""
    fastest = SLOWEST
    for i in range(linear.shape[0]):
        fastest = max(fastest, -h * linear[i, i])
    return min(fastest, FASTEST)


@kernel
def fill_weights(decays, h, propagator):
    """Fill the weights of the rests at the nodes, by the fit of the three functions to them."""
    phi1, phi2, phi3, psi = propagator.phi1, propagator.phi2, propagator.phi3, propagator.psi
    fitted, unit, left = propagator.fitted, propagator.unit, math.exp(-decays)
    for node in range(NODES):
        s = FRACTIONS[node]
        fitted[node, 0], fitted[node, 1], fitted[node, 2] = s, s * s, math.expm1(-decays * s)
    factor(fitted, propagator.order)
    for node in range(NODES):
        for k in range(NODES):
            unit[k] = 1.0 if k == node else 0.0
        solve(fitted, propagator.order, unit)
        weights = propagator.by_rows[node]
        for i in range(phi1.shape[0]):
            for j in range(phi1.shape[0]):
                decaying = left * psi[i, j] - phi1[i, j]
                total = unit[0] * phi2[i, j] + 2.0 * unit[1] * phi3[i, j] + unit[2] * decaying
                weights[i, j] = h * total
        fill_columns(1.0, weights, propagator.weights[node])


@inlined
def fill_columns(scale, matrix, columns):
    """Write a scale times `matrix` [moving, moving], transposed, into columns [moving, w]."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[0]):
            columns[j, i] = scale * matrix[i, j]
