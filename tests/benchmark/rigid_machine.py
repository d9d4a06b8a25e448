"""A machine of rigid bodies, driven by a torque or by geared motors, on one axis or both."""

from dataclasses import dataclass, field

import numpy as np

from tests.benchmark import declarations, servo_runs
from tests.benchmark.delays import draw_delays, free_delays, with_delays
from tests.benchmark.machine import (
    SHIFT_SIZE,
    Declared,
    Floats,
    Recording,
    Run,
    Values,
    push,
)
from tests.benchmark.rigid_truth import bodies_of, gravity_and_inertia
from tests.benchmark.servo_runs import BOTH
from tests.benchmark.truth_drive import drive_of, reading, torque_along
from tests.benchmark.variation import Variation
from tests.independent import rigid_drives
from tests.independent.drive import as_records
from tests.independent.rigid_runs import at_rest, replay, track

STEP = 0.5e-3  # s; its error is a tenth of the finest encoder's floor
FINE_STEP = 0.1e-3  # s, where a shaft, a gap or an end stop is hidden
WINDOW = 1.0  # s, of machines that a torque drives
DISTANT_START = "start_of_J_pan"  # kept among the values, as the platform must state it


@dataclass(frozen=True)
class Plate:
    """What is declared of a machine: known values, and start values of what is to be fitted."""

    known: dict[str, float]
    starts: dict[str, float]


