"""`ptp-symbolic simulate` and `sensitivity`: a platform and its inputs in, CSV files out."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from ptp_symbolic.cli.declared import note_defaults
from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.platform import Platform

FIXED_STEP = "fixed_step"


class WithProfiles(click.Command):
    """A command whose help ends with the profiles that an input may be."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list; read from where it is defined, when it is asked for."""
        from ptp_symbolic.numeric.simulation.inputs import profile_forms

        with formatter.section("Profiles (times in s, values in the SI unit of the input)"):
            formatter.write_dl(profile_forms())


PLATFORM = click.option("--platform", "source", required=True, help="Platform TOML or name.")
INPUT = click.option(
    "--input",
    "inputs",
    multiple=True,
    help="A log (CSV) with the input signals, or a profile such as step:24@0.5; for several"
    " inputs repeat the option with NAME=PROFILE.",
)
DURATION = click.option("--duration", type=float, help="Seconds; default 10, or the whole log.")
INITIAL = click.option(
    "--initial",
    multiple=True,
    metavar="STATE=VALUE",
    help="State at the start in SI, such as theta_pan=0.3, or with its unit, such as"
    " 'theta_pan=30 deg'; repeat for several.",
)
EVERY = click.option(
    "--every", type=float, default=1e-3, help="Seconds between outputs; default 0.001."
)
METHOD = click.option(
    "--method", help="rosenbrock, runge_kutta or fixed_step; default: what suits the model."
)
STEP = click.option(
    "--step", type=float, help="Seconds, for --method fixed_step alone; default 0.0001."
)
OUT = click.option("--out", type=Path, required=True, help="Folder for the results.")


@click.command(cls=WithProfiles)
@PLATFORM
@INPUT
@INITIAL
@DURATION
@EVERY
@METHOD
@STEP
@click.option("--plot", is_flag=True, help="Write trajectory.png too: states and inputs.")
@OUT
def simulate(
    source: str,
    inputs: tuple[str, ...],
    initial: tuple[str, ...],
    duration: float | None,
    every: float,
    method: str | None,
    step: float | None,
    plot: bool,
    out: Path,
) -> None:
    """Simulate a platform; writes trajectory.csv, which is a log too, and events.csv."""
    from ptp_symbolic.api.machine import load
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.cli.tables import table_text, trajectory_columns
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.models.declared import refuse_unknown_signals
    from ptp_symbolic.numeric.simulation.run import output_times

    if step is not None and method != FIXED_STEP:
        raise InputError(
            f"--step {step:g} is for --method {FIXED_STEP} alone; add that, or leave --step out."
        )
    check_writable(out)
    platform, model = declared_platform(source), load(source)
    refuse_unknown_signals(platform, model)
    signals, end = given_signals(platform, model, inputs, duration)
    found = model.simulate(
        output_times(end, every),
        inputs=signals,
        x0=initial_states(model, initial),
        method=method,
        step=1e-4 if step is None else step,
    )
    columns = trajectory_columns(platform, found)
    events = [(e.time, e.element, e.mode) for e in found.events]
    files: dict[str, str | bytes] = {
        "trajectory.csv": table_text(list(columns), zip(*columns.values(), strict=True)),
        "events.csv": table_text(["time [s]", "element", "mode"], events),
    }
    if plot:
        from ptp_symbolic.api.plots import png_of

        files["trajectory.png"] = png_of(found.plot())
    write_files_atomically(out, files)
    note_defaults(platform)
    if not inputs and model.input_names:
        click.echo(f"Note: without --input these are zero: {', '.join(model.input_names)}.")
    click.echo(f"{len(found.t)} samples, {len(events)} events: {out / 'trajectory.csv'}")


