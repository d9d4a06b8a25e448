"""Simulation and sensitivities, of whatever names a machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.api.inputs import (
    Input,
    Inputs,
    input_signals,
    refuse_other_arguments,
    whole_duration,
)
from ptp_symbolic.api.machine import Machine, Source, load
from ptp_symbolic.api.run import Run
from ptp_symbolic.api.values import Quantity, Values, initial_vector, parameter_values
from ptp_symbolic.errors import InputError, names_of, number_of, unknown, wrong_type
from ptp_symbolic.numeric.simulation import run as numeric
from ptp_symbolic.numeric.simulation.feedback import Feedback
from ptp_symbolic.numeric.simulation.integration import MOST_STEPS
from ptp_symbolic.numeric.simulation.run import output_times

if TYPE_CHECKING:
    from ptp_symbolic.numeric.sensitivities import Sensitivities

FloatArray = NDArray[np.float64]
Times = float | ArrayLike | None

STATES = "states"  # as `feedback`: all of them


def simulate(
    model: Source,
    times: float | ArrayLike | None = None,
    inputs: Inputs | None = None,
    parameters: Values | None = None,
    initial: Values | None = None,
    rtol: float = 1e-8,
    atol: float = 1e-9,
    largest_step: float = 0.1,
    method: str | None = None,
    step: float = 1e-4,
    ledger: bool = True,
    save: Sequence[str] | None = None,
    most_steps: int = MOST_STEPS,
    *,
    x0: Values | None = None,
    controller: Callable[[float, FloatArray], object] | None = None,
    period: float | None = None,
    feedback: str | Sequence[str] | None = None,
    **values: Input | Quantity,
) -> Run:
    """Simulate a machine from 0 to a duration in s (output every ms), over a span (start, end), a
    tuple, in s, or at `times` [k] in s; without times, as long as the log of its inputs.

    `model` is what `load` takes. Inputs and parameters follow by name, or as `inputs` and
    `parameters`. An input is a number, a text ("3 V", "step:24@0.5"), a function of the time in s,
    samples [k] at the output times, a pair (times, samples), a log, its path, or a DataFrame;
    samples hold until the next, those of rates and accelerations are joined by lines; what is not
    given is zero. Parameters and the state at the start `x0` (or `initial`) are numbers in SI or
    texts such as "30 deg", by name or in order.

    `controller(t, y)` is called every `period` s and returns the inputs [nu], one number where
    there is one input, or a mapping by name, which hold until the next call and add to those given;
    y [m] are the outputs in the order of `output_names`, all states with `feedback` = "states", or
    what `feedback` names, in that order.

    rtol and atol bound the local error, atol in rad for angles. `method` is "rosenbrock" for stiff
    machines, "runge_kutta" for smooth ones, "fixed_step" for steps of `step` s, None to let the
    machine choose. `save` names the states to keep (None: all); without `ledger` no energies are
    summed up.

    Raises InputError for unknown names, units that do not fit, parameters out of bounds, times that
    do not increase and a controller that returns no inputs; SimulationError when the state
    diverges, modes chatter, or `most_steps` do not reach the end.

    >>> import ptp_symbolic as ptp
    >>> run = ptp.simulate("ideal", 1.0, tau_pan=lambda t: 0.1 * t, J_pan="600 g cm^2")
    >>> run["omega_pan"].shape
    (1001,)
    >>> hold = ptp.simulate("ideal", 1.0, x0={"theta_pan": "10 deg"}, controller=lambda t, y: -y,
    ...                     period=1e-2)
    >>> bool(abs(hold["theta_pan"][-1]) < abs(hold["theta_pan"][0]))
    True
    """
    machine = load(model)
    if x0 is not None and initial is not None:
        raise InputError("`x0` and `initial` are both the state at the start; give one of them.")
    by_name, own = _sorted(machine, values)
    span = _times(machine, times, inputs)
    given = _joined(machine, inputs, by_name, span)
    changed = {**parameter_values(machine, parameters), **own}
    start = initial_vector(machine, initial if x0 is None else x0)
    found = numeric.simulate(
        machine,
        span,
        given,
        changed,
        dict(zip(machine.state_names, map(float, start), strict=True)),
        rtol,
        atol,
        largest_step,
        method,
        number_of(step, "`step`", "s"),
        ledger,
        None if save is None else names_of(save, "`save`"),
        int(number_of(most_steps, "`most_steps`")),
        _feedback(machine, controller, period, feedback),
    )
    p = machine.parameter_vector(changed)
    return Run(**vars(found), model=machine, given=given, p=p)


def sensitivity(
    model: Source,
    times: float | ArrayLike | None = None,
    inputs: Inputs | None = None,
    parameters: Values | None = None,
    initial: Values | None = None,
    by_parameters: Sequence[str] | None = None,
    by_initial: Sequence[str] = (),
    rtol: float = 1e-8,
    atol: float = 1e-9,
    largest_step: float = 0.1,
    method: str | None = None,
    *,
    x0: Values | None = None,
    **values: Input | Quantity,
) -> Sensitivities:
    """Derivatives of states [k, n, m] and outputs [k, ny, m] by parameters (None: all) and by
    initial states, along the run that `simulate` makes of the same arguments.

    They are in the unit of the numerator over that of the parameter, exact through events; see
    `Sensitivities`. Raises InputError and SimulationError as `simulate` does.

    >>> import ptp_symbolic as ptp
    >>> found = ptp.sensitivity("ideal", 0.5, tau_pan=0.1, by_parameters=["J_pan"])
    >>> found.states.shape
    (501, 4, 1)
    """
    from ptp_symbolic.numeric import sensitivities

    machine = load(model)
    if x0 is not None and initial is not None:
        raise InputError("`x0` and `initial` are both the state at the start; give one of them.")
    by_name, own = _sorted(machine, values)
    span = _times(machine, times, inputs)
    start = initial_vector(machine, initial if x0 is None else x0)
    return sensitivities.sensitivity(
        machine,
        span,
        _joined(machine, inputs, by_name, span),
        {**parameter_values(machine, parameters), **own},
        dict(zip(machine.state_names, map(float, start), strict=True)),
        None if by_parameters is None else names_of(by_parameters, "`by_parameters`"),
        names_of(by_initial, "`by_initial`"),
        rtol,
        atol,
        largest_step,
        method,
    )


def _times(machine: Machine, times: Times, inputs: Inputs | None) -> FloatArray:
    duration = whole_duration(machine, inputs) if times is None else times
    if duration is None:
        raise InputError("Say how long to simulate: a duration in s, or `times`.")
    return output_times(duration)


def _sorted(machine: Machine, values: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, float]]:
    """The inputs among `values`, and the parameters in SI. Raises InputError for other names."""
    for name in values:
        if name not in (*machine.input_names, *machine.parameter_names):
            options = [n for n in signature(simulate).parameters if n not in ("model", "values")]
            known = (*machine.input_names, *machine.parameter_names, *options)
            raise unknown("input, parameter or argument", name, known)
    inputs = {n: v for n, v in values.items() if n in machine.input_names}
    return inputs, parameter_values(machine, {n: v for n, v in values.items() if n not in inputs})


def _joined(
    machine: Machine, inputs: Inputs | None, by_name: Mapping[str, Any], span: FloatArray
) -> dict[str, Any]:
    signals = input_signals(machine, inputs, span)
    for name in by_name:
        if name in signals and isinstance(inputs, Mapping):
            raise InputError(f"Input '{name}' is given twice; give it once.")
    return {**signals, **input_signals(machine, by_name, span)}


def _feedback(
    machine: Machine,
    controller: Callable[[float, FloatArray], object] | None,
    period: float | None,
    names: str | Sequence[str] | None,
) -> Feedback | None:
    if controller is None:
        if period is not None or names is not None:
            raise InputError("`period` and `feedback` are of a `controller`; give one.")
        return None
    if period is None:
        raise InputError("A `controller` is sampled; give its `period` in s, such as 1e-3.")
    if not callable(controller):
        raise wrong_type("The controller", controller, "a function of t and y")
    refuse_other_arguments(controller, "The controller", "t in s and what is measured", 2)
    if names is None:
        measured: tuple[str, ...] | None = machine.output_names
    else:
        measured = None if names == STATES else names_of(names, "`feedback`")
    return Feedback(controller, number_of(period, "`period`", "s"), measured)
