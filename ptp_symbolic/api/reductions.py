"""Numbers that stand for a whole trajectory: largest value, rms, pointing error, settling time."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, parse_profile, stack, values_at
from ptp_symbolic.platform.units import quantity

FloatArray = NDArray[np.float64]

SETTLING = "settling_time"
FORMS = {
    "final": "final(SIGNAL)",
    "largest": "largest(SIGNAL)",
    "rms": "rms(SIGNAL)",
    "rms_error": "rms_error(SIGNAL; REFERENCE)",
    "largest_error": "largest_error(SIGNAL; REFERENCE)",
    SETTLING: "settling_time(SIGNAL; BAND)",
    "pointing_error": "pointing_error(theta_pan = REFERENCE; theta_tilt = REFERENCE)",
    "largest_pointing_error": "largest_pointing_error(theta_pan = REFERENCE; ...)",
}
SHAPE = re.compile(r"\s*(\w+)\s*\((.*)\)\s*", re.DOTALL)
PAN, TILT = "theta_pan", "theta_tilt"


@dataclass(frozen=True, eq=False)
class Reduction:
    """One number per trajectory: its `text`, its kind (a key of FORMS), the signals that it reads,
    its unit, the reference [k] of every signal that has one, and a band in the unit of the signal.
    """

    text: str
    kind: str
    signals: tuple[str, ...]
    unit: str
    references: Mapping[str, FloatArray]
    band: float = 0.0

    def __call__(self, times: FloatArray, signals: Mapping[str, FloatArray]) -> FloatArray:
        """The numbers [b] of `signals` [b, k] at `times` [k] in s; NaN where a signal is NaN."""
        value = self._value(signals)
        if self.kind == "final":
            return value[:, -1].copy()
        if self.kind == SETTLING:
            return self._settling(times, value)
        if self.kind.startswith("largest"):
            found: FloatArray = np.abs(value).max(axis=1)
            return found
        return np.sqrt(np.mean(value**2, axis=1))

    def slopes(
        self, signals: Mapping[str, FloatArray], tangents: Mapping[str, FloatArray]
    ) -> FloatArray:
        """The derivatives [b, m] of the numbers, by the derivatives `tangents` [b, k, m] of
        `signals` [b, k]; NaN where there are none.

        The largest value is differentiated where it is met.
        """
        value = self._value(signals)
        if "pointing" in self.kind:
            slope = line_of_sight_slope(signals, tangents, self.references)
        else:
            slope = tangents[self.signals[0]]
        if self.kind == "final":
            return slope[:, -1].copy()
        if self.kind.startswith("largest"):
            rows, where = np.arange(len(value)), np.abs(value).argmax(axis=1)
            value, slope = value[rows, where][:, None], slope[rows, where][:, None]
        # The derivative of a root of a mean square; that of the magnitude of a single value too.
        square = np.mean(value**2, axis=1)[:, None]
        with np.errstate(invalid="ignore"):
            found = np.mean(value[:, :, None] * slope, axis=1) / np.sqrt(square)
        return np.where((square == 0.0) & (slope == 0.0).all(axis=1), 0.0, found)

    def _value(self, signals: Mapping[str, FloatArray]) -> FloatArray:
        """What the number is of [b, k]: a signal, or its deviation from the reference."""
        if "pointing" in self.kind:
            return line_of_sight_error(signals, self.references)
        (name,) = self.signals
        return signals[name] - self.references.get(name, 0.0)

    def _settling(self, times: FloatArray, value: FloatArray) -> FloatArray:
        """Time in s of the first sample from which on the signal stays within the band about its
        last value.
        """
        outside = ~(np.abs(value - value[:, -1:]) <= self.band)
        last = outside.shape[1] - 1 - np.argmax(outside[:, ::-1], axis=1)
        after = np.minimum(last + 1, len(times) - 1)
        settled = np.where(outside.any(axis=1), times[after], times[0])
        return np.where(np.isnan(value).any(axis=1), np.nan, settled)


def line_of_sight_error(
    signals: Mapping[str, FloatArray], references: Mapping[str, FloatArray]
) -> FloatArray:
    """Angle [b, k] in rad between the line of sight of the angles [b, k] among `signals` and that
    of the `references` [k] (haversine); an axis without reference adds nothing.
    """
    pan, tilt = signals.get(PAN, np.zeros(1)), signals.get(TILT, np.zeros(1))
    aim_pan, aim_tilt = references.get(PAN, pan), references.get(TILT, tilt)
    across = np.cos(tilt) * np.cos(aim_tilt) * np.sin(0.5 * (pan - aim_pan)) ** 2
    return 2.0 * np.arcsin(np.sqrt(np.sin(0.5 * (tilt - aim_tilt)) ** 2 + across))


def line_of_sight_slope(
    signals: Mapping[str, FloatArray],
    tangents: Mapping[str, FloatArray],
    references: Mapping[str, FloatArray],
) -> FloatArray:
    """Derivatives [b, k, m] of `line_of_sight_error`, by those of the angles [b, k, m]; zero where
    the error is zero, and has none.
    """
    pan, tilt = signals.get(PAN, np.zeros((1, 1))), signals.get(TILT, np.zeros((1, 1)))
    aim_pan, aim_tilt = references.get(PAN, pan), references.get(TILT, tilt)
    square = np.sin(0.5 * (pan - aim_pan)) ** 2
    # Of the haversine h = sin^2(error / 2), by pan and tilt; an axis without reference aims itself.
    by_pan = 0.5 * np.cos(tilt) * np.cos(aim_tilt) * np.sin(pan - aim_pan)
    by_tilt = 0.5 * np.sin(tilt - aim_tilt) - np.sin(tilt) * np.cos(aim_tilt) * square
    if TILT not in references:
        by_tilt = -2.0 * np.sin(tilt) * np.cos(tilt) * square
    error = line_of_sight_error(signals, references)
    slopes = [
        by[:, :, None] * tangents[name]
        for name, by in ((PAN, by_pan), (TILT, by_tilt))
        if name in tangents
    ]
    safe = np.where(error == 0.0, np.inf, np.sin(error))
    found: FloatArray = 2.0 * np.sum(slopes, axis=0) / safe[:, :, None]
    return found


def reductions(
    model: Model, texts: Sequence[str], signals: Sequence[str], times: FloatArray
) -> list[Reduction]:
    """The reductions that `texts` ask for; `signals` are the names that may be read, at `times` [k]
    in s. Raises InputError for other forms, names, references and bands.
    """
    return [_reduction(model, text, signals, times) for text in texts]


def is_reduction(text: str) -> bool:
    """Whether `text` has the form of a reduction and is not the name of a signal."""
    return "(" in text


def _reduction(model: Model, text: str, known: Sequence[str], times: FloatArray) -> Reduction:
    found = SHAPE.fullmatch(text)
    if found is None or found[1] not in FORMS:
        raise InputError(f"Output '{text}' is not understood; write {', '.join(FORMS.values())}.")
    kind, body = found[1], found[2]
    if "pointing" in kind:
        return _pointing(model, text, kind, body, known, times)
    name, separator, second = (
        (part.strip() for part in re.split(r"([;,])", body, maxsplit=1))
        if (re.search(r"[;,]", body))
        else (body.strip(), "", "")
    )
    if name not in known:
        raise unknown("signal", name, known)
    unit = model.units[name]
    needs_second = ";" in FORMS[kind]
    if needs_second != bool(separator and second):
        raise InputError(f"Output '{text}': write {FORMS[kind]}.")
    if kind == SETTLING:
        band = quantity(_number(second), unit, f"Band of '{text}'")
        if not band > 0.0:
            raise InputError(f"Output '{text}': a band of {band:g} {unit}; give one above zero.")
        return Reduction(text, kind, (name,), "s", {}, band)
    given = {name: _reference(second, unit, text, times)} if needs_second else {}
    return Reduction(text, kind, (name,), unit, given)


def _pointing(
    model: Model, text: str, kind: str, body: str, known: Sequence[str], times: FloatArray
) -> Reduction:
    references = {}
    for part in body.split(";"):
        name, equals, profile = (each.strip() for each in part.partition("="))
        if not equals or name not in (PAN, TILT) or name not in known:
            raise InputError(f"Output '{text}': write {FORMS[kind]}.")
        references[name] = _reference(profile, model.units[name], text, times)
    present = tuple(name for name in (PAN, TILT) if name in known)
    if any(model.units[name] != "rad" for name in present):
        raise InputError(f"Output '{text}': an axis of '{model.name}' slides and points nowhere.")
    return Reduction(text, kind, present, "rad", references)


def reference(text: str, unit: str, times: FloatArray) -> FloatArray:
    """A profile or a quantity as values [k] at the times in s. Raises InputError for another."""
    if ":" in text:
        signal = parse_profile(text, float(times[-1] - times[0]))
    else:
        signal = constant(quantity(_number(text), unit, "Reference"))
    return values_at(stack([signal]), times)[:, 0]


def _reference(text: str, unit: str, where: str, times: FloatArray) -> FloatArray:
    try:
        return reference(text, unit, times)
    except InputError as error:
        raise InputError(f"Output '{where}': {error}") from error


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
