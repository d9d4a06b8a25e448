"""Where the equations of a model end: bounds of states, watched like the ends of modes."""

from ptp_symbolic.numeric.simulation.kernels.records import TIME, inlined, kernel


@inlined
def past_bound(limit, x, watch):
    """How far the state of a limit is past its nearer bound, in its unit (> 0: outside)."""
    value = x[watch.limited[limit]]
    return max(watch.bounds[limit, 0] - value, value - watch.bounds[limit, 1])


@inlined
def is_outside(x, watch):
    """Whether some state of x [n] is past a bound of the domain."""
    found = False
    for limit in range(len(watch.limited)):
        found = found or past_bound(limit, x, watch) > 0.0
    return found


@inlined
def is_finite(x, largest):
    """Whether every state of x [n] is a number (not NaN) below `largest` in size."""
    found = True
    for a in range(len(x)):
        found = found and abs(x[a]) < largest
    return found


@kernel
def stop_at_bound(t, h, x, end, watch, clock):
    """Move x [n] at t in s along the secant to `end` [n], h s later, up to the first bound."""
    fraction = 1.0
    for limit in range(len(watch.limited)):
        before, after = past_bound(limit, x, watch), past_bound(limit, end, watch)
        if after > 0.0:
            fraction = min(fraction, before / (before - after))
    for a in range(len(x)):
        x[a] += fraction * (end[a] - x[a])
    clock[TIME] = t + fraction * h
