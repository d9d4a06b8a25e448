"""Smooth models: Tsitouras's pair of order 5(4), every thread with a step length of its own.

Steps end where an input jumps; the step length is taken up again after such a stop.
"""

from typing import Any, NamedTuple

from numba.extending import register_jitable

from ptp_symbolic.numeric.gpu.drives import evaluate, next_stop
from ptp_symbolic.numeric.gpu.machine import copy, is_finite, is_outside
from ptp_symbolic.numeric.simulation.kernels.records import (
    DIVERGED,
    DONE,
    EXHAUSTED,
    OUTSIDE,
    TOO_FAST,
)
from ptp_symbolic.numeric.simulation.methods.runge_kutta import ERROR, ORDER, STAGES, A, C

SHORTEST = 1e-11  # s
SAFETY, LEAST, MOST = 0.9, 0.2, 5.0  # factors by which a step length changes
FIRST = 1e-4  # s; the longest first step
BEFORE_STOP = 2.0  # step lengths: a shorter rest before a stop is cut in two


class Accuracy(NamedTuple):
    """Relative tolerance, absolute ones [n] in the units of the states, the longest step in s, and
    the most steps tried.
    """

    relative: Any
    absolute: Any
    longest: Any
    most_steps: Any


@register_jitable
def integrate_smooth(machine, signals, k, begin, end, accuracy):
    """Integrate machine.x [n] from `begin` to `end` in s, with stages k [7, n].

    Returns status, the time reached in s, and the number of steps tried.
    """
    t, stop, h, steps = begin, begin, min(FIRST, accuracy.longest), 0
    if is_outside(machine, machine.x):
        return OUTSIDE, t, steps
    while t < end:
        if t >= stop:
            stop = next_stop(t, end, signals)
            evaluate(t, 1, signals, machine.u)
            machine.derivative(
                t, machine.x, machine.u, machine.p, machine.m, machine.prepared, k[0]
            )
        if steps >= accuracy.most_steps:
            return EXHAUSTED, t, steps
        length = h
        if t + h >= stop:
            length = stop - t
        elif t + BEFORE_STOP * h > stop:
            length = 0.5 * (stop - t)
        attempt(machine, signals, k, t, length)
        steps += 1
        error = error_norm(machine, k, length, accuracy)
        factor = MOST
        if not error < (SAFETY / MOST) ** ORDER:
            factor = max(LEAST, SAFETY * error ** (-1.0 / ORDER)) if error < 1e30 else LEAST
        if error <= 1.0:
            if is_outside(machine, machine.end):
                copy(machine.end, machine.x)
                return OUTSIDE, t + length, steps
            t = stop if t + h >= stop else t + length
            accept(machine, k)
            h = max(h, factor * length) if length < h else factor * length
            h = min(h, accuracy.longest)
            continue
        h = factor * length
        if h < SHORTEST:
            return (TOO_FAST if is_finite(machine.end) else DIVERGED), t, steps
    return (DONE if is_finite(machine.x) else DIVERGED), t, steps


@register_jitable
def attempt(machine, signals, k, t, h):
    """Try a step of h s: write the slopes k [7, n] and the state machine.end [n]."""
    for i in range(1, STAGES):
        for a in range(len(machine.x)):
            change = 0.0
            for j in range(i):
                change += A[i, j] * k[j, a]
            machine.end[a] = machine.x[a] + h * change
        evaluate(t + C[i] * h, -1 if C[i] == 1.0 else 1, signals, machine.u)
        machine.derivative(
            t + C[i] * h, machine.end, machine.u, machine.p, machine.m, machine.prepared, k[i]
        )


@register_jitable
def error_norm(machine, k, h, accuracy):
    """The largest estimated error of a state over its tolerance; infinite for what is no number."""
    worst = 0.0
    for a in range(len(machine.x)):
        error = 0.0
        for i in range(STAGES):
            error += ERROR[i] * k[i, a]
        size = max(abs(machine.x[a]), abs(machine.end[a]))
        ratio = abs(h * error) / (accuracy.absolute[a] + accuracy.relative * size)
        worst = max(worst, ratio) if ratio < 1e300 else 1e300
    return worst


@register_jitable
def accept(machine, k):
    """Go on to the end of the step, where its last slope is the first of the next."""
    for a in range(len(machine.x)):
        machine.x[a] = machine.end[a]
        k[0, a] = k[STAGES - 1, a]
