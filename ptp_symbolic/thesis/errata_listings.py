"""Errata of the two program listings (Appendices B and C)."""

import re

from ptp_symbolic.thesis import printed
from ptp_symbolic.thesis.items import Item, erratum


def undefined_names(listing: str) -> list[str]:
    """Names that a listing uses and never gives a value of their own."""
    used = {*re.findall(r"length\((\w+)\)", listing), *re.findall(r"\(:,(\w+)\)", listing)}
    assigned = dict(re.findall(r"\b(\w+)\s*=\s*([^;=]+);", listing))
    return sorted(n for n in used if n not in assigned or re.search(rf"\b{n}\b", assigned[n]))


def ramp_listing() -> Item:
    """Erratum 31: Appendix C."""
    start, upper = printed.APPENDIX_C_START.F_v, printed.APPENDIX_C_UPPER[-1]
    missing = undefined_names(printed.LISTING_C)
    solver = re.findall(r"(ode\w+)\(", printed.LISTING_C)[0]
    # the sticking branch F = u makes the acceleration zero at any speed below its limit
    speed, applied, step = 0.8 * printed.STICKING_SPEED, 1.0, 1e-3
    for _ in range(1000):
        sticks = abs(speed) < printed.STICKING_SPEED and abs(applied) < printed.APPENDIX_C_LOWER[2]
        speed += step * (applied - (applied if sticks else 0.0)) / printed.APPENDIX_C_MOTOR_INERTIA
    frozen = speed == 0.8 * printed.STICKING_SPEED
    return erratum(
        31,
        "Appendix C, listing",
        f"start of Tv {start:g}, {solver}",
        f"upper bound {upper:g}, {printed.SOLVER_IN_TEXT}",
        "",
        start > upper
        and missing == ["J", "counter"]
        and solver != printed.SOLVER_IN_TEXT
        and frozen,
        f"bounds and names of the listing: undefined {', '.join(missing)}; sticking branch run for"
        f" 1 s from {speed:g} rad/s: still {speed:g} rad/s, frozen instead of stopped",
    )


def map_listing() -> Item:
    """Erratum 32: Appendix B."""
    fitted = re.findall(r"(\w+)\(\w\)", printed.LISTING_B_FIT.split("x0 =")[1].split("]")[0])
    tested = fitted[: int(re.findall(r"i = 1:(\d)", printed.LISTING_B_FILTER)[0])]
    # counter starts at 1 and grows after every fit, so one fit fills column 1 and leaves 2
    overrun = "j = 1:counter" in printed.LISTING_B_FILTER and "counter=counter+1" in (
        printed.LISTING_B_FIT
    )
    return erratum(
        32,
        "Appendix B, filter and options",
        "four parameters, filter 1:4, GradObj",
        f"{len(fitted)} parameters: {', '.join(fitted)}",
        "",
        len(fitted) == 5
        and "gamma" in tested
        and "Tv" not in tested
        and overrun
        and "GradObj" in printed.LISTING_B_FIT,
        f"read from the listing: the filter tests {', '.join(tested)} and skips Tv; its loop ends"
        " one column past the last fit; lsqcurvefit takes 'Jacobian', GradObj belongs to fminunc",
    )