@dataclass(frozen=True)
class RigidMachine:
    """Truth and declaration; `heavy` stands in for `plate` where the variation says so.

    `motor` says that a voltage drives a geared motor; `tied` are parameters that are declared to be
    the same as another.
    """

    name: str
    axes: tuple[str, ...]
    plate: Plate
    heavy: Plate | None = None
    voltage_driven: bool = False
    viscous: bool = True
    tied: dict[str, str] = field(default_factory=dict)

    def plate_of(self, variation: Variation) -> Plate:
        """The plate of the variation."""
        return self.heavy if self.heavy and variation.heavy else self.plate

    def _frees_pan_inertia(self, variation: Variation) -> bool:
        """Whether the known pan inertia is to be fitted, from a start that is far off."""
        return variation.far and len(self.axes) > 1

    def _absent(self, variation: Variation) -> set[str]:
        """Parameters of effects that the platform does not declare this time."""
        absent = set()
        for axis in self.axes:
            if f"viscous_friction@{axis}" in variation.without:
                absent |= {f"b_{axis}", f"F_v_{axis}"}
            if f"csvs_friction@{axis}" in variation.without:
                absent |= {f"{name}_{axis}" for name in ("F_c", "F_s", "v_s", "F_v")}
        return absent

    def draw(self, rng: np.random.Generator, variation: Variation) -> dict[str, float]:
        """True values: 0.6 to 1.7 of the start values, inertia and dry friction further if far."""
        plate = self.plate_of(variation)
        true = {name: value * declarations.near(rng) for name, value in plate.starts.items()}
        for name, start in plate.starts.items():
            if variation.far and declarations.letter(name) in ("J", "F_c"):
                true[name] = start * declarations.far(rng)
        for axis in self.axes:
            static, coulomb = f"F_s_{axis}", f"F_c_{axis}"
            if static in plate.starts:
                excess = plate.starts[static] / plate.starts[coulomb] - 1.0
                true[static] = true[coulomb] * (1.0 + excess * declarations.near(rng))
        if self._frees_pan_inertia(variation):
            true[DISTANT_START] = plate.known["J_pan"] * declarations.far(rng)
        absent = self._absent(variation)
        true = {k: v for k, v in true.items() if k not in absent}
        return plate.known | true | draw_delays(rng, self.axes, variation)

    def free(self, variation: Variation) -> tuple[str, ...]:
        """The declared free parameters."""
        return self._fitted(variation) + free_delays(self.axes, variation)

    def _fitted(self, variation: Variation) -> tuple[str, ...]:
        """The free parameters but for delays."""
        names = list(self.plate_of(variation).starts)
        if self._frees_pan_inertia(variation):
            names.append("J_pan")
        return tuple(name for name in names if name not in self._absent(variation))

    def declared(self, values: Values, variation: Variation) -> Declared:
        """The platform as TOML data."""
        plate, free = self.plate_of(variation), self._fitted(variation)
        starts = dict(plate.starts)
        if self._frees_pan_inertia(variation):
            starts["J_pan"] = values[DISTANT_START]
        known = {k: v for k, v in plate.known.items() if k not in free}
        known |= {k: 0.0 for k in self._absent(variation) if k.startswith("F_v_")}
        parameters = {name: {"value": value} for name, value in known.items()}
        bounds = declarations.bounds_for(free)
        parameters |= {name: {"start": starts[name], "bounds": bounds[name]} for name in free}
        parameters |= {name: {"same_as": other} for name, other in self.tied.items()}
        effects = declarations.rigid_effects(
            self.axes, self.voltage_driven, self.viscous, variation.without
        )
        owned = declarations.owned(effects, parameters)
        signals: dict = {}
        for axis in self.axes:
            if self.voltage_driven:
                signals |= declarations.drive_signals(axis, variation)
            else:
                signals |= declarations.torque_signals(axis, variation)
        platform = {"name": self.name, "title": self.name.replace("_", " "), "axes": [*self.axes]}
        declared = {
            "platform": platform,
            "effects": effects,
            "parameters": owned,
            "signals": signals,
        }
        return with_delays(declared, values, self.axes, variation)

    def runs(
        self, rng: np.random.Generator, values: Values, variation: Variation
    ) -> tuple[Run, ...]:
        """The runs of a set, training first."""
        return servo_runs.make_runs(self.name, self.axes, rng, values, variation)

    def coulomb(self, axis: str) -> float:
        """Coulomb torque in N m that `axis` is declared with, or would be."""
        return self.plate.starts[f"F_c_{axis}"]

    def _joints(self, values: Values) -> rigid_drives.Joints:
        """The simulator of the machine."""
        pan, tilt = (drive_of(values, axis) if axis in self.axes else None for axis in BOTH)
        flexible = ("k_shaft_pan" in values, "k_shaft_tilt" in values)
        bodies = bodies_of(values, self.axes)
        return rigid_drives.joints(bodies, pan, tilt, self.voltage_driven, flexible)

    def _step(self, values: Values) -> float:
        """Step of the simulator in s."""
        stiff = any(name.startswith(("k_shaft_", "k_stop_")) for name in values)
        return FINE_STEP if stiff else STEP

    def _places(self) -> list[int]:
        """Columns of the axes in the simulator."""
        return [BOTH.index(axis) for axis in self.axes]

    def _both(self, columns: Floats) -> Floats:
        """Columns [n, joints, ...] of the machine's joints as [n, 2, ...]."""
        full = np.zeros((len(columns), 2, *columns.shape[2:]))
        full[:, self._places()] = columns
        return full

    def record(self, values: Values, run: Run) -> Recording:
        """The run as its servo makes it."""
        targets = np.dstack([run.command[:, :, None], run.reference])
        pushes = self._both(push(values, run, self.axes))
        start = at_rest(*self._both(run.start))
        inputs, states = track(
            self._joints(values),
            run.servo,
            self._both(targets),
            run.kept,
            pushes,
            start,
            run.period,
            self._step(values),
        )
        return Recording(run, inputs[:, self._places()], states)

    def window(self, run: Run) -> int:
        """The whole run if a voltage drives, else a second."""
        return len(run.command) if self.voltage_driven else round(WINDOW / run.period)

    def shifts(self) -> int:
        """Angles of the start; rates too, where a torque drives."""
        return len(self.axes) * (1 if self.voltage_driven else 2)

    def replay(
        self, values: Values, recording: Recording, inputs: Floats | None = None, shift: int = -1
    ) -> Floats:
        """States along the recorded inputs, window by window; a joint at rest keeps its rate."""
        run, window = recording.run, self.window(recording.run)
        starts = recording.states[::window].copy()
        if shift >= 0:
            place = self._places()[shift % len(self.axes)]
            if shift < len(self.axes):
                starts[:, place, rigid_drives.ANGLE] += SHIFT_SIZE
            else:
                moving = starts[:, place, rigid_drives.RATE] != 0.0
                starts[moving, place, rigid_drives.RATE] += SHIFT_SIZE
        given = recording.inputs if inputs is None else inputs
        pushes = self._both(push(values, run, self.axes))
        machine, step = self._joints(values), self._step(values)
        return replay(machine, self._both(given), pushes, starts, window, run.period, step)

    def readings(self, values: Values, states: Floats, variation: Variation) -> Floats:
        """Angles as the encoders read them, then the currents if they are logged."""
        columns = []
        for axis, place in zip(self.axes, self._places(), strict=True):
            late = values.get(f"t_lag_{axis}", 0.0) > 0.0
            shown = rigid_drives.LAGGED if late else rigid_drives.ANGLE
            columns.append(reading(values, axis, states[:, place, shown]))
        if self.voltage_driven and variation.current:
            columns += [states[:, place, rigid_drives.CURRENT] for place in self._places()]
        return np.column_stack(columns)

    def torque(self, values: Values, recording: Recording, states: Floats) -> Floats:
        """Torque on the joints from friction, all that hangs on them, gravity and inertia."""
        time, columns = recording.run.time, []
        bodies = gravity_and_inertia(bodies_of(values, self.axes), states, recording.run.period)
        for number, (axis, place) in enumerate(zip(self.axes, self._places(), strict=True)):
            record, own = as_records(drive_of(values, axis))[0], states[:, place]
            angle, rate = own[:, rigid_drives.ANGLE], own[:, rigid_drives.RATE]
            driving = recording.inputs[:, number]
            if self.voltage_driven:
                constant = values[f"N_{axis}"] * values[f"K_t_{axis}"]
                driving = constant * own[:, rigid_drives.CURRENT]
            motion = np.column_stack([angle, rate, angle, rate, driving, own[:, rigid_drives.WRAP]])
            columns.append(torque_along(record, time, motion) + bodies[:, place])
        return np.column_stack(columns) + push(values, recording.run, self.axes)[:-1]
