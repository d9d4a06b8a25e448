"""Errata of the estimation of friction (chapter 4, Appendices B and C)."""

import numpy as np
from scipy.optimize import least_squares

from ptp_symbolic.thesis import printed, ramp_test
from ptp_symbolic.thesis.friction import drive_values, estimated, start_of
from ptp_symbolic.thesis.items import Item, erratum
from ptp_symbolic.thesis.precision import (
    TORQUE_NOISE,
    least_inertia_deviation,
    ramp_precision,
    spread_of_tests,
    start_margin,
)


def _averages(number: int, direction: str) -> tuple[str, str, list[tuple[int, ...]]]:
    """Printed and computed averages of friction in one line each, and the subsets that match."""
    average, tests = printed.TABLE_4_2_AVERAGE[direction], printed.TABLE_4_2[direction]
    names = ramp_test.COLUMNS[1:]
    given = ", ".join(f"{n} {ramp_test.column([average], n)[0]:.4g}" for n in names)
    found = ", ".join(f"{n} {ramp_test.column(tests, n).mean():.5g}" for n in names)
    return given, found, ramp_test.matching_subsets(direction)


def averages_forward() -> Item:
    """Erratum 12: the averages of Table 4.2 for omega > 0."""
    given, found, subsets = _averages(12, "positive")
    return erratum(
        12,
        "Table 4.2, averages, omega > 0",
        given,
        found,
        "",
        subsets == [(1, 2, 3, 4)],
        "means of all five tests; the printed four are means of tests"
        f" {' or '.join(', '.join(map(str, subset)) for subset in subsets)} alone",
    )


def averages_backward() -> Item:
    """Erratum 13: the averages of Table 4.2 for omega < 0."""
    given, found, subsets = _averages(13, "negative")
    inertia = ramp_test.column(printed.TABLE_4_2["negative"], "J").mean()
    return erratum(
        13,
        "Table 4.2, averages, omega < 0",
        given,
        found,
        "",
        subsets == [],
        "means of all five tests; of the 31 subsets none gives the printed four;"
        f" J = {inertia:.4f} is right",
    )


def start_outside() -> Item:
    """Erratum 14: the start of F_c in Appendix B lies outside its bounds."""
    lower, upper = printed.APPENDIX_B_BOUNDS["negative"]
    start = start_of("negative")
    refused = False
    try:
        least_squares(lambda x: x, start, bounds=(lower, upper))
    except ValueError:
        refused = True
    error = abs(estimated("negative").F_c / printed.TABLE_4_1["negative"].F_c - 1.0)
    return erratum(
        14,
        "Appendix B, start of F_c, omega < 0",
        float(start[0]),
        upper[0],
        "N m",
        refused and start[0] > upper[0] and error < 1e-3,
        "printed: start, computed: its upper bound. A bounded solver refuses the start; moved"
        f" inside, the fit still recovers F_c (relative error {error:.0e}); the bound lies"
        f" {start_margin():.0f} standard deviations above the estimate, Fisher information with"
        f" {TORQUE_NOISE:g} N m of noise",
    )


def precedence() -> Item:
    """Erratum 15: the operator precedence in Appendix C."""
    p = drive_values()
    motor = p["J_motor_pan"] * p["N_pan"] ** 2
    given = 1.0 / motor + printed.INERTIA
    right = 1.0 / (motor + printed.INERTIA)
    test = printed.TABLE_4_2["positive"][0]
    fitted = ramp_test.fit(
        ramp_test.measured_angle(test), motor_inertia=1.0 / given - printed.INERTIA
    )
    shift = fitted.value("v_s") / test.friction.v_s - 1.0
    spread = ramp_precision("positive", 1).spread[ramp_test.FITTED.index("v_s")]
    deviations = abs(fitted.value("v_s") - test.friction.v_s) / float(spread)
    return erratum(
        15,
        "Appendix C, acceleration per torque",
        given,
        right,
        "1/(kg m^2)",
        abs(motor - printed.APPENDIX_C_MOTOR_INERTIA) < 1e-12
        and given > 1.15 * right
        and deviations > 3.0,
        f"(1/Jm + Js) against 1/(Jm + Js) with Jm = 1.1e-5 x 500^2 = {motor:g}, Js = 0.05 kg m^2;"
        f" test 1 fitted as printed: v_s off by {100 * shift:.0f} %, {deviations:.0f} standard"
        f" deviations of fits of that test, rms {fitted.rms_counts:.2g} counts",
    )


def inertia_bounds() -> Item:
    """Erratum 16: the ramp test does not identify J."""
    ends = [
        min(abs(e.value("J") - bound) for bound in (0.049, 0.051)) < 1e-6
        for direction in printed.DIRECTIONS
        for e in ramp_test.estimates(direction)
    ]
    change = ramp_test.angle_change_between_bounds()
    free, shifted = ramp_test.inertia_without_bounds()
    rise = float(np.ptp(ramp_test.inertia_profile()[:, 1]))
    least = least_inertia_deviation()
    spread = max(float(spread_of_tests(direction)[0]) for direction in printed.DIRECTIONS)
    width = printed.APPENDIX_C_UPPER[0] - printed.APPENDIX_C_LOWER[0]
    return erratum(
        16,
        "section 4.3 and Appendix C, J",
        "estimated",
        "at its bounds",
        "",
        sum(ends) >= 8 and change < 1.0 and rise < 0.05 and least > max(2.0 * width, 10.0 * spread),
        f"J ends on a bound in {sum(ends)} of {len(ends)} tests; a test leaves J a standard"
        f" deviation of {least:.1g} kg m^2 or more (Fisher information), the bounds are {width:.1g}"
        f" apart and the printed J scatter by {spread:.1g}; from bound to bound the angle"
        f" changes by {change:.2g} counts; profile 0 to 0.1 kg m^2 raises the residual by"
        f" {rise:.1g} counts; Jm 2 % off moves J from {free:.3f} to {shifted:.3f} kg m^2",
    )
