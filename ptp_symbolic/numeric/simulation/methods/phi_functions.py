"""The exponential of a small matrix, and the three phi functions that go with it.

phi0(z) = exp(z), phi1(z) = (phi0(z) - 1) / z, phi2(z) = (phi1(z) - 1) / z, phi3(z) = (phi2(z) -
1/2) / z (Hochbruck and Ostermann, Acta Numerica 19, 2010, Eq. 2.10), by scaling and squaring of a
Taylor series.
"""

from ptp_symbolic.numeric.simulation.kernels.records import copy_matrix, inlined, kernel

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
