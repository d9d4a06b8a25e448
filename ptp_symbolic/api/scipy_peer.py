"""A machine by SciPy's integrators: the same compiled functions, events found by `solve_ivp`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.element_layout import contact_count, contact_guards
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.events.modes import switch_contacts, violation
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.inputs import InputTable
from ptp_symbolic.numeric.simulation.kernels.records import KERNEL, Equations

FloatArray = NDArray[np.float64]
PAST = 1e-11  # s; how far a run is carried past an event, so that the mode has really ended
MOST_EVENTS = 20_000  # of a run: a minute of SciPy
WITH_JACOBIAN = ("LSODA", "Radau", "BDF")


@njit(**KERNEL)
def switched_contacts(equations, m, g):  # type: ignore[no-untyped-def]
    """Kernels of the package have no way in from Python: this is one."""
    switch_contacts(equations, m, g)


@njit(**KERNEL)
def past_end(element, x, m, g, friction_rates):  # type: ignore[no-untyped-def]
    """By how much the mode of `element` has ended."""
    return violation(element, x, m, g, friction_rates)


class EventMachine:
    """A model in one mode at a time, as `solve_ivp` wants it: right-hand side and events."""

    def __init__(self, model: Model, table: InputTable) -> None:
        """Prepare a run at the default parameters; `begin` starts it."""
        self.model, self.table, self.p = model, table, model.parameter_vector()
        self.m, self.u = np.zeros(len(model.mode_names)), np.zeros(len(model.input_names))
        self.dx, self.cursor = np.zeros(len(model.state_names)), table.new_cursor()
        none = np.zeros(0)
        self.equations = Equations(
            0,
            0,
            0,
            0,
            self.p,
            none,
            model.friction_rates,
            model.zero_at_rest,
            0,
            0,
            model.contacts,
        )
        frictions = len(model.friction_rates)
        contacts = contact_count(frictions, len(self.m))
        self.g = np.zeros(contact_guards(frictions, contacts))
        self.events = [self._event(element) for element in range(frictions + contacts)]

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Return dx/dt in the present modes."""
        evaluate_inputs(t, 1, *self.table.arrays, self.cursor, self.u)
        self.model.module.mode_derivative(t, x, self.u, self.p, self.m, self.dx)
        return self.dx.copy()

    def jacobian(self, t: float, x: FloatArray) -> FloatArray:
        """Return the emitted Jacobian in the present modes."""
        evaluate_inputs(t, 1, *self.table.arrays, self.cursor, self.u)
        return self.model.derivatives(t, x, self.u, self.p, self.m).fx

    def begin(self, x: FloatArray) -> None:
        """Take the modes that the state x [n] says at time 0."""
        evaluate_inputs(0.0, 1, *self.table.arrays, self.cursor, self.u)
        self.model.module.initial_modes(0.0, x, self.u, self.p, self.m)

    def settle(self, t: float, x: FloatArray) -> None:
        """Choose the modes from (t, x) on; zeroes rates that have reversed."""
        evaluate_inputs(t, 1, *self.table.arrays, self.cursor, self.u)
        rates, m, g = self.model.friction_rates, self.m, self.g
        for k, rate in enumerate(rates):
            if m[k] != 0.0 and m[k] * x[rate] < 0.0:
                x[rate] = m[k] = 0.0
                x[self.model.zero_at_rest == k] = 0.0
        for _ in range(20):
            before = m.copy()
            self.model.module.guards(t, x, self.u, self.p, m, g)
            switched_contacts(self.equations, m, g)
            self.model.module.guards(t, x, self.u, self.p, m, g)
            for k in range(len(rates)):
                held, forward, backward = g[3 * k : 3 * k + 3]
                if m[k] == 0.0:
                    m[k] = 1.0 if held > forward else -1.0 if -held > backward else 0.0
            if np.array_equal(m, before):
                return

    def _event(self, element: int):  # type: ignore[no-untyped-def]
        def past(t: float, x: FloatArray) -> float:
            evaluate_inputs(t, 1, *self.table.arrays, self.cursor, self.u)
            self.model.module.guards(t, x, self.u, self.p, self.m, self.g)
            return float(past_end(element, x, self.m, self.g, self.model.friction_rates))

        past.terminal, past.direction = True, 1.0  # type: ignore[attr-defined]
        return past


def beyond_scipy(model: Model) -> str | None:
    """Why SciPy cannot run `model` by locating its events alone; None where it can."""
    if model.sampler_periods:
        return "a sampled controller"
    if model.contacts[:, 2].any():
        return "rigid impacts"
    return None


def simulate_with_scipy(
    model: Model,
    table: InputTable,
    end: float,
    method: str,
    rtol: float,
    atol: FloatArray,
    start: FloatArray | None = None,
) -> tuple[FloatArray, FloatArray, int]:
    """Times [k] and states [k, n] at the steps of a run from `start` [n] (None: zero) over `end` s,
    and the number of its events.

    Parameters are the defaults. Raises InputError where SciPy fails, and for machines that
    `beyond_scipy` names.
    """
    why = beyond_scipy(model)
    if why is not None:
        raise InputError(f"SciPy cannot run '{model.name}', which has {why}.")
    machine, count = EventMachine(model, table), 0
    x = np.zeros(len(model.state_names)) if start is None else start.copy()
    machine.begin(x)
    extra: dict[str, Any] = {"jac": machine.jacobian} if method in WITH_JACOBIAN else {}
    t, times, states = 0.0, [], []
    for stop in [*(s for s in table.stops if 0.0 < s < end), end]:
        machine.settle(t, x)
        while t < stop:
            found = solve_ivp(
                machine.rhs,
                (t, stop),
                x,
                method=method,
                rtol=rtol,
                atol=atol,
                events=machine.events or None,
                **extra,
            )
            times.append(found.t[1:])
            states.append(found.y[:, 1:].T)
            t, x = float(found.t[-1]), found.y[:, -1].copy()
            if found.status < 0 or count > MOST_EVENTS:
                why = found.message if found.status < 0 else f"more than {MOST_EVENTS} events"
                raise InputError(f"SciPy's {method} stopped at {t:.6g} s: {why}")
            if found.status == 0:
                break
            x += PAST * machine.rhs(t, x)
            t = min(t + PAST, stop)
            machine.settle(t, x)
            count += 1
    return np.concatenate(times), np.concatenate(states), count
