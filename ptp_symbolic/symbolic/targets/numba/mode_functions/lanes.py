"""Sine and cosine that LLVM computes for several states per instruction.

The text is copied into emitted modules from the mark on. There is no branch and no table: the
argument is reduced by multiples of pi/2, held in three parts, and the polynomials are those of
FreeBSD's msun (k_sin.c, k_cos.c). Errors stay below 2 units in the last place up to 1e5 rad, and
reductions that a sine and a cosine of one angle have in common are computed once.
"""

from numba import njit

# copied from here on


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_quarter(x):
    """Return the multiple of pi/2 nearest to x: adding 1.5 * 2**52 rounds to a whole number."""
    return (0.6366197723675814 * x + 6755399441055744.0) - 6755399441055744.0


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_polynomials(x, n):
    """Return sine and cosine of x - n pi/2, which lies within pi/4."""
    r = ((x - n * 1.5707963267341256) - n * 6.077100506303966e-11) - n * 2.0222662487959506e-21
    z = r * r
    sine = 2.7557313707070068e-06 + z * (-2.5050760253406863e-08 + z * 1.58969099521155e-10)
    sine = 0.00833333333332249 + z * (-0.0001984126982985795 + z * sine)
    sine = r + r * z * (-0.16666666666666632 + z * sine)
    cosine = -2.7557314351390663e-07 + z * (2.087572321298175e-09 - z * 1.1359647557788195e-11)
    cosine = 0.0416666666666666 + z * (
        -0.001388888888887411 + z * (2.480158728947673e-05 + z * cosine)
    )
    half = 0.5 * z
    least = 1.0 - half
    return sine, least + (((1.0 - least) - half) + z * z * cosine)


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_sin(x):
    """Return the sine of x in rad."""
    n = lane_quarter(x)
    sine, cosine = lane_polynomials(x, n)
    turn = n - 4.0 * ((0.25 * n + 6755399441055744.0) - 6755399441055744.0)
    value = cosine if abs(turn) == 1.0 else sine
    return -value if (turn < 0.0) | (turn > 1.5) else value


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_cos(x):
    """Return the cosine of x in rad."""
    n = lane_quarter(x)
    sine, cosine = lane_polynomials(x, n)
    turn = n - 4.0 * ((0.25 * n + 6755399441055744.0) - 6755399441055744.0)
    value = sine if abs(turn) == 1.0 else cosine
    return -value if (turn > 0.5) | (turn < -1.5) else value


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def lane_sines(w):
    """Replace every angle of w [k] in rad by its sine."""
    for i in range(len(w)):
        w[i] = lane_sin(w[i])
