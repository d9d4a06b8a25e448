"""Where the equations of a model end: bounds of states, watched like the ends of modes."""

from ptp_symbolic.numeric.simulation.kernels.records import TIME, inlined, kernel


@inlined
def past_bound(limit, x, watch):
    """How far the state of a limit is past its nearer bound (> 0: outside)."""
    value = x[watch.limited[limit]]
    return max(watch.bounds[limit, 0] - value, value - watch.bounds[limit, 1])


@inlined
def is_outside(x, watch):
    """Whether some state is past a bound."""
    found = False
    for limit in range(len(watch.limited)):
        found = found or past_bound(limit, x, watch) > 0.0
    return found


@inlined
def is_finite(x, largest):
    """Whether every state is a number below `largest` in size."""
    found = True
    for a in range(len(x)):
        found = found and abs(x[a]) < largest
    return found


@kernel
def stop_at_bound(t, h, x, end, watch, clock):
    """Go from x at t in s along the straight line to `end`, h later, up to the first bound."""
    fraction = 1.0
    for limit in range(len(watch.limited)):
        before, after = past_bound(limit, x, watch), past_bound(limit, end, watch)
        if after > 0.0:
            fraction = min(fraction, before / (before - after))
    for a in range(len(x)):
        x[a] += fraction * (end[a] - x[a])
    clock[TIME] = t + fraction * h
