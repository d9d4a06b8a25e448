"""Locate the end of a mode inside a step, and note what switched."""

from numba import njit

from ptp_symbolic.simulation.inputs import evaluate_inputs
from ptp_symbolic.simulation.modes import largest_violation, violation
from ptp_symbolic.simulation.step import fill_stages, interpolate
from ptp_symbolic.simulation.tableau import STAGES

TIME_RESOLUTION = 1e-12


@njit(cache=True, nogil=True, error_model="numpy")
def record_switches(t, m_before, m, frictions, elements, events, count):
    """Note every element whose mode changed; the count goes on past the capacity of `events`."""
    for element in range(elements):
        where = element if element < frictions else 2 * element - frictions
        changed = m[where] != m_before[where]
        mode = m[where]
        if element >= frictions:
            changed = changed or m[where + 1] != m_before[where + 1]
            mode = m[where] * (2.0 - m[where + 1])
        if changed:
            if count < events.shape[0]:
                events[count, 0] = t
                events[count, 1] = element
                events[count, 2] = mode
            count += 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def worst_element(x, m, g, friction_rates, elements):
    """Index of the element whose mode is violated most."""
    worst, found = -1e300, 0
    for element in range(elements):
        value = violation(element, x, m, g, friction_rates)
        if value > worst:
            worst, found = value, element
    return found


@njit(cache=True, nogil=True, error_model="numpy")
def _violation_at(guards, t, x, u, p, m, table, cursor, held, g, friction_rates):
    if not held:
        evaluate_inputs(t, -1, *table, cursor, u)
    guards(t, x, u, p, m, g)
    return largest_violation(x, m, g, friction_rates)


@njit(cache=True, nogil=True, error_model="numpy")
def first_violation(
    guards, t, h, x, k, u, p, m, table, cursor, held, g, friction_rates, weights, trial, x_end
):  # fmt: skip
    """Fraction of the step, 1/2 or 1, at which a mode is found to have ended; 0 if none has."""
    interpolate(0.5, h, x, k, weights, trial)
    if _violation_at(guards, t + h / 2, trial, u, p, m, table, cursor, held, g, friction_rates) > 0:
        return 0.5
    if _violation_at(guards, t + h, x_end, u, p, m, table, cursor, held, g, friction_rates) > 0:
        return 1.0
    return 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def locate_event(
    derivative, guards, t, high, h, x, k, stage, u, p, m, table, cursor, held, g, friction_rates,
    weights, trial,
):  # fmt: skip
    """Length of the step that lands just past the first event; stages are left at that step."""
    low = 0.0
    while high - low > 1e-9 * h and high - low > TIME_RESOLUTION:
        middle = 0.5 * (low + high)
        interpolate(middle / h, h, x, k, weights, trial)
        if (
            _violation_at(
                guards, t + middle, trial, u, p, m, table, cursor, held, g, friction_rates
            )
            > 0.0
        ):
            high = middle
        else:
            low = middle
    length = high
    for _ in range(60):
        fill_stages(derivative, t, length, x, u, p, m, table, cursor, held, k, stage)
        trial[:] = stage[STAGES - 1]
        value = _violation_at(
            guards, t + length, trial, u, p, m, table, cursor, held, g, friction_rates
        )
        if value > 0.0:
            break
        length = min(h, length + max(TIME_RESOLUTION, 4.0 * (length - high) + 1e-9 * h))
    return length
