"""C99, in double and in single precision."""

from ptp_symbolic.symbolic.targets.printing import Language
from ptp_symbolic.symbolic.targets.words import WORDS


def _c99(name: str, suffix: str) -> Language:
    """The language with the `suffix` of a precision behind functions and numbers."""
    s, zero, one, half = suffix, f"0.0{suffix}", f"1.0{suffix}", f"0.5{suffix}"
    operations = {
        "pow": f"pow{s}({{0}}, {{1}})",
        "sqrt": f"sqrt{s}({{0}})",
        "inverse sqrt": f"{one} / sqrt{s}({{0}})",
        "exp": f"exp{s}({{0}})",
        "log": f"log{s}({{0}})",
        "sin": f"sin{s}({{0}})",
        "cos": f"cos{s}({{0}})",
        "acos": f"acos{s}({{0}})",
        "Abs": f"fabs{s}({{0}})",
        "floor": f"floor{s}({{0}})",
        "sign": f"({{0}} == {zero} ? {zero} : copysign{s}({one}, {{0}}))",
        "Min": f"fmin{s}({{0}}, {{1}})",
        "Max": f"fmax{s}({{0}}, {{1}})",
        "Heaviside": f"({{0}} > {zero} ? {one} : {zero})",
        "NearestCount": f"({{1}} * floor{s}(({{0}}) / {{1}} + {half}))",
        "choice": "(({0}) != 0 ? ({1}) : ({2}))",
        "And": "(({0}) != 0 && ({1}) != 0)",
        "Or": "(({0}) != 0 || ({1}) != 0)",
        "pi": f"3.141592653589793{s}",
    }
    return Language(name, operations, f"{{0}}{suffix}", WORDS)


DOUBLE, FLOAT = _c99("c99", ""), _c99("c99-float", "f")
