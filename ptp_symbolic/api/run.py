"""A simulated run: signals by name, events, energies, tables and a plot."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.api.display import Displayed, Table
from ptp_symbolic.api.extras import extra_library
from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    constant,
    delays_of,
    stack,
    values_at,
)
from ptp_symbolic.numeric.simulation.run import Trajectory

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]
Signals = Mapping[str, FloatArray]

ENERGIES = ("stored", "supplied", "dissipated")
MOST_LINES = 60  # events that a plot marks; more would hide the signals


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Run(Displayed, Trajectory):
    """A run of `model`: states, outputs and inputs at the times `t` [k] in s, events and energies.

    `run[name]` is a state, an output, an input or an energy [k] in its SI unit (`run.units`). Where
    an output has the name of a state, what its sensor shows is `run.outputs[name]`. `x` [k, n] has
    the states in the order of `state_names`. Runs pickle.

    >>> import ptp_symbolic as ptp
    >>> run = ptp.load("ideal").simulate(0.5, tau_pan=0.1)
    >>> run["theta_pan"].shape
    (501,)
    >>> run["nope"]
    Traceback (most recent call last):
    KeyError: "Unknown signal 'nope'. Choose one of: theta_pan, theta_tilt, omega_pan, ...
    """

    model: Model
    given: Mapping[str, InputSignal]
    p: FloatArray

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters of the run in SI, by name."""
        return dict(zip(self.model.parameter_names, map(float, self.p), strict=True))

    @cached_property
    def states(self) -> Signals:
        """States [k] in SI, by name."""
        pairs = zip(self.state_names, self.x.T, strict=True)
        return MappingProxyType({name: column for name, column in pairs})

    @cached_property
    def inputs(self) -> Signals:
        """Inputs [k] in SI, by name; at a jump the value after it."""
        values = self.inputs_at(self.t)
        return MappingProxyType(dict(zip(self.model.input_names, values.T, strict=True)))

    @cached_property
    def outputs(self) -> Signals:
        """Outputs [k] in SI, by name: what the sensors show, without noise.

        Raises InputError where not all states were saved.
        """
        if self.state_names != self.model.state_names:
            raise InputError("Outputs follow from all states; leave out `save`.")
        y, u = np.zeros((len(self.t), len(self.model.output_names))), self.inputs_at(self.t)
        for column, delay in enumerate(delays_of(self.model, self.p)):
            if delay:
                u[:, column] = self.inputs_at(self.t - delay)[:, column]
        for time, x, given, row in zip(self.t, self.x, u, y, strict=True):
            self.model.module.outputs(time, x, given, self.p, row)
        return MappingProxyType(dict(zip(self.model.output_names, y.T, strict=True)))

    @cached_property
    def energy(self) -> Signals:
        """Energies [k] in J: stored - stored[0] = supplied - dissipated; none without `ledger`."""
        if not len(self.stored):
            return MappingProxyType({})
        return MappingProxyType({name: getattr(self, name) for name in ENERGIES})

    @property
    def units(self) -> dict[str, str]:
        """The SI unit of every signal, by name."""
        return {**self.model.units, **dict.fromkeys(ENERGIES, "J")}

    def inputs_at(self, times: FloatArray) -> FloatArray:
        """Inputs [m, nu] in SI at `times` [m] in s, after a jump where there is one."""
        names = self.model.input_names
        u = values_at(stack([self.given.get(name, constant(0.0)) for name in names]), times)
        if self.commands is not None:
            held = np.searchsorted(self.commands.t, times + 1e-12, side="right") - 1
            u += self.commands.u[np.maximum(held, 0)]
        return u

    def __getitem__(self, name: str) -> FloatArray:
        """The signal `name` [k] in SI. Raises KeyError, which lists the names, for another."""
        for signals in (self.states, self.energy):
            if name in signals:
                return signals[name]
        if name in self.model.input_names:
            return self.inputs[name]
        if name in self._names():
            return self.outputs[name]
        raise KeyError(str(unknown("signal", name, self._names())))

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def _names(self) -> tuple[str, ...]:
        whole = self.state_names == self.model.state_names
        outputs = self.model.output_names if whole else ()
        names = (*self.state_names, *outputs, *self.model.input_names, *self.energy)
        return tuple(dict.fromkeys(names))

    def to_pandas(self) -> Any:
        """A pandas DataFrame: a column [k] per signal, the time in s as index; the units stand in
        `attrs["units"]`. Raises InputError where pandas is not installed.
        """
        pandas = extra_library("pandas")
        frame = pandas.DataFrame(
            {name: self[name] for name in self._names()}, index=pandas.Index(self.t, name="time")
        )
        frame.attrs["units"] = {name: self.units[name] for name in self._names()}
        return frame

    def to_xarray(self) -> Any:
        """An xarray Dataset over the coordinate `time` in s, with the unit of every signal as its
        attribute `units`. Raises InputError where xarray is not installed.
        """
        xarray = extra_library("xarray")
        signals = {n: ("time", self[n], {"units": self.units[n]}) for n in self._names()}
        time = ("time", self.t, {"units": "s"})
        found = xarray.Dataset(signals, coords={"time": time})
        found.attrs |= {"model": self.model.name, "parameters": str(self.parameters)}
        return found

    def plot(self, *names: str) -> "Figure":
        """A matplotlib figure of the signals `names` (none: states and inputs), a panel per unit;
        thin lines mark events, where they are few. Raises KeyError for another name.
        """
        from ptp_symbolic.api.plots import panels_by_unit

        wanted = names or (*self.state_names, *self.model.input_names)
        signals = {name: self[name] for name in wanted}
        marks = [e.time for e in self.events] if len(self.events) <= MOST_LINES else []
        return panels_by_unit(self.t, signals, self.units, marks)

    def _heading(self) -> str:
        return (
            f"Run of '{self.model.name}' from {self.t[0]:g} to {self.t[-1]:g} s:"
            f" {len(self.t)} samples, {len(self.events)} events"
        )

    def _tables(self) -> tuple[Table, ...]:
        rows = [
            (name, self.units[name], float(np.min(v)), float(np.max(v)), float(v[-1]))
            for name in self._names()
            for v in (self[name],)
        ]
        return (Table("Signal", ("signal", "unit", "lowest", "highest", "last"), tuple(rows)),)
