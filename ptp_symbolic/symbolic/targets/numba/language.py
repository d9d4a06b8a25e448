"""Python that numba compiles."""

from ptp_symbolic.symbolic.targets.printing import Language

NUMBA = Language(
    "numba",
    {
        "pow": "{0}**{1}",
        "sqrt": "math.sqrt({0})",
        "inverse sqrt": "1/math.sqrt({0})",
        "Heaviside": "(1.0 if {0} > 0.0 else 0.0)",
        "NearestCount": "({1} * math.floor(({0}) / {1} + 0.5))",
        "pi": "math.pi",
    },
)
