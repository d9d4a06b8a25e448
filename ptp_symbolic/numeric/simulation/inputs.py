"""Input signals: profiles and log columns, packed so that a compiled integrator can evaluate them.

A signal is piecewise cubic, plus sines, plus linear-frequency sine sweeps. At a jump it has two
values: `side` +1 asks for the one after it (signals are right-continuous), -1 for the one before,
which is what an integration step that ends at the jump must see.

Input delays, as tables shifted in time.

Input profiles as a person types them on the command line: `step:24@0.5`, `constant:3`.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError, unknown, wrong_type
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.input_values import (
    evaluate_input_slopes_at,
    evaluate_inputs_at,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


KEPT, KEPT_TABLES = 256, 8  # signals of profiles, and tables of the same signals, met last


def _no_rows(columns: int) -> FloatArray:
    return np.empty((0, columns))


@dataclass(frozen=True, eq=False)
class InputSignal:
    """One input as a function of time, in the unit of the input it drives.

    breaks [m+1] in s, increasing: where the signal or a slope may jump; coefficients [m, 4]: cubic
    in (t - breaks[k]), constant before the first and after the last break; sines [r, 3]: amplitude,
    frequency in Hz, phase in rad; sweep [q, 5]: amplitude, first and last frequency in Hz, start
    and end in s, zero outside. Raises InputError on wrong shapes, NaN, infinity or unsorted times.
    """

    breaks: FloatArray
    coefficients: FloatArray
    sines: FloatArray = field(default_factory=lambda: _no_rows(3))
    sweep: FloatArray = field(default_factory=lambda: _no_rows(5))

    def __post_init__(self) -> None:
        columns = {"breaks": 1, "coefficients": 4, "sines": 3, "sweep": 5}
        for name, width in columns.items():
            array = np.array(getattr(self, name), dtype=np.float64)
            if array.size and not np.isfinite(array).all():
                raise InputError(f"Input signal: {name} holds NaN or infinity; give finite values.")
            if name != "breaks" and (array.ndim != 2 or array.shape[1] != width):
                raise InputError(f"Input signal: {name} has shape {array.shape}, not [n, {width}].")
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        pieces = len(self.coefficients)
        if pieces < 1 or self.breaks.shape != (pieces + 1,):
            raise InputError(
                f"Input signal: {pieces} pieces with breaks of shape {self.breaks.shape};"
                " give at least one piece and one break more than pieces."
            )
        _refuse_unsorted(self.breaks, "break times")
        if np.any(self.sweep[:, 3] >= self.sweep[:, 4]):
            raise InputError("Input signal: a sine sweep ends before it starts; give t0 < t1.")

    @cached_property
    def jumps(self) -> FloatArray:
        """Times in s at which the value or a derivative has a discontinuity."""
        c0, c1, c2, c3 = self.coefficients.T
        s = np.diff(self.breaks)
        values, slopes = c0 + s * (c1 + s * (c2 + s * c3)), c1 + s * (2 * c2 + 3 * s * c3)
        ends = np.array([values, slopes, c2 + 3 * s * c3, c3]).T
        outside = np.zeros((1, 4))
        left = np.concatenate([outside, ends])
        right = np.concatenate([self.coefficients, outside])
        left[0, 0], right[-1, 0] = c0[0], ends[-1, 0]
        return np.append(self.breaks[np.any(left != right, axis=1)], self.sweep[:, 3:])


def _refuse_unsorted(times: FloatArray, what: str) -> None:
    wrong = np.flatnonzero(np.diff(times) <= 0)
    if wrong.size:
        before, after = times[wrong[0]], times[wrong[0] + 1]
        raise InputError(
            f"Input signal: {what} go from {before:g} s to {after:g} s;"
            " give strictly increasing times."
        )


def _signal(rows: Sequence[Sequence[float]]) -> InputSignal:
    """Join rows (start time, c0, c1, c2, c3; short rows end in zeros); the last is constant."""
    kept = [row for row, after in pairwise(rows) if after[0] != row[0]]
    kept.append(rows[-1])
    times = [row[0] for row in kept]
    coefficients = [[*row[1:], *[0.0] * (5 - len(row))] for row in kept]
    return InputSignal(np.array([*times, times[-1] + 1.0]), np.array(coefficients))


@lru_cache(maxsize=KEPT)
def constant(value: float) -> InputSignal:
    """The same value for ever."""
    return _signal([(0.0, value)])


def step(before: float, after: float, at: float) -> InputSignal:
    """A jump from `before` to `after` at time `at` in s; at that instant the value is `after`."""
    return _signal([(at - 1.0, before), (at, after)])


def ramp(start: float, end: float, t0: float, t1: float, then: float | None = None) -> InputSignal:
    """A straight line from `start` at t0 to `end` at t1 (s), afterwards `then` (None: `end`).

    Raises InputError unless t0 < t1.
    """
    _refuse_unsorted(np.array([t0, t1]), "start and end of the ramp")
    slope = (end - start) / (t1 - t0)
    return _signal([(t0, start, slope), (t1, end if then is None else then)])


def trapezoid(
    level: float, rise: float, hold: float, fall: float, start: float = 0.0
) -> InputSignal:
    """From zero up to `level` in `rise` s, there for `hold` s, down to zero in `fall` s.

    A duration of zero makes that edge a jump. Raises InputError on a negative duration.
    """
    for name, duration in (("rise", rise), ("hold", hold), ("fall", fall)):
        if not duration >= 0.0:
            raise InputError(f"Trapezoid: {name} lasts {duration:g} s; give zero or more seconds.")
    top, bottom = start + rise, start + rise + hold
    rows: list[tuple[float, ...]] = [
        (start - 1.0, 0.0),
        (start, 0.0, level / rise if rise else 0.0),
        (top, level),
        (bottom, level, -level / fall if fall else 0.0),
        (bottom + fall, 0.0),
    ]
    return _signal(rows)


def cubic_transition(start: float, end: float, t0: float, t1: float) -> InputSignal:
    """A cubic from `start` at t0 to `end` at t1 (s) with zero slope at both ends.

    The motion profile of the thesis (Tables 5.2 and 5.4). Raises InputError unless t0 < t1.
    """
    _refuse_unsorted(np.array([t0, t1]), "start and end of the cubic transition")
    length, change = t1 - t0, end - start
    square = 3.0 * change / length / length
    rising = (t0, start, 0.0, square, -square / length / 1.5)
    return _signal([rising, (t1, end)])


def sine_sweep(amplitude: float, first: float, last: float, t0: float, t1: float) -> InputSignal:
    """A sine whose frequency runs linearly from `first` to `last` Hz over [t0, t1] s, else zero.

    Raises InputError for a negative frequency and unless t0 < t1.
    """
    if first < 0.0 or last < 0.0:
        raise InputError(
            f"Sine sweep: {first:g} Hz to {last:g} Hz; give frequencies of zero or more."
        )
    return InputSignal(
        np.array([0.0, 1.0]), np.zeros((1, 4)), sweep=np.array([[amplitude, first, last, t0, t1]])
    )


def multisine(
    amplitudes: Sequence[float], frequencies: Sequence[float], phases: Sequence[float] | None = None
) -> InputSignal:
    """A sum of sines: amplitudes, frequencies in Hz, phases in rad (None: all zero), one each.

    Raises InputError where their numbers differ or are zero.
    """
    angles = [0.0] * len(frequencies) if phases is None else phases
    if not len(amplitudes) == len(frequencies) == len(angles) > 0:
        raise InputError(
            f"Multisine: {len(amplitudes)} amplitudes, {len(frequencies)} frequencies and"
            f" {len(angles)} phases; give as many of each, at least one."
        )
    rows = np.array([amplitudes, frequencies, angles], dtype=np.float64).T
    return InputSignal(np.array([0.0, 1.0]), np.zeros((1, 4)), sines=rows)


def table(times: ArrayLike, values: ArrayLike, interpolation: str = "hold") -> InputSignal:
    """Samples `values` [n] at `times` [n] in s, constant outside.

    interpolation: "hold" is the zero-order hold (what is commanded), "linear" joins the samples
    (what is measured), "cubic" is the twice differentiable spline (not-a-knot). Raises InputError
    for another one, for shapes that differ, too few samples, and times that do not increase.
    """
    at, value = np.asarray(times, dtype=np.float64), np.asarray(values, dtype=np.float64)
    least = 1 if interpolation == "hold" else 2
    if at.ndim != 1 or at.shape != value.shape or len(at) < least:
        raise InputError(
            f"Table: times of shape {at.shape} and values of shape {value.shape};"
            f" give as many of each, at least {least}."
        )
    _refuse_unsorted(at, "times of the table")
    coefficients = np.zeros((len(at), 4))
    coefficients[:, 0] = value
    if interpolation == "linear":
        coefficients[:-1, 1] = np.diff(value) / np.diff(at)
    elif interpolation == "cubic":
        from scipy.interpolate import CubicSpline

        if np.isfinite(at).all() and np.isfinite(value).all():
            coefficients[:-1, 1:] = CubicSpline(at, value).c[2::-1].T
    elif interpolation != "hold":
        raise InputError(f"Table: interpolation {interpolation!r}; choose hold, linear or cubic.")
    end = at[-1] + (at[-1] - at[-2] if len(at) > 1 else 1.0)
    return InputSignal(np.append(at, end), coefficients)


NODES = np.array([0.0, 1.0, 2.0, 3.0]) / 3.0  # of the cubic on a piece
BETWEEN = np.array([1.0, 5.0]) / 6.0  # where it is compared with the function
AGREEMENT = 1e-10  # of cubic and function, relative to the largest value that was met
FIRST_PIECES = 64
SHORTEST_PIECE = 1e-9  # of the run: a jump is as short


def function(of_time: Callable[[float], float], t0: float, t1: float) -> InputSignal:
    """The function `of_time` (s) between t0 and t1 in s, as cubics on pieces that are halved until
    they agree with it to 1e-10 of its largest value; a jump becomes a piece of a billionth of the
    time. What is shorter than a hundredth of the run and zero elsewhere may be missed.

    Raises InputError for what does not return a finite number.
    """

    def value(t: float) -> float:
        returned = of_time(t)
        try:
            found = np.asarray(returned, dtype=np.float64)
        except (TypeError, ValueError):
            found = np.zeros(0)
        if found.size != 1 or not np.isfinite(found).all():
            raise InputError(
                f"The input function returns {returned!r} at {t:g} s; it must return one finite"
                " number."
            )
        return float(found.reshape(()) if found.ndim == 0 else found.reshape(-1)[0])

    to_cubic = np.linalg.inv(np.vander(NODES, 4, increasing=True))
    between = np.vander(BETWEEN, 4, increasing=True)
    edges = np.linspace(t0, t1, FIRST_PIECES + 1)
    open_pieces, rows, largest = list(pairwise(edges.tolist()))[::-1], [], 0.0
    while open_pieces:
        a, b = open_pieces.pop()
        length = b - a
        values = np.array([value(a + node * length) for node in NODES])
        largest = max(largest, float(np.abs(values).max()))
        cubic = to_cubic @ values
        miss = np.abs(between @ cubic - [value(a + at * length) for at in BETWEEN]).max()
        if miss > AGREEMENT * largest and length > SHORTEST_PIECE * (t1 - t0):
            open_pieces += [(0.5 * (a + b), b), (a, 0.5 * (a + b))]
        else:
            rows.append((a, *(cubic / length ** np.arange(4))))
    return InputSignal(np.array([*(row[0] for row in rows), t1]), np.array([r[1:] for r in rows]))


@dataclass(frozen=True, eq=False)
class InputTable:
    """Several signals in flat arrays, for compiled code.

    Signal j owns coefficients[offsets[j]:offsets[j+1]], breaks from offsets[j] + j on (one more),
    sines[sine_offsets[j]:sine_offsets[j+1]] and the sweeps likewise. `stops` in s: the sorted
    times at which any signal or one of its slopes really jumps; an integrator ends a step there.
    """

    breaks: FloatArray
    coefficients: FloatArray
    offsets: IntArray
    sines: FloatArray
    sine_offsets: IntArray
    sweeps: FloatArray
    sweep_offsets: IntArray
    stops: FloatArray

    @property
    def arrays(
        self,
    ) -> tuple[FloatArray, FloatArray, IntArray, FloatArray, IntArray, FloatArray, IntArray]:
        """The arrays that evaluate_inputs takes after `side`, in its order."""
        return (
            self.breaks,
            self.coefficients,
            self.offsets,
            self.sines,
            self.sine_offsets,
            self.sweeps,
            self.sweep_offsets,
        )

    @cached_property
    def held(self) -> bool:
        """True when every signal is a zero-order hold, constant between stops."""
        return not (len(self.sines) or len(self.sweeps) or self.coefficients[:, 1:].any())

    def with_stops(self, times: FloatArray) -> FloatArray:
        """`times` [k] in s together with the stops between the first and the last, sorted."""
        inner = (self.stops > times[0]) & (self.stops < times[-1])
        if not inner.any():
            return times.copy()
        return np.union1d(times, self.stops[inner])

    def new_cursor(self) -> IntArray:
        """Piece [nu] of every signal found last; one per integration, evaluate_inputs moves it."""
        return np.zeros(len(self.offsets) - 1, dtype=np.int64)


def stack(signals: Sequence[InputSignal]) -> InputTable:
    """Pack signals, in the order of the model's inputs, into flat arrays, which nobody changes."""
    return _stacked(tuple(signals))


