"""Numba, in double precision, in single precision, and for several states at once."""

from ptp_symbolic.symbolic.targets.printing import Language


def _numba(name: str, number: str) -> Language:
    """The language with numbers written as `number`; other operations are those of Python. In
    single precision none is left that gives a double or a whole number.
    """
    zero, one, half = map(number.format, ("0.0", "1.0", "0.5"))
    whole = number.format("math.floor({0})")
    operations = {
        "pow": "{0}**{1}",
        "sqrt": "math.sqrt({0})",
        "inverse sqrt": f"{one} / math.sqrt({{0}})",
        "floor": whole,
        "sign": f"({zero} if {{0}} == {zero} else math.copysign({one}, {{0}}))",
        "Heaviside": f"({one} if {{0}} > {zero} else {zero})",
        "NearestCount": f"({{1}} * {whole.format(f'({{0}}) / {{1}} + {half}')})",
        "pi": number.format("math.pi"),
    }
    return Language(name, operations, number)


DOUBLE, FLOAT = _numba("numba", "{0}"), _numba("numba-float", "float32({0})")
IN_LANES = Language(
    "numba, several states at once",
    {**DOUBLE.operations, "sin": "lane_sin({0})", "cos": "lane_cos({0})"},
)
