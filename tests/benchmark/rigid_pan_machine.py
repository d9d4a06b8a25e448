"""The pan drive declared as a motor on a rigid gear; what lies in between, if anything, is hidden.

Without a hidden structure gear and load are one body in the truth, too.
"""

from dataclasses import replace

import numpy as np

from tests.benchmark import declarations, pan_machine
from tests.benchmark.delays import draw_delays, free_delays, with_delays
from tests.benchmark.machine import Declared, Floats, Recording, Run, Values, hold_in_stalls
from tests.benchmark.pan_machine import DC_FRICTION, PWM_FRICTION, PanMachine
from tests.benchmark.truth_drive import reading
from tests.benchmark.variation import Variation
from tests.independent import pan_drive

SHAFT = ("k_shaft_pan", "d_shaft_pan", "gap_pan")
KNOWN = {name: value for name, value in pan_machine.KNOWN.items() if name not in SHAFT}
FREE = tuple(name for name in pan_machine.FREE if name not in SHAFT)
# Switching to and fro, held for 15 to 180 ms: a soft shaft resonates with it, a gap is crossed.
HOLDS = (0.015, 0.18)  # s
SWITCHED = {"staircase": (0.0, 22.0), "multisine": (0.6, 9.0)}  # share kept, V beside it


class RigidPanMachine(PanMachine):
    """Truth and declaration of the pan drive on a rigid gear."""

    def draw(self, rng: np.random.Generator, variation: Variation) -> dict[str, float]:
        """True values as those of the pan drive, but for the shaft."""
        drawn = super().draw(rng, variation)
        kept = {k: v for k, v in drawn.items() if k not in SHAFT}
        return kept | draw_delays(rng, self.axes, variation)

    def free(self, variation: Variation) -> tuple[str, ...]:
        """The declared free parameters."""
        return FREE + free_delays(self.axes, variation)

    def declared(self, values: Values, variation: Variation) -> Declared:
        """The platform, as shared/fieldlogs/rigid_gear.toml."""
        start, bounds = self.starts(), declarations.bounds_for(FREE)
        effects = [
            *({"effect": name} for name in ("rigid_bodies", "payload")),
            *({"effect": name, "axis": "pan"} for name in ("viscous_friction", "dc_motor")),
            {"effect": "csvs_friction", "axis": "pan", "site": "gear"},
        ]
        known = KNOWN | {"J_z_payload": 0.0, "c_y_payload": 0.0}
        parameters = {name: {"value": value} for name, value in known.items()}
        parameters |= {name: {"start": start[name], "bounds": bounds[name]} for name in FREE}
        platform = {
            "platform": {"name": self.name, "title": "Pan drive", "axes": ["pan"]},
            "effects": effects,
            "parameters": parameters,
            "signals": declarations.drive_signals("pan", variation),
        }
        return with_delays(platform, values, self.axes, variation)

    def runs(
        self, rng: np.random.Generator, values: Values, variation: Variation
    ) -> tuple[Run, ...]:
        """Those of the pan drive, with switching in place of the staircase and on the multisines; a
        run starts at an angle and a place in the gap, -0.45 to 0.45 of it, if there is one.
        """
        made = []
        for run in super().runs(rng, {**values, "gap_pan": 1.0}, variation):
            command = run.command
            share, volts = SWITCHED.get(run.path.rpartition("/")[2], (1.0, 0.0))
            if volts > 0.0:
                wanted = share * command[:, 0] + volts * switching(rng, run.time)
                command = hold_in_stalls(np.round(wanted, 3)[:, None], run.kept)
            begin = np.array([run.start[0], run.start[1] - run.start[0]])
            made.append(replace(run, command=command, start=begin))
        return tuple(made)

    def replay(
        self, values: Values, recording: Recording, inputs: Floats | None = None, shift: int = -1
    ) -> Floats:
        """States along the whole run; shift 0 moves the start."""
        run, start = recording.run, recording.run.start.copy()
        if shift == 0:
            start[0] += pan_machine.SHIFT_SIZE
        return self._simulate(values, run, recording.inputs if inputs is None else inputs, start)

    def _simulate(self, values: Values, run: Run, inputs: Floats, start: Floats) -> Floats:
        """States [n, 10] under inputs [n, 1] from an angle and a place in the gap."""
        place = start[1] * values.get("gap_pan", 0.0)
        return super()._simulate(values, run, inputs, np.array([start[0], start[0] + place]))

    def shifts(self) -> int:
        """Zero of the encoder."""
        return 1

    def readings(self, values: Values, states: Floats, variation: Variation) -> Floats:
        """Angle of the load as the encoder reads it, late where it lags, and the current."""
        late = values.get("t_lag_pan", 0.0) > 0.0
        shown = states[:, pan_drive.LAGGED if late else pan_drive.LOAD_ANGLE]
        read = reading(values, "pan", shown)
        if not variation.current:
            return read[:, None]
        return np.column_stack([read, states[:, pan_drive.CURRENT]])


def switching(rng: np.random.Generator, time: Floats) -> Floats:
    """Plus and minus one in turn [n], each for a random time; zero in the first 0.2 s."""
    holds = np.exp(rng.uniform(*np.log(HOLDS), len(time)))
    number = np.searchsorted(0.2 + np.cumsum(holds), time)
    return np.where(number % 2 == 0, 1.0, -1.0) * (time > 0.2)


RIGID_PAN = RigidPanMachine("rigid_pan", PWM_FRICTION)
RIGID_PAN_DC = RigidPanMachine("rigid_pan_dc", DC_FRICTION)
