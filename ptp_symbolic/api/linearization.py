"""A machine linearised about a point: A, B, C, D with names."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.api.display import Displayed, Table
from ptp_symbolic.api.extras import extra_library

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Linearization(Displayed):
    """Deviations from a point: d(dx)/dt = A dx + B du, dy = C dx + D du, all in SI units.

    `A` [n, n], `B` [n, nu], `C` [ny, n] and `D` [ny, nu] are in the order of `state_names`,
    `input_names` and `output_names`. `x` [n] and `u` [nu] are the point, `rate` [n] is dx/dt there:
    zero at an equilibrium. `modes` are those of friction and contact in which it holds.
    """

    name: str
    state_names: tuple[str, ...]
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray
    x: FloatArray
    u: FloatArray
    rate: FloatArray
    modes: Mapping[str, float]

    def to_control(self) -> Any:
        """The StateSpace of python-control with the same names.

        Raises InputError where control is not installed.
        """
        return extra_library("control").ss(
            self.A,
            self.B,
            self.C,
            self.D,
            states=list(self.state_names),
            inputs=list(self.input_names),
            outputs=list(self.output_names),
            name=self.name,
        )

    def _heading(self) -> str:
        point = ", ".join(f"{n} = {v:g}" for n, v in zip(self.state_names, self.x, strict=True))
        return f"'{self.name}' linearised at {point}"

    def _tables(self) -> tuple[Table, ...]:
        def block(title: str, rows: tuple[str, ...], *parts: tuple[tuple[str, ...], FloatArray]):  # type: ignore[no-untyped-def]
            names = tuple(name for columns, _ in parts for name in columns)
            values = np.hstack([matrix for _, matrix in parts])
            cells = tuple((n, *map(float, row)) for n, row in zip(rows, values, strict=True))
            return Table(title, ("", *names), cells)

        states, inputs = self.state_names, self.input_names
        return (
            block("A, B", states, (states, self.A), (inputs, self.B)),
            block("C, D", self.output_names, (states, self.C), (inputs, self.D)),
        )
