"""Programs written in the languages that others run. To add a target, write its file and name it
here.
"""

from ptp_symbolic.symbolic.targets.arrays import CASADI, JAX
from ptp_symbolic.symbolic.targets.c99 import C99_DOUBLE, C99_FLOAT
from ptp_symbolic.symbolic.targets.fmi import FMU_2, FMU_3
from ptp_symbolic.symbolic.targets.multibody import Mjcf, Urdf
from ptp_symbolic.symbolic.targets.numba.module import NUMBA_DOUBLE, NUMBA_FLOAT
from ptp_symbolic.symbolic.targets.octave import Octave
from ptp_symbolic.symbolic.targets.target import Target

TARGETS: tuple[Target, ...] = (
    C99_DOUBLE,
    C99_FLOAT,
    FMU_3,
    FMU_2,
    NUMBA_DOUBLE,
    NUMBA_FLOAT,
    CASADI,
    JAX,
    Octave(),
    Mjcf(),
    Urdf(),
)
