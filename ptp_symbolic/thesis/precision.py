"""How well the data of Tables 4.1 and 4.2 determine the parameters printed there.

The measurements are not printed. The Fisher information of the experiment bounds the standard
deviation of every estimate from below (Cramer and Rao; Ljung, System Identification, 1999, section
7.4), and fits of data with other noise scatter; both are set beside the spread of the printed rows.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.thesis import printed, ramp_test
from ptp_symbolic.thesis.friction import fit_map, torque_map
from ptp_symbolic.thesis.printed import DIRECTIONS
from ptp_symbolic.thesis.ramp_test import COUNT, FITTED

FloatArray = NDArray[np.float64]

# Rounding to counts has the standard deviation of a uniform error.
ROUNDING = COUNT / np.sqrt(12.0)  # rad
# Where within a count the ramp test starts is not known: fits with that many places, evenly spread.
PHASES = (np.arange(24) + 0.5) / 24 - 0.5
# Noise of the torque map in N m, which the thesis does not print, and the fits with such noise.
TORQUE_NOISE, NOISY_MAPS, SEED = 0.05, 100, 1
MAP_FITTED = ("F_c", "F_s", "v_s", "F_v")
MAP_COLUMNS = [0, 1, 2, 4]  # without gamma, which its bounds hold
# Share of the width between its bounds within which an estimate lies on one.
ON_BOUND = 1e-3
NOISE = {
    "table_4_1": f"white noise of {TORQUE_NOISE:g} N m in the torque (chosen here; standard"
    " deviations are proportional to it), gamma known",
    "table_4_2": "rounding to 7200 counts as white noise, 1001 samples over 20 s, Jm known,"
    " J without bounds",
}


@dataclass(frozen=True, eq=False)
class Precision:
    """How well one estimation determines its parameters, SI units.

    `printed` [n] are the values that the data are made from, `estimated` [n] those of the fit with
    the bounds `lower` and `upper` [n] of its appendix. `fisher` [n]: smallest standard deviations,
    and `correlation` [n, n] of the errors; `spread` [n]: standard deviation of fits to data with
    other noise. `test` numbers the rows of Table 4.2.
    """

    table: str
    direction: str
    test: int | None
    parameters: tuple[str, ...]
    printed: FloatArray
    estimated: FloatArray
    lower: FloatArray
    upper: FloatArray
    fisher: FloatArray
    correlation: FloatArray
    spread: FloatArray

    @property
    def on_bound(self) -> NDArray[np.bool_]:
        """Per parameter [n] whether the fit ended on a bound."""
        width = self.upper - self.lower
        nearest = np.minimum(self.estimated - self.lower, self.upper - self.estimated)
        return nearest < ON_BOUND * width


def fisher_bound(slopes: FloatArray, noise: float) -> tuple[FloatArray, FloatArray]:
    """Standard deviations [n] and correlations [n, n] of the best unbiased estimate.

    `slopes` [k, n]: derivatives of the samples by the parameters; `noise`: standard deviation of
    independent errors of the samples, in their unit.
    """
    # scaled columns, so that parameters of other sizes do not cost digits
    size = np.linalg.norm(slopes, axis=0)
    scaled = slopes / size
    covariance = np.linalg.inv(scaled.T @ scaled) * noise**2 / np.outer(size, size)
    deviation = np.sqrt(np.diag(covariance))
    return deviation, covariance / np.outer(deviation, deviation)


@cache
def ramp_precision(direction: str, number: int) -> Precision:
    """Of row `number`, 1 to 5, of Table 4.2; J is free of the bounds of Appendix C."""
    test = printed.TABLE_4_2[direction][number - 1]
    fisher, correlation = fisher_bound(ramp_test.sensitivities(test, "theta_pan"), ROUNDING)
    truth = ramp_test.row(test)
    refits = [
        ramp_test.fit(ramp_test.measured_angle(test, phase), bounded=False, start=truth).x
        for phase in PHASES
    ]
    return Precision(
        "table_4_2",
        direction,
        number,
        FITTED,
        truth,
        ramp_test.estimates(direction)[number - 1].x,
        np.array(printed.APPENDIX_C_LOWER),
        np.array(printed.APPENDIX_C_UPPER),
        fisher,
        correlation,
        np.std(refits, axis=0, ddof=1),
    )


@cache
def map_precision(direction: str) -> Precision:
    """Of one direction of Table 4.1, the fit of Appendix B."""
    lower, upper = (np.array(b)[MAP_COLUMNS] for b in printed.APPENDIX_B_BOUNDS[direction])
    torques, random = torque_map(printed.TABLE_4_1[direction]), np.random.default_rng(SEED)
    exact = fit_map(torques, direction)
    fisher, correlation = fisher_bound(exact.jac[:, MAP_COLUMNS], TORQUE_NOISE)
    refits = [
        fit_map(torques + TORQUE_NOISE * random.standard_normal(len(torques)), direction).x
        for _ in range(NOISY_MAPS)
    ]
    return Precision(
        "table_4_1",
        direction,
        None,
        MAP_FITTED,
        np.array([getattr(printed.TABLE_4_1[direction], name) for name in MAP_FITTED]),
        exact.x[MAP_COLUMNS],
        lower,
        upper,
        fisher,
        correlation,
        np.std(refits, axis=0, ddof=1)[MAP_COLUMNS],
    )


def spread_of_tests(direction: str) -> FloatArray:
    """Standard deviation [5] of the five printed rows of Table 4.2, in the order of FITTED."""
    rows = np.array([ramp_test.row(test) for test in printed.TABLE_4_2[direction]])
    return np.std(rows, axis=0, ddof=1)


def all_precisions() -> list[Precision]:
    """Both directions of Table 4.1, then the ten tests of Table 4.2."""
    maps = [map_precision(direction) for direction in DIRECTIONS]
    return maps + [ramp_precision(d, number) for d in DIRECTIONS for number in range(1, 6)]


def least_inertia_deviation() -> float:
    """Smallest Fisher standard deviation of J in kg m^2 among the ten tests."""
    return min(float(p.fisher[0]) for p in all_precisions() if p.test is not None)


def start_margin() -> float:
    """Standard deviations by which the upper bound of F_c, omega < 0, exceeds its estimate."""
    found = map_precision("negative")
    k = found.parameters.index("F_c")
    return float((found.upper[k] - found.estimated[k]) / found.fisher[k])