@lru_cache(maxsize=KEPT_TABLES)
def _stacked(signals: tuple[InputSignal, ...]) -> InputTable:
    lists = [(s.coefficients, s.sines, s.sweep) for s in signals]
    coefficients, sines, sweeps = (
        np.concatenate([_no_rows(width), *[parts[i] for parts in lists]])
        for i, width in enumerate((4, 3, 5))
    )
    offsets, sine_offsets, sweep_offsets = (
        np.cumsum([0, *[len(parts[i]) for parts in lists]], dtype=np.int64) for i in range(3)
    )
    breaks = np.concatenate([np.empty(0), *[s.breaks for s in signals]])
    stops = np.unique(np.concatenate([np.empty(0), *[s.jumps for s in signals]]))
    return InputTable(
        breaks, coefficients, offsets, sines, sine_offsets, sweeps, sweep_offsets, stops
    )


def sampled_signals(whole: InputTable) -> list[InputSignal]:
    """The signals of a `whole` that is stacked of samples, without sines and sweeps."""
    return [
        InputSignal(whole.breaks[first + j : last + j + 1], whole.coefficients[first:last])
        for j, (first, last) in enumerate(pairwise(whole.offsets))
    ]


def part_of_sampled(whole: InputTable, begin: float, end: float) -> InputTable:
    """The pieces of the sampled signals of `whole` from `begin` to `end` in s; before the first of
    them, and after the last, a signal is constant.
    """
    signals = []
    for signal in sampled_signals(whole):
        times = signal.breaks[:-1]
        a = max(0, int(np.searchsorted(times, begin, side="right")) - 1)
        b = max(a + 1, int(np.searchsorted(times, end, side="right")))
        signals.append(InputSignal(signal.breaks[a : b + 1], signal.coefficients[a:b]))
    return stack(signals)


