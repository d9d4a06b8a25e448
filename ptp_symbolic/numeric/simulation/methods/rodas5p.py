"""Rosenbrock coefficients Rodas5P: order 5 with an embedded order 4 and an interpolant of order 4.

Source: G. Steinebach, Construction of Rosenbrock-Wanner method Rodas5P and numerical benchmarks
within the Julia Differential Equations package, BIT Numerical Mathematics 63:27 (2023), in the
form without products of matrix and vector (Hairer and Wanner, Solving ODEs II, section IV.7).
L-stable and stiffly accurate: the last stage is the error estimate.
"""

import numpy as np

STAGES = 8
GAMMA = 0.21193756319429014

# Where every stage lies in the step, and the weight of the derivative by time.
C = np.array(
    [0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1, 1, 1]
)
D = np.array(
    [
        0.21193756319429014, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734,
        2.325825639765069, 0.0, 0.0, 0.0,
    ]
)  # fmt: skip

# Weights of the stages before, in the point where a stage is taken.
A = np.zeros((STAGES, STAGES))
A[1, :1] = [3.0]
A[2, :2] = [2.849394379747939, 0.45842242204463923]
A[3, :3] = [-6.954028509809101, 2.489845061869568, -10.358996098473584]
A[4, :4] = [2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641]
A[5, :5] = [
    -7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256,
    0.030198172008377946,
]  # fmt: skip
A[6, :5], A[6, 5] = A[5, :5], 1.0
A[7, :6], A[7, 6] = A[6, :6], 1.0

# Weights of the stages before, over the step length, on the right-hand side of a stage.
COUPLING = np.zeros((STAGES, STAGES))
COUPLING[1, :1] = [-14.155112264123755]
COUPLING[2, :2] = [-17.97296035885952, -2.859693295451294]
COUPLING[3, :3] = [147.12150275711716, -1.41221402718213, 71.68940251302358]
COUPLING[4, :4] = [
    165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306,
]  # fmt: skip
COUPLING[5, :5] = [
    24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125,
    -0.6610691825249471,
]  # fmt: skip
COUPLING[6, :6] = [
    30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783,
    -19.097331116725623, -28.087943162872662,
]  # fmt: skip
COUPLING[7, :7] = [
    37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047,
    -40.06618937091002, -54.66780262877968, -9.48861652309627,
]  # fmt: skip

# Weights of the stages in the interpolant
# y(s) = (1 - s) y0 + s (y1 + (1 - s) (h0 + s (h1 + s h2))).
H = np.array(
    [
        [
            25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204,
            0.524948541321073, 1.1241088310450404, 0.4272876194431874, -0.17202221070155493,
        ],
        [
            -9.91568850695171, -0.9689944594115154, 3.0438037242978453, -24.495224566215796,
            20.176138334709044, 15.98066361424651, -6.789040303419874, -6.710236069923372,
        ],
        [
            11.419903575922262, 2.8879645146136994, 72.92137995996029, 80.12511834622643,
            -52.072871366152654, -59.78993625266729, -0.15582684282751913, 4.883087185713722,
        ],
    ]
)  # fmt: skip
