"""Steady-state points: rates and torques of a CSV, in SI units."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.data.formats import read_table
from ptp_symbolic.numeric.data.table import Table
from ptp_symbolic.platform.fields import shown
from ptp_symbolic.platform.units import to_si

FloatArray = NDArray[np.float64]

SMALLEST, LARGEST = 1e-12, 1e12  # in SI units, of rates and torques: any machine's lie between
FINEST = 1e-9  # of the largest torque: no sensor measures more finely
MIN_POINTS = 4  # two for Coulomb and viscous friction, one for the scatter, one to leave out
_PERCENT = re.compile(r"% of (.+)")
_QUANTITY = re.compile(r"([0-9.]++(?:[eE][+-]?[0-9]+)?) *([^0-9].*)")


@dataclass(frozen=True)
class Units:
    """SI units of a joint that turns or slides, others that are often used, and its words."""

    rate: str
    torque: str
    other_rates: str
    other_torques: str
    nominal: str
    word: str

    @property
    def viscous(self) -> str:
        """The unit of torque over rate."""
        return f"{self.torque} s/{self.rate.removesuffix('/s')}"


ROTARY = Units("rad/s", "N m", "rpm, deg/s", "mN m", "9.84 mN m", "torque")
LINEAR = Units("m/s", "N", "mm/s", "mN", "40 N", "force")


@dataclass(frozen=True, eq=False)
class Points:
    """Steady points: `rate` [n], `torque` [n] (of a linear axis: force) that keeps it, `spread` [n]
    in the SI units of `units`.

    `spread` is the standard deviation of each torque, None where it is not known. A point at rate
    zero is a breakaway torque. `name` is that of the file.
    """

    name: str
    rate: FloatArray
    torque: FloatArray
    spread: FloatArray | None = None
    units: Units = ROTARY

    @property
    def sign(self) -> FloatArray:
        """Direction [n] of motion, +1 or -1; at rest that of the torque."""
        return np.sign(np.where(self.rate == 0.0, self.torque, self.rate))


@dataclass(frozen=True)
class Columns:
    """Names of the columns; `spread` None: the file gives no standard deviations.

    `nominal` is the torque that percents are of, such as "9.84 mN m", None where none is declared.
    """

    rate: str = "rate"
    torque: str = "torque"
    spread: str | None = None
    nominal: str | None = None


def read_points(path: Path, wanted: Columns) -> Points:
    """Read steady points from a CSV with units in its headings; rates in m/s are of a linear axis.

    Raises InputError for a file that is damaged (see `read_table`), a missing
    column, a unit that does not fit, a spread that is not positive, fewer than four points, one
    rate alone, a breakaway torque of zero, and torques that brake the motion.
    """
    table = read_table(path)
    names = {"rate": wanted.rate, "torque": wanted.torque}
    names |= {"spread": wanted.spread} if wanted.spread else {}
    places = [_place(table, name, what) for what, name in names.items()]
    units = _units(table, places[0])
    factors = [_factor(table, places[0], units.rate, units.other_rates)]
    factors += [_torque_factor(table, k, units, wanted.nominal) for k in places[1:]]
    values = table.complete(places) * np.array(factors)
    spread = values[:, 2] if wanted.spread else None
    points = Points(path.name, values[:, 0], values[:, 1], spread, units)
    _check(path, points)
    return points


def _place(table: Table, name: str, what: str) -> int:
    known = [heading for heading, _ in table.headings]
    if name not in known:
        more = f"; say by `{what}` which one it is"
        raise InputError(f"{table.head}: {unknown('column', name, known, more)}")
    return known.index(name)


def _units(table: Table, place: int) -> Units:
    """Those of a linear axis where the rate is in m/s, or in a unit that is some of it."""
    try:
        _, unit = to_si(table.headings[place][1] or "")
    except InputError:
        return ROTARY
    return LINEAR if unit == LINEAR.rate else ROTARY


def _torque_factor(table: Table, place: int, units: Units, nominal: str | None) -> float:
    """The factor from the unit of a heading, or from percents of a nominal torque."""
    name, given = table.headings[place]
    percent = _PERCENT.fullmatch(given or "")
    if given != "%" and percent is None:
        return _factor(table, place, units.torque, units.other_torques)
    where = f"{table.head}: column '{name}'"
    text = percent[1] if percent else nominal
    if text is None:
        raise InputError(
            f"{where} is in % of a {units.word} that nobody declares; add `nominal`"
            f" '{units.nominal}', or write '{name} [% of {units.nominal}]'."
        )
    return 0.01 * _nominal(where, text, units)


def _factor(table: Table, place: int, unit: str, others: str) -> float:
    """The factor from the unit of a heading to `unit`."""
    name, given = table.headings[place]
    where = f"{table.head}: column '{name}'"
    if not given:
        raise InputError(f"{where} has no unit; write '{name} [{unit}]', or one of {others}.")
    try:
        factor, found = to_si(given)
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    if found != unit:
        raise InputError(f"{where} is in {given}; give {unit}, or one of {others}.")
    return factor


def _nominal(where: str, text: str, units: Units) -> float:
    match = _QUANTITY.fullmatch(text.strip())
    try:
        value = float(match[1]) if match else 0.0
        factor, unit = to_si(match[2].strip()) if match else (1.0, "")
    except ValueError as error:
        raise InputError(f"{where}: nominal {units.word} {shown(text)}: {error}") from error
    if unit != units.torque or not value > 0.0:
        raise InputError(
            f"{where}: {shown(text)} is no nominal {units.word}; write a positive number and its"
            f" unit, such as '{units.nominal}'."
        )
    return factor * value


def _check(path: Path, points: Points) -> None:
    word = points.units.word
    count, speeds = len(points.rate), np.unique(np.abs(points.rate))
    if count < MIN_POINTS or len(speeds) < 2:
        raise InputError(
            f"{path}: has {count} points at {len(speeds)} speeds; a friction map needs at least"
            f" {MIN_POINTS} points at two."
        )
    _refuse_sizes(path, points)
    rest = np.flatnonzero((points.rate == 0.0) & (points.torque == 0.0))
    if len(rest):
        raise InputError(
            f"{path}:{rest[0] + 2}: both rate and {word} are zero; give the {word} with its sign"
            " at which the joint breaks away, or remove the row."
        )
    if points.spread is not None and not (points.spread > 0.0).all():
        line = int(np.argmin(points.spread)) + 2
        raise InputError(
            f"{path}:{line}: the standard deviation is {points.spread.min():g}"
            f" {points.units.torque}; give a positive one in every row, or leave out `spread`."
        )
    if points.spread is not None and points.spread.min() < FINEST * np.abs(points.torque).max():
        line, unit = int(np.argmin(points.spread)) + 2, points.units.torque
        raise InputError(
            f"{path}:{line}: the standard deviation is {points.spread.min():g} {unit} beside"
            f" {word}s of up to {np.abs(points.torque).max():g} {unit}, finer than any sensor; give"
            " that of repeated readings, or leave out `spread`."
        )
    if points.torque @ points.rate < 0.0:
        raise InputError(
            f"{path}: most {word}s brake the motion; give the {word} that drives the joint,"
            " positive where the rate is positive."
        )


def _refuse_sizes(path: Path, points: Points) -> None:
    units = points.units
    found = [("rate", points.rate, units.rate), (units.word, points.torque, units.torque)]
    if points.spread is not None:
        found.append(("standard deviation", points.spread, units.torque))
    for name, values, unit in found:
        size = np.abs(values[values != 0.0])
        wrong = size[~((size >= SMALLEST) & (size <= LARGEST))]
        if len(wrong):
            raise InputError(
                f"{path}: a {name} of {wrong[0]:g} {unit} is none of a machine; give at least"
                f" {SMALLEST:g} and at most {LARGEST:g} {unit}, or correct the unit."
            )
