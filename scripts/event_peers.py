"""The pan drive by scipy's integrators: the same jitted functions, events found by `solve_ivp`."""

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.events.modes import switch_contacts, violation
from ptp_symbolic.numeric.simulation.kernels.records import KERNEL, Equations
from ptp_symbolic.numeric.simulation.signals.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.signals.inputs import InputTable

FloatArray = NDArray[np.float64]
PAST = 1e-11  # s; how far a peer is carried past an event, so that the mode has really ended


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
        """Start in the modes of the state at rest."""
        self.model, self.table, self.p = model, table, model.parameter_vector()
        self.m, self.u = np.zeros(len(model.mode_names)), np.zeros(len(model.input_names))
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
        elements = frictions + (len(self.m) - frictions) // 2
        self.g = np.zeros(3 * frictions + 4 * (elements - frictions))
        self.dx, self.cursor = np.zeros(len(model.state_names)), table.new_cursor()
        self.events = [self._event(element) for element in range(elements)]

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Return dx/dt in the present modes."""
        evaluate_inputs(t, 1, *self.table.arrays, self.cursor, self.u)
        self.model.module.mode_derivative(t, x, self.u, self.p, self.m, self.dx)
        return self.dx.copy()

    def jacobian(self, t: float, x: FloatArray) -> FloatArray:
        """Return the emitted Jacobian in the present modes."""
        evaluate_inputs(t, 1, *self.table.arrays, self.cursor, self.u)
        return self.model.derivatives(t, x, self.u, self.p, self.m).fx

    def settle(self, t: float, x: FloatArray) -> None:
        """Choose the modes from (t, x) on; zeroes rates that have reversed."""
        evaluate_inputs(t, 1, *self.table.arrays, self.cursor, self.u)
        rates, m, g = self.model.friction_rates, self.m, self.g
        for k, rate in enumerate(rates):
            if m[k] != 0.0 and m[k] * x[rate] < 0.0:
                x[rate] = m[k] = 0.0
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


def simulate_with_scipy(
    model: Model, table: InputTable, end: float, method: str, rtol: float, atol: FloatArray
) -> tuple[FloatArray, FloatArray, int]:
    """Times [k] and states [k, n] at the steps of a run from rest over `end` s, and its events."""
    machine, x, count = EventMachine(model, table), np.zeros(len(model.state_names)), 0
    stops = [s for s in table.stops if 0.0 < s < end] + [end]
    extra = {"jac": machine.jacobian} if method in ("LSODA", "Radau") else {}
    t, times, states = 0.0, [], []
    for stop in stops:
        machine.settle(t, x)
        while t < stop:
            found = solve_ivp(
                machine.rhs,
                (t, stop),
                x,
                method=method,
                rtol=rtol,
                atol=atol,
                events=machine.events,
                **extra,
            )
            times.append(found.t[1:])
            states.append(found.y[:, 1:].T)
            t, x = float(found.t[-1]), found.y[:, -1].copy()
            if found.status != 1:
                break
            x += PAST * machine.rhs(t, x)
            t = min(t + PAST, stop)
            machine.settle(t, x)
            count += 1
    return np.concatenate(times), np.concatenate(states), count
