"""Results as CSV: trajectories that read back as logs, and headings that carry units."""

import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.api.run import ENERGIES, Run
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.log import raw_numbers
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform, SignalDeclaration

FloatArray = NDArray[np.float64]


def trajectory_columns(platform: Platform, found: Run) -> dict[str, FloatArray]:
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
    model = found.model
    columns = {
        name: (model.units[name], values)
        for name, values in zip(model.state_names, found.x.T, strict=True)
    }
    columns |= {name: ("J", getattr(found, name)) for name in ENERGIES}
    u = found.inputs_at(found.t)
    declared = {s.signal: s for s in platform.signals if s.role == "input"}
    for k, name in enumerate(model.input_names):
        if name not in declared:
            columns[name] = (model.units[name], u[:, k])
            continue
        own = declared[name]
        sent = found.inputs_at(found.t + own.delay)[:, k] if own.delay else u[:, k]
        columns[own.column] = (_heading_unit(own), raw_numbers(own, sent))
    for signal in (s for s in platform.signals if s.role == "output"):
        seen = found.outputs[signal.signal]
        if signal.delay:
            seen = np.interp(found.t - signal.delay, found.t, seen)
        columns[signal.column] = (_heading_unit(signal), raw_numbers(signal, seen))
    return {"time [s]": found.t} | {
        f"{name} [{unit}]": values for name, (unit, values) in columns.items()
    }


def _heading_unit(signal: SignalDeclaration) -> str:
    return signal.unit if signal.scale is None else "1"


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
