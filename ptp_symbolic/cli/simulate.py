"""`ptp-symbolic simulate` and `sensitivity`: a platform and its inputs in, CSV files out."""

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import click

PLATFORM = click.option("--platform", "source", required=True, help="Platform TOML or name.")
INPUT = click.option(
    "--input",
    "inputs",
    multiple=True,
    help="A log (CSV) with the input signals, or a profile such as step:24@0.5; for several"
    " inputs give NAME=PROFILE each.",
)
DURATION = click.option("--duration", type=float, help="Seconds; default 10, or the whole log.")
METHOD = click.option(
    "--method", help="rosenbrock, runge_kutta or fixed_step; default: what suits the model."
)
STEP = click.option("--step", type=float, default=1e-4, help="Seconds, for fixed_step.")
OUT = click.option("--out", type=Path, required=True, help="Folder for the results.")


@click.command()
@PLATFORM
@INPUT
@DURATION
@METHOD
@STEP
@OUT
def simulate(
    source: str,
    inputs: tuple[str, ...],
    duration: float | None,
    method: str | None,
    step: float,
    out: Path,
) -> None:
    """Simulate a platform; writes trajectory.csv and events.csv."""
    from ptp_symbolic import load
    from ptp_symbolic.atomic import check_writable, write_files_atomically
    from ptp_symbolic.simulation.run import simulate as run

    check_writable(out)
    model = load(source)
    signals, end = _signals(source, model, inputs, duration)
    found = run(model, end, signals, method=method, step=step)
    names = [f"{n} [{model.units[n]}]" for n in model.state_names]
    head = ["time [s]", *names, "stored [J]", "supplied [J]", "dissipated [J]"]
    rows = zip(found.t, *found.x.T, found.stored, found.supplied, found.dissipated, strict=True)
    events = [(e.time, e.element, e.mode) for e in found.events]
    files: dict[str, str | bytes] = {
        "trajectory.csv": _table(head, rows),
        "events.csv": _table(["time [s]", "element", "mode"], events),
    }
    write_files_atomically(out, files)
    click.echo(f"{len(found.t)} samples, {len(events)} events: {out / 'trajectory.csv'}")


@click.command()
@PLATFORM
@INPUT
@DURATION
@OUT
@click.option("--by", multiple=True, help="Parameter; repeat for several. Default: all.")
@click.option("--by-initial", multiple=True, help="Initial state; repeat for several.")
def sensitivity(
    source: str,
    inputs: tuple[str, ...],
    duration: float | None,
    out: Path,
    by: tuple[str, ...],
    by_initial: tuple[str, ...],
) -> None:
    """Derivatives of states by parameters and initial states; writes sensitivity.csv."""
    from ptp_symbolic import load
    from ptp_symbolic.atomic import check_writable, write_files_atomically
    from ptp_symbolic.sensitivities.forward import sensitivity as run

    check_writable(out)
    model = load(source)
    signals, end = _signals(source, model, inputs, duration)
    found = run(model, end, signals, by_parameters=by or None, by_initial=by_initial)
    head = [f"d {state} / d {name}" for state in model.state_names for name in found.names]
    rows = ([t, *s.ravel()] for t, s in zip(found.t, found.states, strict=True))
    write_files_atomically(out, {"sensitivity.csv": _table(["time [s]", *head], rows)})
    click.echo(f"{len(head)} derivatives at {len(found.t)} times: {out / 'sensitivity.csv'}")


def _signals(
    source: str, model: Any, inputs: Sequence[str], duration: float | None
) -> tuple[dict[str, Any], float]:
    from ptp_symbolic.data import read_inputs
    from ptp_symbolic.errors import InputError
    from ptp_symbolic.platform import read_platform
    from ptp_symbolic.simulation.inputs import table
    from ptp_symbolic.simulation.profile_text import parse_profile

    signals: dict[str, Any] = {}
    end = 10.0 if duration is None else duration
    for text in inputs:
        if text.lower().endswith(".csv"):
            platform = read_platform(source)
            time, values = read_inputs(Path(text), platform)
            names = [s.signal for s in platform.signals if s.role == "input"]
            for name, column in zip(names, values.T, strict=True):
                signals[name] = table(time - time[0], column, "hold")
            end = float(time[-1] - time[0]) if duration is None else duration
            continue
        name, equals, profile = text.partition("=")
        if not equals:
            if len(model.input_names) != 1:
                raise InputError(
                    f"Input '{text}' could drive {' or '.join(model.input_names)}; write"
                    f" {model.input_names[0]}={text}."
                )
            name, profile = model.input_names[0], text
        signals[name] = parse_profile(profile, end)
    return signals, end


def _table(head: Sequence[str], rows: Iterable[Iterable[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([v if isinstance(v, str) else repr(float(v)) for v in row] for row in rows)  # type: ignore[arg-type]
    return text.getvalue()
