"""The voltage-driven pan drive with gear, gap and shaft, with friction of either table."""

import math
from dataclasses import dataclass

import numpy as np

from tests.benchmark import declarations, profiles
from tests.benchmark.machine import (
    SHIFT_SIZE,
    Declared,
    Floats,
    Recording,
    Run,
    Values,
    hold_in_stalls,
    push,
    stalls,
    unit_pushes,
)
from tests.benchmark.truth_drive import (
    GRAVITY,
    drive_of,
    payload_lever_torque,
    reading,
    torque_along,
)
from tests.benchmark.variation import Variation
from tests.independent import pan_drive
from tests.independent.drive import Drive, as_records

KNOWN = {
    "L_pan": 6.9e-3,
    "R_pan": 12.9,
    "K_t_pan": 0.0724,
    "J_motor_pan": 1.1e-5,
    "N_pan": 500.0,
    "k_shaft_pan": 5000.0,
    "gap_pan": math.radians(1.49),
    "m_payload": 4.992,
    "c_x_payload": 0.1,
}
PWM_FRICTION = {"F_c_pan": 0.2401, "F_s_pan": 0.675, "v_s_pan": 0.016, "F_v_pan": 13.9424}
DC_FRICTION = {"F_c_pan": 5.5612, "F_s_pan": 7.4499, "v_s_pan": 0.0664, "F_v_pan": 6.035}
FREE = ("J_pan", "b_pan", "d_shaft_pan", "F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan")
SUPPLY = 24.0  # V
TOLERANCE = 1e-10  # local error of the integrator; a fine encoder's floor is 2e-6 rad
LEFT, RIGHT = math.radians(-155.0), math.radians(155.0)


@dataclass(frozen=True)
class PanMachine:
    """Truth and declaration of the pan drive."""

    name: str
    friction: dict[str, float]
    axes: tuple[str, ...] = ("pan",)
    voltage_driven: bool = True

    def starts(self) -> dict[str, float]:
        """Declared start values of the free parameters."""
        return {"J_pan": 0.05, "b_pan": 2.0, "d_shaft_pan": 1.0, **self.friction}

    def draw(self, rng: np.random.Generator, variation: Variation) -> dict[str, float]:
        """True values: 0.6 to 1.7 of the start values, inertia and dry friction further if far."""
        start = self.starts()
        true = {name: start[name] * declarations.near(rng) for name in FREE}
        if variation.far:
            true["J_pan"] = start["J_pan"] * declarations.far(rng)
            # Down alone for the strong friction of the DC drive: times 3 is more than it can push.
            factor = declarations.far(rng)
            true["F_c_pan"] = start["F_c_pan"] * (min(factor, 1 / factor) if self.dc else factor)
        excess = start["F_s_pan"] / start["F_c_pan"] - 1.0
        true["F_s_pan"] = true["F_c_pan"] * (1.0 + excess * declarations.near(rng))
        return KNOWN | true

    @property
    def dc(self) -> bool:
        """Whether the friction is the strong one of the DC drive."""
        return self.friction is DC_FRICTION

    def free(self, variation: Variation) -> tuple[str, ...]:
        """The declared free parameters."""
        return FREE

    def declared(self, values: Values, variation: Variation) -> Declared:
        """The platform, as in tests/platforms/fieldlog_pan.toml."""
        start, bounds = self.starts(), declarations.bounds_for(FREE)
        effects = [
            *({"effect": name} for name in ("rigid_bodies", "payload")),
            *(
                {"effect": name, "axis": "pan"}
                for name in ("viscous_friction", "dc_motor", "shaft_compliance", "backlash")
            ),
            {"effect": "csvs_friction", "axis": "pan", "site": "gear"},
        ]
        known = KNOWN | {"J_z_payload": 0.0, "c_y_payload": 0.0}
        parameters = {name: {"value": value} for name, value in known.items()}
        parameters |= {name: {"start": start[name], "bounds": bounds[name]} for name in FREE}
        return {
            "platform": {"name": self.name, "title": "Pan drive with a gap", "axes": ["pan"]},
            "effects": effects,
            "parameters": parameters,
            "signals": declarations.drive_signals("pan", variation),
        }

    def runs(
        self, rng: np.random.Generator, values: Values, variation: Variation
    ) -> tuple[Run, ...]:
        """Five runs to fit and three to judge by, 66 s in all."""
        commands = _commands(rng, values, variation)
        correlation = float(rng.uniform(0.3, 2.0))
        made = []
        for path, (start, command) in commands.items():
            samples = len(command)
            kept = stalls(rng, samples, variation.stalls)
            place = float(rng.uniform(-0.45, 0.45)) * values["gap_pan"]
            inside = float(rng.uniform(-0.5, 0.5)) * 2 * math.pi / variation.counts
            gust, switch = unit_pushes(rng, samples, variation.period, correlation, 1)
            count = 2 * math.pi / variation.counts
            begin = round(start / count) * count + inside
            made.append(
                Run(
                    path,
                    variation.period,
                    hold_in_stalls(command, kept)[:, None],
                    np.array([begin, begin + place]),
                    kept,
                    gust,
                    switch,
                )
            )
        return tuple(made)

    def drive(self, values: Values) -> Drive:
        """The record of the drive with bodies, gravity and a shaking base."""
        lever = payload_lever_torque(values)
        lean, shake = values.get("beta_base", 0.0), lever * values.get("a_base", 0.0)
        azimuth = values.get("psi_base", 0.0)
        return drive_of(values, "pan")._replace(
            J_load=values["J_pan"] + lever * values["c_x_payload"],
            gravity_torque=lever * GRAVITY * math.sin(lean),
            alpha_base=values.get("alpha_base", 0.0),
            base_shake_sine=shake * math.cos(azimuth),
            base_shake_cosine=-shake * math.sin(azimuth),
            base_shake_frequency=values.get("f_base", 1.0),
            base_shake_phase=values.get("phi_base", 0.0),
        )

    def record(self, values: Values, run: Run) -> Recording:
        """The run as the drive makes it, from rest."""
        return Recording(run, run.command, self._simulate(values, run, run.command, run.start))

    def replay(
        self, values: Values, recording: Recording, inputs: Floats | None = None, shift: int = -1
    ) -> Floats:
        """States along the whole run; shift 0 moves the load, shift 1 the place in the gap."""
        run, start = recording.run, recording.run.start.copy()
        if shift == 0:
            start += SHIFT_SIZE
        if shift == 1:
            start[1] += SHIFT_SIZE
        return self._simulate(values, run, recording.inputs if inputs is None else inputs, start)

    def _simulate(self, values: Values, run: Run, inputs: Floats, start: Floats) -> Floats:
        """States [n, 7] under inputs [n, 1] from load and gear angle."""
        begin = np.zeros(pan_drive.STATES)
        begin[pan_drive.LOAD_ANGLE], begin[pan_drive.GEAR_ANGLE] = start
        pushed = push(values, run, self.axes)[:, 0]
        drive = self.drive(values)
        return pan_drive.simulate(drive, inputs[:, 0], begin, run.period, TOLERANCE, pushed)[0]

    def window(self, run: Run) -> int:
        """The whole run."""
        return len(run.command)

    def shifts(self) -> int:
        """Zero of the encoder and place in the gap."""
        return 2

    def readings(self, values: Values, states: Floats, variation: Variation) -> Floats:
        """Angle of the load as the encoder reads it, and the current if it is logged."""
        read = reading(values, "pan", states[:, pan_drive.LOAD_ANGLE])
        if not variation.current:
            return read[:, None]
        return np.column_stack([read, states[:, pan_drive.CURRENT]])

    def coulomb(self, axis: str) -> float:
        """Coulomb torque in N m that the drive is declared with."""
        return self.friction["F_c_pan"]

    def torque(self, values: Values, recording: Recording, states: Floats) -> Floats:
        """Torque on load and gear together."""
        record = as_records(self.drive(values))[0]
        shaft = pan_drive.shaft_torques(record, states)
        order = [
            pan_drive.LOAD_ANGLE,
            pan_drive.LOAD_RATE,
            pan_drive.GEAR_ANGLE,
            pan_drive.GEAR_RATE,
        ]
        motion = np.column_stack([states[:, order], shaft, states[:, pan_drive.WRAP]])
        torque = torque_along(record, recording.run.time, motion)[:, None]
        return torque + push(values, recording.run, self.axes)[:-1]


