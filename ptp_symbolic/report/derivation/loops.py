"""The states of an effect along a slow oscillation: what hysteresis looks like."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from ptp_symbolic.report.derivation.ranges import FloatArray, Setting, evaluated
from ptp_symbolic.symbolic.effect_interface.contribution import State, Switch
from ptp_symbolic.symbolic.effect_interface.place import active, side

STEPS = 8000  # of a cycle
CYCLES = 1.25  # the first quarter is the virgin curve
BEYOND = 3.0  # amplitude, in the largest deflection that the states reach at a steady rate


@dataclass(frozen=True)
class Loop:
    """A motion and what the states do: values [n] of position, rate, states and modes by symbol."""

    position: FloatArray
    points: Mapping[sp.Symbol, FloatArray]


def loop(
    states: tuple[State, ...],
    switches: tuple[Switch, ...],
    rate: sp.Symbol,
    given: Setting,
) -> Loop | None:
    """A cycle of `rate` that takes the states to their ends; None where nothing bounds them, or
    anything else drives them.
    """
    symbols = [s.symbol for s in states]
    modes = [m for s in switches for m in (side(s.name), active(s.name))]
    driving = {symbol for s in states for symbol in s.derivative.free_symbols}
    if driving - {rate, *symbols, *modes} - given.values.keys():
        return None
    largest = _largest_deflection(states, switches, rate, given)
    if not largest > 0.0:
        return None
    time = np.linspace(0.0, 2 * np.pi * CYCLES, int(STEPS * CYCLES))
    position, rates = BEYOND * largest * np.sin(time), BEYOND * largest * np.cos(time)
    exact = {symbol: sp.Float(value) for symbol, value in given.values.items()}
    wanted = [s.derivative for s in states]
    wanted += [e for s in switches for e in (s.deviation, s.threshold, s.drive)]
    function = sp.lambdify([rate, *symbols, *modes], [e.xreplace(exact) for e in wanted], "math")
    found, own = np.zeros((len(symbols) + len(modes), time.size)), len(symbols)
    for k in range(time.size):
        now = function(rates[k], *found[:, k])
        for j in range(len(switches)):
            deviation, threshold, drive = now[own + 3 * j : own + 3 * j + 3]
            on = abs(deviation) >= threshold and deviation * drive > 0.0
            found[own + 2 * j : own + 2 * j + 2, k] = np.sign(deviation) * on, on
        slopes = function(rates[k], *found[:, k])[:own]
        found[:own, k + 1 :] = (found[:own, k] + (time[1] - time[0]) * np.array(slopes))[:, None]
    names = [rate, *symbols, *modes]
    return Loop(position, dict(zip(names, [rates, *found], strict=True)))


def _largest_deflection(
    states: tuple[State, ...], switches: tuple[Switch, ...], rate: sp.Symbol, given: Setting
) -> float:
    """The largest threshold of the switches, and the largest steady value of a state."""
    ends = [s.threshold for s in switches]
    for state in states:
        slope = sp.diff(state.derivative, state.symbol)
        if slope != 0 and not slope.has(state.symbol):
            ends.append(-state.derivative.xreplace({state.symbol: sp.Integer(0)}) / slope)
    slow = {rate: np.array([1e-6])}
    return max((float(abs(evaluated(end, slow, given)[0])) for end in ends), default=0.0)