@click.command(cls=WithProfiles)
@PLATFORM
@INPUT
@INITIAL
@DURATION
@EVERY
@OUT
@click.option("--by", multiple=True, help="Parameter; repeat for several. Default: all.")
@click.option("--by-initial", multiple=True, help="Initial state; repeat for several.")
def sensitivity(
    source: str,
    inputs: tuple[str, ...],
    initial: tuple[str, ...],
    duration: float | None,
    every: float,
    out: Path,
    by: tuple[str, ...],
    by_initial: tuple[str, ...],
) -> None:
    """Derivatives of states by parameters and initial states; writes sensitivity.csv."""
    from ptp_symbolic.api.machine import load
    from ptp_symbolic.api.simulation import sensitivity as run
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.cli.tables import sensitivity_headings, table_text
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.numeric.simulation.run import output_times

    check_writable(out)
    platform, model = declared_platform(source), load(source)
    signals, end = given_signals(platform, model, inputs, duration)
    found = run(
        model,
        output_times(end, every),
        inputs=signals,
        x0=initial_states(model, initial),
        by_parameters=by or None,
        by_initial=by_initial,
    )
    head = sensitivity_headings(model, found.names)
    rows = ([t, *s.ravel()] for t, s in zip(found.t, found.states, strict=True))
    write_files_atomically(out, {"sensitivity.csv": table_text(["time [s]", *head], rows)})
    note_defaults(platform)
    click.echo(f"{len(head)} derivatives at {len(found.t)} times: {out / 'sensitivity.csv'}")


def initial_states(model: Any, given: Sequence[str]) -> dict[str, float]:
    """States in SI by name, of texts NAME=VALUE, the value with a unit if it is not in SI.

    An angle of more than a turn is pointed out where it has no unit: a joint may have turned as
    often, and degrees look the same. Raises InputError for unknown names and values.
    """
    from ptp_symbolic.api.values import wound_up
    from ptp_symbolic.platform.units import quantity

    values: dict[str, float] = {}
    for text in given:
        name, _, value = text.partition("=")
        if name not in model.state_names:
            raise unknown("state", name, model.state_names)
        unit = model.units[name]
        values[name] = quantity(value, unit, f"Initial state '{name}'")
        if value.strip()[-1:].isdigit():
            _note_turns(
                f"{name} starts at", values[name], unit, f"write degrees as '{name}={value} deg'"
            )
    usual = dict(zip(model.state_names, map(float, model.module.STATE_INITIAL), strict=True))
    for line in wound_up(model, values, {**usual, **values}):
        click.echo(f"Note: {line}", err=True)
    return {**usual, **values}


def _note_turns(what: str, value: float, unit: str, advice: str) -> None:
    turns = abs(value) / math.tau
    if unit == "rad" and turns > 1.0:
        click.echo(f"Note: {what} {value:g} rad, {turns:.3g} turns; {advice}.", err=True)


def given_signals(
    platform: Platform, model: Any, inputs: Sequence[str], duration: float | None
) -> tuple[dict[str, Any], float]:
    """The inputs as signals by name, and the end of the simulation in s."""
    from ptp_symbolic.numeric.data import read_inputs
    from ptp_symbolic.numeric.simulation.inputs import as_signals, table

    signals: dict[str, Any] = {}
    end = 10.0 if duration is None else duration
    for text in inputs:
        if text.lower().endswith(".csv"):
            time, values = read_inputs(Path(text), platform)
            driving = [s for s in platform.signals if s.role == "input"]
            for signal, column in zip(driving, values.T, strict=True):
                signals[signal.signal] = table(time - time[0], column, signal.between_samples)
            end = float(time[-1] - time[0]) if duration is None else duration
            continue
        name, equals, profile = text.partition("=")
        if not equals and name in model.input_names:
            raise InputError(f"Input '{name}' has no profile; write {name}=constant:3.")
        if not equals:
            if len(model.input_names) != 1:
                raise InputError(
                    f"Input '{text}' could drive {' or '.join(model.input_names)}; write"
                    f" {model.input_names[0]}={text}."
                )
            name, profile = model.input_names[0], text
        signals[name] = profile
    found = dict(as_signals(model.input_names, signals, end))
    for name in found.keys() & {n for n, given in signals.items() if isinstance(given, str)}:
        farthest = max(found[name].coefficients[:, 0].tolist(), key=abs)
        _note_turns(
            f"{name} goes to", farthest, model.units[name], "a profile is in rad, not in deg"
        )
    return found, end
