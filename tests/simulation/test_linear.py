"""Short rows, four elements at a time, against NumPy."""

import numpy as np
import pytest
from numba import njit

from ptp_symbolic.numeric.simulation.kernels import linear
from ptp_symbolic.numeric.simulation.kernels.linear import LANES, padded

CHANCE = np.random.default_rng(5)


@njit
def inverse_of(fx, rate, width):
    """The inverse of rate I - fx and the same by columns."""
    n = len(fx)
    a, columns = np.zeros((n, width)), np.zeros((n, width))
    linear.invert(fx, rate, a, np.zeros(n, np.int64), columns)
    return a, columns


@njit
def sums(count, weights, scale, k, start):
    """Stages before `count` added to `start`."""
    out = start.copy()
    linear.add_stages(count, weights, scale, k, out, len(out))
    return out


@njit
def products(matrix, columns, vector, vectors, start):
    """Columns times a vector; a matrix times vectors added to `start`, twice."""
    single = np.zeros(columns.shape[1])
    linear.multiply(columns, vector, 0.5 * vector, single)
    full, sparse = start.copy(), start.copy()
    n = matrix.shape[0]
    width = len(start) // n
    linear.add_product(matrix, width, vectors, full)
    linear.add_sparse_product(matrix, n, width, vectors, sparse)
    return single, full, sparse


@pytest.mark.parametrize(("length", "width"), [(0, 0), (1, 4), (4, 4), (5, 8), (12, 12), (13, 16)])
def test_rows_have_room_for_whole_lanes(length, width):
    assert padded(length) == width
    assert width % LANES == 0


@pytest.mark.parametrize("n", [1, 2, 4, 5, 7, 11])
def test_inverse_is_that_of_numpy(n):
    width = padded(n)
    for _ in range(20):
        fx, rate = CHANCE.normal(size=(n, n)) * 10.0 ** CHANCE.integers(-3, 4, (n, n)), 37.0
        exact = np.linalg.inv(rate * np.eye(n) - fx)
        found, columns = inverse_of(fx, rate, width)
        tolerance = 1e-13 * np.linalg.cond(rate * np.eye(n) - fx) * np.abs(exact).max()
        np.testing.assert_allclose(found[:, :n], exact, rtol=0.0, atol=tolerance)
        np.testing.assert_array_equal(columns[:, :n], found[:, :n].T)
        assert not found[:, n:].any() and not columns[:, n:].any()


def test_row_with_its_diagonal_alone_stays_alone():
    fx = CHANCE.normal(size=(6, 6)) * 1e3
    fx[3] = 0.0
    found, _ = inverse_of(fx, 8.0, 8)
    np.testing.assert_array_equal(found[3], np.eye(8)[3] / 8.0)


@pytest.mark.parametrize("width", [4, 8, 20])
def test_stages_are_summed_with_their_weights(width):
    weights, k = CHANCE.normal(size=(8, 8)), CHANCE.normal(size=(8, width))
    start = CHANCE.normal(size=width)
    for count in range(8):
        exact = start + 0.3 * weights[count, :count] @ k[:count]
        np.testing.assert_allclose(sums(count, weights, 0.3, k, start), exact, rtol=1e-13)


@pytest.mark.parametrize(("n", "width"), [(3, 4), (7, 12)])
def test_products_are_those_of_numpy(n, width):
    matrix = CHANCE.normal(size=(n, n)) * (CHANCE.random((n, n)) > 0.5)
    columns, vector = CHANCE.normal(size=(n, padded(n))), CHANCE.normal(size=n)
    vectors, start = CHANCE.normal(size=(n, width)), CHANCE.normal(size=(n, width))
    single, full, sparse = products(matrix, columns, vector, vectors.ravel(), start.ravel())
    np.testing.assert_allclose(single, 1.5 * vector @ columns, rtol=1e-12, atol=1e-14)
    exact = (start + matrix @ vectors).ravel()
    np.testing.assert_allclose(full, exact, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(sparse, exact, rtol=1e-12, atol=1e-14)
