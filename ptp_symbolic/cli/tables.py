"""Results as CSV: trajectories that read back as logs, and headings that carry units."""

import csv
import io
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.calibration import raw_numbers
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.numeric.simulation.signals.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.signals.inputs import InputSignal, constant, stack
from ptp_symbolic.platform import Platform, SignalDeclaration

FloatArray = NDArray[np.float64]

ENERGIES = ("stored", "supplied", "dissipated")


def trajectory_columns(
    platform: Platform, model: Model, found: Trajectory, signals: Mapping[str, InputSignal]
) -> dict[str, FloatArray]:
    """Columns [k] of `found` by heading: time, states, energies in J, inputs, measured signals.

    Inputs and outputs stand under the columns that `platform` declares, raw and late where it says
    so: the file is a log of it. A state of the same name makes room for them. Raises InputError for
    a column that has the name of an energy.
    """
    for signal in platform.signals:
        if signal.column in ENERGIES:
            raise InputError(
                f"Column '{signal.column}' of {signal.signal} has the name of an energy in J;"
                " declare it under another name."
            )
    columns = {
        name: (model.units[name], values)
        for name, values in zip(model.state_names, found.x.T, strict=True)
    }
    columns |= {name: ("J", getattr(found, name)) for name in ENERGIES}
    u = _input_values(model, signals, found.t)
    declared = {s.signal: s for s in platform.signals if s.role == "input"}
    for k, name in enumerate(model.input_names):
        if name not in declared:
            columns[name] = (model.units[name], u[:, k])
            continue
        own = declared[name]
        sent = _input_values(model, signals, found.t + own.delay)[:, k] if own.delay else u[:, k]
        columns[own.column] = (_heading_unit(own), raw_numbers(own, sent))
    measured = [s for s in platform.signals if s.role == "output"]
    y = _output_values(model, found, u) if measured else None
    for signal in measured:
        assert y is not None
        seen = y[:, model.output_names.index(signal.signal)]
        if signal.delay:
            seen = np.interp(found.t - signal.delay, found.t, seen)
        columns[signal.column] = (_heading_unit(signal), raw_numbers(signal, seen))
    return {"time [s]": found.t} | {
        f"{name} [{unit}]": values for name, (unit, values) in columns.items()
    }


def _heading_unit(signal: SignalDeclaration) -> str:
    return signal.unit if signal.scale is None else "1"


def _input_values(model: Model, signals: Mapping[str, InputSignal], t: FloatArray) -> FloatArray:
    """Inputs [k, nu] at times t [k], after a jump where there is one."""
    table = stack([signals.get(name, constant(0.0)) for name in model.input_names])
    cursor, u = table.new_cursor(), np.zeros((len(t), len(model.input_names)))
    for row, time in zip(u, t, strict=True):
        evaluate_inputs(time, 1, *table.arrays, cursor, row)
    return u


def _output_values(model: Model, found: Trajectory, u: FloatArray) -> FloatArray:
    """Measured signals [k, ny] along a trajectory with inputs u [k, nu]."""
    p, y = model.parameter_vector(), np.zeros((len(found.t), len(model.output_names)))
    for time, x, given, row in zip(found.t, found.x, u, y, strict=True):
        model.module.outputs(time, x, given, p, row)
    return y


def sensitivity_headings(model: Model, names: Sequence[str]) -> list[str]:
    """Headings `d state / d name [unit]`, the states one after the other."""
    return [
        f"d {state} / d {name} [{_quotient(model.units[state], model.units[name])}]"
        for state in model.state_names
        for name in names
    ]


def _quotient(above: str, below: str) -> str:
    if above == below:
        return "1"
    if below == "1":
        return above
    return f"{above}/({below})" if set(below) & set(" /") else f"{above}/{below}"


def table_text(head: Sequence[str], rows: Iterable[Iterable[object]]) -> str:
    """The text of a CSV; numbers to the last bit."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([v if isinstance(v, str) else repr(float(v)) for v in row] for row in rows)  # type: ignore[arg-type]
    return text.getvalue()