def _volts(values: Values, torque: float, rate: float) -> float:
    """Voltage that pushes `torque` in N m at a gear output turning with `rate` in rad/s."""
    constant = values["K_t_pan"] * values["N_pan"]
    drag = (values["F_v_pan"] + values["b_pan"]) * rate
    return (torque + drag) * values["R_pan"] / constant + constant * rate


def _commands(
    rng: np.random.Generator, values: Values, variation: Variation
) -> dict[str, tuple[float, Floats]]:
    """Start angle in rad and voltage [n] in V of every run."""
    short = variation.short_arc
    slow = 1.15 * _volts(values, values["F_s_pan"], 0.01)
    fast = max(1.3 * slow, _volts(values, values["F_s_pan"], 0.06))
    stair = min(SUPPLY, max(12.0, 3.0 * slow))
    levels = tuple(stair * level for level in (0.0, 0.25, 0.5, 1.0, 0.0, -0.25, -0.5, -1.0))
    half = 1.5 if short else 3.4

    def at(duration: float) -> Floats:
        return profiles.times(duration, variation.period)

    def start(centre: float, spread: float) -> float:
        return 0.0 if short else centre + float(rng.uniform(-spread, spread))

    def sine(duration: float) -> Floats:
        return profiles.multisine(at(duration), rng, rng.uniform(17.0, 24.0), short)

    ramps = profiles.short_ramps if short else profiles.slow_ramps
    stepped = profiles.short_steps if short else profiles.steps
    last = profiles.short_steps if short else profiles.trapezoids
    many = {
        "train/crawl": (start(0.0, 2.5), profiles.crawl(at(10.0), half, slow, fast)),
        "train/multisine": (start(-1.0, 1.0), sine(10.0)),
        "train/staircase": (
            start(1.5, 0.8),
            profiles.staircase(at(8.0), levels, 0.3 if short else 1.0),
        ),
        "train/ramps": (start(RIGHT, 0.1), -ramps(at(8.8), SUPPLY)),
        "train/steps": (start(LEFT, 0.1), stepped(at(6.2), SUPPLY)),
        "validate/crawl": (start(0.0, 2.5), -profiles.crawl(at(7.0), half, slow, fast)),
        "validate/multisine": (start(1.0, 1.5), sine(8.0)),
        "validate/trapezoids": (start(0.0, 1.5), last(at(7.5), 0.9 * SUPPLY)),
    }
    if variation.repeat:
        many["train/staircase"] = many["train/multisine"]
    return {path: (angle, np.round(volts, 3)) for path, (angle, volts) in many.items()}


PAN_DRIVE = PanMachine("pan_drive", PWM_FRICTION)
PAN_DRIVE_DC = PanMachine("pan_drive_dc", DC_FRICTION)
