"""The section of the report on how well Tables 4.1 and 4.2 are determined."""

import numpy as np

from ptp_symbolic.report.latex_text import table, unit_latex
from ptp_symbolic.thesis.precision import (
    NOISE,
    PHASES,
    TORQUE_NOISE,
    Precision,
    all_precisions,
    least_inertia_deviation,
    map_precision,
    ramp_precision,
    spread_of_tests,
    start_margin,
)
from ptp_symbolic.thesis.printed import DIRECTIONS, UNITS
from ptp_symbolic.thesis.ramp_test import FITTED
from ptp_symbolic.thesis.wording import number_latex, text_latex

SIGNS = {"positive": r"$\omega > 0$", "negative": r"$\omega < 0$"}
DIGITS = 2


def precision_section() -> str:
    """Spread, standard deviations and correlations of the estimates, with what they say."""
    return "\n\n".join(
        [r"\section{How well Tables 4.1 and 4.2 are determined}", _ramp_part(), _map_part()]
    )


def _ramp_part() -> str:
    free = [p for p in all_precisions() if p.test is not None]
    bounded = sum(bool(p.on_bound[0]) for p in free)
    spread = max(spread_of_tests(direction)[0] for direction in DIRECTIONS)
    intro = (
        "Table 4.2. The spread is the standard deviation of the five printed rows. The Fisher bound"
        " is the smallest standard deviation that an unbiased estimate from one test can have"
        f" ({NOISE['table_4_2']}). Fits: standard deviation of {len(PHASES)} fits of the same test,"
        " which start at different places within a count. Rounding is not white: fits may scatter"
        " less than the bound. F_s and v_s scatter more: they rest on the first counts after"
        " breakaway. A range covers the five tests."
    )
    outcome = (
        f"The printed J scatter by at most {spread:.1g} kg m^2, but the standard deviation of J"
        f" from one test is {least_inertia_deviation():.1g} kg m^2 or more: the bounds of Appendix"
        f" C determine J, which ends on one of them in {bounded} of {len(free)} fits (erratum 16)."
        " The friction parameters of the five tests differ by many times what rounding explains:"
        " friction changed from test to test, or the model lacks an effect."
    )
    return "\n\n".join(
        [text_latex(intro), _spread_table(), _test_table(), text_latex(outcome), _correlations()]
    )


def _spread_table() -> str:
    rows = []
    for direction in DIRECTIONS:
        tests = [ramp_precision(direction, number) for number in range(1, 6)]
        for k, name in enumerate(FITTED):
            fisher, fits = ([getattr(t, what)[k] for t in tests] for what in ("fisher", "spread"))
            printed = np.mean([t.printed[k] for t in tests])
            spread = spread_of_tests(direction)[k]
            rms = float(np.sqrt(np.mean(np.square(fisher))))
            rows.append(
                [
                    SIGNS[direction],
                    _name(name),
                    number_latex(float(printed), 4),
                    number_latex(float(spread), DIGITS),
                    _range(fisher),
                    _range(fits),
                    number_latex(float(spread) / rms, DIGITS + 1),
                    unit_latex(UNITS[name]),
                ]
            )
    head = ["", "", "mean", "spread", "Fisher bound", "fits", "spread / bound", "unit"]
    return table("llllllll", head, rows)


def _test_table() -> str:
    rows = [
        [SIGNS[p.direction], str(p.test), *map(_pair, p.fisher, p.spread)]
        for p in all_precisions()
        if p.test is not None
    ]
    head = ["", "test", *(f"{_name(n)} in {unit_latex(UNITS[n])}" for n in FITTED)]
    title = text_latex("Fisher bound / spread of fits, test by test:")
    return _together(title + table("lllllll", head, rows), 1.0)


def _correlations() -> str:
    parts = [
        _together(_correlation_table(ramp_precision(direction, 1)), 0.48)
        for direction in DIRECTIONS
    ]
    text = text_latex(
        "Correlations of the errors, test 1 of either direction (all tests in thesis.json): F_c"
        " gives back almost all that J takes, and F_v follows J."
    )
    return text + "\n\n" + r"\hfill".join(parts)


def _correlation_table(precision: Precision) -> str:
    names = [_name(name) for name in precision.parameters]
    rows = [
        [name, *(f"${value:.2f}$" for value in row[: k + 1]), *[""] * (len(names) - k - 1)]
        for k, (name, row) in enumerate(zip(names, precision.correlation, strict=True))
    ]
    return table("l" + "r" * len(names), [SIGNS[precision.direction], *names], rows)


def _map_part() -> str:
    rows = []
    for direction in DIRECTIONS:
        p = map_precision(direction)
        for k, name in enumerate(p.parameters):
            correlation = ", ".join(f"${value:.2f}$" for value in p.correlation[k, :k])
            rows.append(
                [
                    SIGNS[direction],
                    _name(name),
                    number_latex(float(p.printed[k])),
                    number_latex(float(p.lower[k]), DIGITS),
                    number_latex(float(p.upper[k]), DIGITS),
                    _pair(p.fisher[k], p.spread[k]),
                    correlation,
                    unit_latex(UNITS[name]),
                ]
            )
    intro = (
        f"Table 4.1. Assumed is {NOISE['table_4_1']}; fits of Appendix B to such data scatter as"
        " the second number says. Correlations are those with the parameters above in the same"
        " direction."
    )
    head = ["", "", "printed", "lower", "upper", "Fisher bound / fits", "correlation", "unit"]
    outcome = (
        f"With {TORQUE_NOISE:g} N m of noise the upper bound of F_c for omega < 0 still lies"
        f" {start_margin():.0f} standard deviations above the estimate, so that moving the start of"
        " F_c below it changes nothing (erratum 14)."
    )
    return "\n\n".join([text_latex(intro), table("llllllll", head, rows), text_latex(outcome)])


def _name(parameter: str) -> str:
    return text_latex(parameter) if "_" in parameter else f"${parameter}$"


def _together(text: str, width: float) -> str:
    """A block that no page break tears, as wide as a share of the line."""
    return rf"\begin{{minipage}}[t]{{{width}\textwidth}}{text}\end{{minipage}}"


def _range(values: list[float]) -> str:
    return f"{number_latex(min(values), DIGITS)} to {number_latex(max(values), DIGITS)}"


def _pair(first: float, second: float) -> str:
    return f"{number_latex(float(first), DIGITS)} / {number_latex(float(second), DIGITS)}"