def values_at(table: InputTable, times: FloatArray) -> FloatArray:
    """Values [m, nu] of the signals of `table` at `times` [m] in s, after a jump where there is
    one.
    """
    cursor, u = table.new_cursor(), np.zeros((len(times), len(table.offsets) - 1))
    evaluate_inputs_at(np.ascontiguousarray(times), table.arrays, cursor, u)
    return u


def slopes_at(table: InputTable, times: FloatArray) -> FloatArray:
    """Slopes [m, nu] per s of the signals of `table` at `times` [m] in s, as `values_at`."""
    cursor, slopes = table.new_cursor(), np.zeros((len(times), len(table.offsets) - 1))
    evaluate_input_slopes_at(np.ascontiguousarray(times), table.arrays, cursor, slopes)
    return slopes


def delays_of(model: Model, p: FloatArray) -> FloatArray:
    """Delay of every input [nu] in s for parameters p [np]."""
    index = model.input_delays
    if not (index >= 0).any():
        return np.zeros(len(index))
    return np.where(index >= 0, p[np.maximum(index, 0)], 0.0)


def delayed(table: InputTable, delays: FloatArray) -> InputTable:
    """`table` with every signal delayed by its entry of `delays` [nu] in s."""
    if not delays.any():
        return table
    breaks, sines, sweeps = table.breaks.copy(), table.sines.copy(), table.sweeps.copy()
    for j, delay in enumerate(delays):
        breaks[table.offsets[j] + j : table.offsets[j + 1] + j + 1] += delay
        own = slice(table.sine_offsets[j], table.sine_offsets[j + 1])
        sines[own, 2] -= 2 * np.pi * sines[own, 1] * delay
        sweeps[table.sweep_offsets[j] : table.sweep_offsets[j + 1], 3:] += delay
    late = np.unique(np.concatenate([table.stops + delay for delay in delays]))
    return replace(table, breaks=breaks, sines=sines, sweeps=sweeps, stops=late)


