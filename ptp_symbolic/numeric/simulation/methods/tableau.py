"""Explicit Runge-Kutta coefficients of Tsitouras, order 5(4), with its free interpolant.

Source: Ch. Tsitouras, Runge-Kutta pairs of order 5(4) satisfying only the first column simplifying
assumption, Computers and Mathematics with Applications 62 (2011) 770-775, Table 1 and section 4.
"""

import numpy as np

STAGES = 7
ORDER = 5

C = np.array([0.0, 0.161, 0.327, 0.9, 0.9800255409045097, 1.0, 1.0])
A = np.zeros((STAGES, STAGES))
A[1, :1] = [0.161]
A[2, :2] = [-0.008480655492356989, 0.335480655492357]
A[3, :3] = [2.8971530571054935, -6.359448489975075, 4.3622954328695815]
A[4, :4] = [5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525]
A[5, :5] = [
    5.86145544294642,
    -12.92096931784711,
    8.159367898576159,
    -0.071584973281401,
    -0.028269050394068383,
]
A[6, :6] = [
    0.09646076681806523,
    0.01,
    0.4798896504144996,
    1.379008574103742,
    -3.290069515436081,
    2.324710524099774,
]
ERROR = np.array(
    [
        -0.00178001105222577714,
        -0.0008164344596567469,
        0.007880878010261995,
        -0.1447110071732629,
        0.5823571654525552,
        -0.45808210592918697,
        0.015151515151515152,
    ]
)

# Weight of every stage in the powers 1 to 4 of the fraction of a step: the free interpolant.
INTERPOLANT = np.zeros((4, STAGES))
for _stage, _factor, _roots, _square in (
    (0, -1.0530884977290216, (0.0, 1.3299890189751412), (1.4364028541716351, 0.7139816917074209)),
    (1, 0.1017, (0.0, 0.0), (2.1966568338249754, 1.2949852507374631)),
    (2, 2.490627285651252793, (0.0, 0.0), (2.38535645472061657, 1.57803468208092486)),
    (3, -16.54810288924490272, (0.0, 0.0, 1.21712927295533244, 0.61620406037800089), None),
    (4, 47.37952196281928122, (0.0, 0.0, 1.203071208372362603, 0.658047292653547382), None),
    (5, -34.87065786149660974, (0.0, 0.0, 1.2, 0.666666666666666667), None),
    (6, 2.5, (0.0, 0.0, 1.0, 0.6), None),
):
    _polynomial = _factor * np.poly(_roots)
    if _square is not None:
        _polynomial = np.convolve(_polynomial, [1.0, -_square[0], _square[1]])
    INTERPOLANT[:, _stage] = _polynomial[3::-1]
