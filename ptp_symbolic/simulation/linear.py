"""Small dense systems: a product with an inverse, or triangular factors.

A row with its diagonal alone, as a friction at rest has it, is never exchanged: rounding in a
product of such rows would let the rest creep.
"""

from ptp_symbolic.simulation.kernels import inlined, kernel


@inlined
def add_stages(i, weights, scale, k, out):
    """Add the stages k [8, length] before i with their weights [8, 8] to out [length].

    Four at a time: weights past the diagonal are zero.
    """
    for j in range(0, i, 4):
        a, b = scale * weights[i, j], scale * weights[i, j + 1]
        c, d = scale * weights[i, j + 2], scale * weights[i, j + 3]
        ka, kb, kc, kd = k[j], k[j + 1], k[j + 2], k[j + 3]
        for e in range(len(out)):
            out[e] += (a * ka[e] + b * kb[e]) + (c * kc[e] + d * kd[e])


@inlined
def add_columns(matrix, vector, out):
    """Add the columns of a matrix, given as rows [m, n], weighted by vector [m], to out [n]."""
    count = len(vector)
    for j in range(0, count - 3, 4):
        a, b, c, d = vector[j], vector[j + 1], vector[j + 2], vector[j + 3]
        ma, mb, mc, md = matrix[j], matrix[j + 1], matrix[j + 2], matrix[j + 3]
        for e in range(len(out)):
            out[e] += (a * ma[e] + b * mb[e]) + (c * mc[e] + d * md[e])
    for j in range(count - count % 4, count):
        a, ma = vector[j], matrix[j]
        if a != 0.0:
            for e in range(len(out)):
                out[e] += a * ma[e]


@inlined
def add_product(matrix, vectors, out):
    """Add matrix [n, n] times vectors to out, both [n * columns] row by row."""
    n = matrix.shape[0]
    width = len(out) // n
    rows = vectors.reshape(n, width)
    for a in range(n):
        add_columns(rows, matrix[a], out[a * width : (a + 1) * width])


@inlined
def add_sparse_product(matrix, vectors, out):
    """Add matrix [n, n], most of whose entries are zero, times vectors [n * columns] to out."""
    n = matrix.shape[0]
    width = len(out) // n
    for a in range(n):
        row = out[a * width : (a + 1) * width]
        for b in range(n):
            factor = matrix[a, b]
            if factor != 0.0:
                column = vectors[b * width : (b + 1) * width]
                for c in range(width):
                    row[c] += factor * column[c]


@inlined
def _is_coupled(a, row):
    """Whether a row has more than its diagonal."""
    coupled = False
    for j in range(a.shape[0]):
        coupled = coupled or (j != row and a[row, j] != 0.0)
    return coupled


@kernel
def invert(fx, rate, a, order, transposed):
    """Write the inverse of rate I - fx into a [n, n] and, by columns, into transposed [n, n].

    Eight products follow with every inverse: for a dozen states they cost less than
    substitutions, which wait for one division after the other.
    """
    n = a.shape[0]
    for i in range(n):
        for j in range(n):
            a[i, j] = -fx[i, j]
        a[i, i] += rate
    for c in range(n):
        pivot = c
        if _is_coupled(a, c):
            for i in range(c + 1, n):
                if abs(a[i, c]) > abs(a[pivot, c]):
                    pivot = i
        order[c] = pivot
        if pivot != c:
            for j in range(n):
                a[c, j], a[pivot, j] = a[pivot, j], a[c, j]
        scale = 1.0 / a[c, c]
        a[c, c] = 1.0
        for j in range(n):
            a[c, j] *= scale
        for i in range(n):
            factor = a[i, c]
            if i != c and factor != 0.0:
                a[i, c] = 0.0
                for j in range(n):
                    a[i, j] -= factor * a[c, j]
    for c in range(n - 1, -1, -1):
        if order[c] != c:
            for i in range(n):
                a[i, c], a[i, order[c]] = a[i, order[c]], a[i, c]
    for i in range(n):
        for j in range(n):
            transposed[j, i] = a[i, j]


@kernel
def factor(a, order):
    """Replace a [n, n] by its triangular factors, rows swapped as `order` [n] records."""
    n = a.shape[0]
    for k in range(n):
        pivot = k
        if _is_coupled(a, k):
            for i in range(k + 1, n):
                if abs(a[i, k]) > abs(a[pivot, k]):
                    pivot = i
        order[k] = pivot
        if pivot != k:
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                a[i, k] *= inverse
                for j in range(k + 1, n):
                    a[i, j] -= a[i, k] * a[k, j]


@kernel
def solve(a, order, b):
    """Replace the right-hand side b [n] by the solution, with the factors from `factor`."""
    n = len(b)
    for k in range(n):
        pivot = order[k]
        b[k], b[pivot] = b[pivot], b[k]
    for i in range(1, n):
        for j in range(i):
            b[i] -= a[i, j] * b[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            b[i] -= a[i, j] * b[j]
        b[i] /= a[i, i]
