"""Integrate a model in steps of fixed length: preallocate, run, and return the solution."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation import fixed_runner
from ptp_symbolic.numeric.simulation.buffers import (
    contact_table,
    new_record,
    new_tangents,
    new_watch,
)
from ptp_symbolic.numeric.simulation.integration import (
    refuse_start,
)
from ptp_symbolic.numeric.simulation.kernels.calls import addresses
from ptp_symbolic.numeric.simulation.kernels.records import EVENTS, INSTANT, STEPS, TIME
from ptp_symbolic.numeric.simulation.methods.implicit_step import StepWork
from ptp_symbolic.numeric.simulation.sampling import new_sampling
from ptp_symbolic.numeric.simulation.signals.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.signals.inputs import InputTable

FloatArray = NDArray[np.float64]

MOST_STEPS = 1e9


@dataclass(frozen=True, eq=False)
class FixedSolution:
    """Solution in steps of fixed length: status, time reached in s and state [n] there.

    At the output times x [k, n] and ledger [k, 3] (stored, supplied, dissipated in J); the first
    events [e, 3] (time in s, element, mode entered) and their number in all, steps taken, and the
    most mode sets that a single step tried.
    """

    status: int
    reached: float
    state: FloatArray
    x: FloatArray
    ledger: FloatArray
    events: FloatArray
    event_count: int
    steps: int
    most_sweeps: int


def integrate_in_fixed_steps(
    model: Model,
    p: FloatArray,
    x: FloatArray,
    inputs: InputTable,
    times: FloatArray,
    step: float,
    event_room: int = 0,
) -> FixedSolution:
    """Simulate `model` at p [np] from x [n] in steps of at most `step` s; outputs at `times` [k]
    in s.

    Every output time and every jump of an input is the end of a step. Raises InputError for a step
    that is no positive time or makes too many steps, and as `refuse_start` and `new_sampling` do.
    """
    duration = times[-1] - times[0]
    if not 0.0 < step < np.inf or duration / step > MOST_STEPS:
        raise InputError(
            f"Step {step:g} s for {duration:g} s; give a positive number of seconds that makes at"
            f" most {MOST_STEPS:g} steps."
        )
    grid = inputs.with_stops(times)
    n, nu, z = len(x), len(model.input_names), np.zeros
    x, u, none = x.copy(), z((2, nu)), z(0, np.int64)
    watch, tangents = new_watch(model, n, p), new_tangents(z((n, 0)), none, z(nu, np.int64), 0, nu)
    if model.contacts[:, 2].any():
        evaluate_inputs(times[0], 1, *inputs.arrays, inputs.new_cursor(), u[0])
        model.module.initial_modes(times[0], x, u[0], p, watch.m)
        refuse_start(model, x, u[0], p, watch)
    work = StepWork(
        z((n, n)),
        z((n, nu)),
        z((0, len(p))),
        z((n, n)),
        z(n, np.int64),
        z(n),
        z(n),
        z(n),
        z((len(model.friction_rates), 2), np.int64),
    )
    record = new_record(grid, n, 0, len(grid), event_room)
    status = fixed_runner.runner()(
        addresses(model.module, tangents=False),
        p,
        model.prepared(p),
        model.friction_rates,
        model.zero_at_rest,
        contact_table(model),
        inputs.arrays,
        inputs.new_cursor(),
        inputs.held,
        u,
        x,
        float(step),
        tuple(watch),
        tuple(tangents),
        tuple(work),
        tuple(record),
        tuple(new_sampling(model, p, x, times, 0)),
    )
    kept, counts = np.searchsorted(grid, times), record.counts
    return FixedSolution(
        status,
        float(record.clock[TIME]),
        x,
        record.x[kept],
        record.ledger[kept],
        record.events[: counts[EVENTS]],
        int(counts[EVENTS]),
        int(counts[STEPS]),
        int(counts[INSTANT]),
    )