def delay_columns(model: Model, columns: NDArray[np.int64]) -> NDArray[np.int64]:
    """Per input [nu] the tangent column of its delay among parameter `columns`, or -1."""
    where = {int(c): k for k, c in enumerate(columns)}
    return np.array([where.get(int(i), -1) if i >= 0 else -1 for i in model.input_delays], np.int64)


_N = r"([-+]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][-+]?\d+)?)"
_LIST = rf"({_N}(?:,{_N})*)"
# kind: (what follows the colon, example, what the numbers mean)
_FORMS = {
    "constant": (_N, "3", "value"),
    "step": (rf"(?:{_N}\.\.)?{_N}@{_N}", "24@0.5", "[before..]after@time"),
    "ramp": (rf"{_N}\.\.{_N}@{_N}\.\.{_N}(?:,{_N})?", "0..24@0..10", "start..end@t0..t1[,then]"),
    "trapezoid": (rf"{_N},{_N},{_N},{_N}(?:@{_N})?", "24,0.5,2.5,0.5", "level,rise,hold,fall[@t0]"),
    "cubic": (rf"{_N}\.\.{_N}@{_N}\.\.{_N}", "0..10@0..0.5", "start..end@t0..t1"),
    "sweep": (rf"{_N}@{_N}\.\.{_N}", "14@0.1..5", "amplitude@f0..f1 in Hz over the whole run"),
    "multisine": (rf"{_N}@{_LIST}", "12@0.3,0.7,1.1", "amplitude of each@frequencies in Hz"),
}


PROFILES = tuple(_FORMS)
_STRANGE = re.compile(r"(?<![a-z])(?:nan|inf(?:inity)?)(?![a-z])", re.IGNORECASE)


def as_signals(
    names: Sequence[str], given: Mapping[str, InputSignal | str], duration: float
) -> dict[str, InputSignal]:
    """Return the inputs `given` to a model whose inputs are `names`, profiles read into signals.

    `duration` in s is that of the run. Raises InputError for a name that is no input, for what is
    neither signal nor text, and as `parse_profile` does.
    """
    signals = {}
    for name, signal in given.items():
        if name not in names:
            raise unknown("input", name, names)
        if isinstance(signal, str):
            try:
                signal = parse_profile(signal, duration)
            except InputError as error:
                raise InputError(f"Input '{name}': {error}") from error
        if not isinstance(signal, InputSignal):
            raise wrong_type(
                f"Input '{name}'",
                signal,
                "a profile such as 'constant:3', or a signal of"
                " ptp_symbolic.numeric.simulation.inputs",
            )
        signals[name] = signal
    return signals


def profile_forms() -> tuple[tuple[str, str], ...]:
    """Every kind of profile as an example and what its numbers mean."""
    return tuple((f"{kind}:{example}", rule) for kind, (_, example, rule) in _FORMS.items())


@lru_cache(maxsize=KEPT)
def parse_profile(text: str, duration: float) -> InputSignal:
    """Read one profile; times in s, values in the unit of the input that it drives.

    `duration` in s of the run: a sweep takes all of it. Raises InputError, with the list of forms,
    for anything that is not exactly one of them or whose numbers make no profile.
    """
    kind, _, body = text.strip().partition(":")
    pattern = _FORMS[kind][0] if kind in _FORMS else None
    found = re.fullmatch(pattern, body, re.ASCII) if pattern else None
    if found is None:
        strange = _STRANGE.search(body)
        why = f": {strange[0]} is no finite number" if strange else ""
        raise InputError(f"Profile {_shown(text)} is not understood{why}; use one of {_listed()}.")
    given = [None if group is None or "," in group else float(group) for group in found.groups()]
    try:
        return _profile(kind, body, given, duration)
    except InputError as error:
        raise InputError(f"Profile {_shown(text)}: {error} Forms: {_listed()}.") from error


def _profile(kind: str, body: str, given: list[float | None], duration: float) -> InputSignal:
    numbers = [0.0 if value is None else value for value in given]
    match kind:
        case "constant":
            return constant(numbers[0])
        case "step":
            return step(numbers[0], numbers[1], numbers[2])
        case "ramp":
            return ramp(numbers[0], numbers[1], numbers[2], numbers[3], given[4])
        case "trapezoid":
            return trapezoid(*numbers)
        case "cubic":
            return cubic_transition(*numbers)
        case "sweep":
            return sine_sweep(numbers[0], numbers[1], numbers[2], 0.0, duration)
    frequencies = [float(part) for part in body.partition("@")[2].split(",")]
    return multisine([numbers[0]] * len(frequencies), frequencies)


def _shown(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:60] + "...")


def _listed() -> str:
    return ", ".join(f"{example} ({rule})" for example, rule in profile_forms())
