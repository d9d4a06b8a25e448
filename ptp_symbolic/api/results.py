"""Fits, diagnoses, experiments and friction maps as objects."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ptp_symbolic.api.display import Displayed, Table
from ptp_symbolic.api.logs import Log, log_paths
from ptp_symbolic.api.machine import Machine, Source, load, platform_of
from ptp_symbolic.atomic_files import check_writable, write_files_atomically
from ptp_symbolic.errors import InputError, names_of, number_of, path_of, unknown
from ptp_symbolic.platform import Platform

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ptp_symbolic.workflows.result import Output

Logs = str | Path | Log | Iterable[Any]  # or DataFrames
Progress = Callable[[str], None]


FOLDER = "the path of a folder"


def _silent(text: str) -> None:
    return None


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter: `value` and 95 % `interval` (lower, upper) in `unit`; None where an end
    is not known. `start` is the declared value; `at_bound` says whether the
    fit ended on a bound, `identified` whether the logs determine the value.
    """

    name: str
    value: float
    interval: tuple[float | None, float | None]
    unit: str
    meaning: str
    start: float
    at_bound: bool
    identified: bool


class _Result(Displayed):
    """What a workflow found, with its files."""

    output: "Output"

    @property
    def summary(self) -> dict[str, Any]:
        """All of it as plain data: what the JSON file says."""
        return self.output.summary

    def save(self, folder: Path | str) -> Path:
        """Write every file of the result into `folder`, all or none; returns the folder.

        Raises InputError for a folder that cannot be written.
        """
        place = path_of(folder, "`folder`", FOLDER)
        check_writable(place)
        write_files_atomically(place, self.output.files)
        return place


@dataclass(frozen=True, eq=False, repr=False)
class FitResult(_Result):
    """Fitted parameters of a platform with their intervals; see `fit`."""

    output: "Output"

    @cached_property
    def parameters(self) -> Mapping[str, Estimate]:
        """The fitted parameters by name: value, 95 % interval, unit."""
        return estimates_of(self.summary["parameters"])

    @property
    def platform(self) -> Platform:
        """The platform with the fitted values as new start values."""
        return _platform(self.output)

    @cached_property
    def model(self) -> Machine:
        """The machine at the fitted values."""
        return load(self.platform)

    @property
    def error(self) -> Mapping[str, Any]:
        """Errors "before" (None where the start values do not simulate), "after" and
        "noise_floor": each in total, by run and by signal.
        """
        found: Mapping[str, Any] = self.summary["error"]
        return found

    def plot(self) -> "Figure":
        """A matplotlib figure: every run as measured, and as simulated before and after.

        Raises InputError where the fit failed.
        """
        return _plot(self.output, hidden=("before",) if self.error["before"] is None else ())

    def _heading(self) -> str:
        own, floor = (self.error[when]["total"] for when in ("after", "noise_floor"))
        key, unit = ("rmse_counts", "counts") if "rmse_counts" in own else ("rmse", own["unit"])
        return (
            f"Fit of '{self.summary['platform']['name']}': {own[key]:.3g} {unit} rms over"
            f" {len(self.error['after']['by_run'])} runs, the noise floor is {floor[key]:.3g}"
        )

    def _tables(self) -> tuple[Table, ...]:
        return (_table_of(self.parameters),)


@dataclass(frozen=True, eq=False, repr=False)
class Diagnosis(_Result):
    """The effects that are missing from a platform, as its logs show; see `diagnose`."""

    output: "Output"

    @property
    def verdict(self) -> str:
        """`nothing_missing`, `explained`, `explained_up_to_group`, `partly_explained` or
        `unexplained`.
        """
        return str(self.summary["verdict"])

    @property
    def added(self) -> Sequence[Mapping[str, Any]]:
        """The named effects: each with `effect`, `axis`, `parameters` (`value`, `ci95`, `unit`),
        `confusable_with` and `separating_experiment`.
        """
        found: Sequence[Mapping[str, Any]] = self.summary["added"]
        return found

    @property
    def ranking(self) -> Sequence[Mapping[str, Any]]:
        """Every candidate that was compared, the best first, with `accepted` and `why`."""
        found: Sequence[Mapping[str, Any]] = self.summary["ranking"]
        return found

    @property
    def error(self) -> Mapping[str, Any]:
        """Errors of "train" and "validate", each "before", "after" and "noise_floor"."""
        found: Mapping[str, Any] = self.summary["error"]
        return found

    @cached_property
    def parameters(self) -> Mapping[str, Estimate]:
        """The parameters of the extended platform by name: value, 95 % interval, unit."""
        return estimates_of(self.summary["fit"]["after"]["parameters"])

    @property
    def platform(self) -> Platform:
        """The platform with what was found added, fitted values as start values."""
        return _platform(self.output)

    @cached_property
    def model(self) -> Machine:
        """The machine with what was found. Raises InputError where no such machine can exist."""
        return load(self.platform)

    def plot(self) -> "Figure":
        """A matplotlib figure: every run as measured, and as simulated before and after."""
        return _plot(self.output)

    def report(self, path: Path | str) -> Path:
        """Write the self-contained HTML report to `path`; returns it.

        Raises InputError for a folder that cannot be written.
        """
        place = path_of(path, "`path`", "the path of an HTML file")
        check_writable(place.parent)
        write_files_atomically(place.parent, {place.name: self.output.files["report.html"]})
        return place

    def _heading(self) -> str:
        return f"{self.verdict}: {self.summary['summary']}"

    def _tables(self) -> tuple[Table, ...]:
        errors = tuple(
            (part, *(self.error[part][when]["total"]["rmse"] for when in WHENS))
            for part in ("train", "validate")
        )
        unit = self.error["train"]["after"]["total"]["unit"]
        heads = ("part", *(f"{when.replace('_', ' ')} [{unit}]" for when in WHENS))
        return (Table("Error", heads, errors), _table_of(self.parameters))


WHENS = ("before", "after", "noise_floor")


@dataclass(frozen=True, eq=False, repr=False)
class Experiment(_Result):
    """The most informative input; see `experiment`."""

    output: "Output"

    @property
    def input(self) -> Mapping[str, Any]:
        """Kind, duration and period in s, and the range of every input."""
        found: Mapping[str, Any] = self.summary["input"]
        return found

    def _heading(self) -> str:
        given = self.input
        period = f"a sample every {given['period']:g} s"
        return f"Input: {given['kind']} of {given['duration']:g} s, {period}"

    def _tables(self) -> tuple[Table, ...]:
        rows = tuple(
            (n, s["lowest"], s["highest"], s["unit"]) for n, s in self.input["signals"].items()
        )
        return (Table("Signal", ("signal", "lowest", "highest", "unit"), rows),)


@dataclass(frozen=True, eq=False, repr=False)
class FrictionMap(_Result):
    """The law of steady friction that points show; see `friction_map`."""

    output: "Output"

    @property
    def law(self) -> str:
        """The smallest law that predicts the points as well as any other."""
        return str(self.summary["member"])

    @property
    def parameters(self) -> Mapping[str, Mapping[str, Any]]:
        """Its parameters by name: `value`, `low` and `high` (None: open), `unit`."""
        found: Mapping[str, Mapping[str, Any]] = self.summary["parameters"]
        return found

    def _heading(self) -> str:
        return f"Friction of '{self.summary['source']}': {self.law}"

    def _tables(self) -> tuple[Table, ...]:
        keys = ("value", "low", "high", "unit")
        rows = tuple((n, *(p[key] for key in keys)) for n, p in self.parameters.items())
        return (Table("Parameter", ("parameter", *keys), rows),)


def fit(platform: Source, logs: Logs, *, progress: Progress = _silent) -> FitResult:
    """Fit the free parameters of `platform` (what `load` takes) to all `logs`: files, folders,
    patterns such as ``runs/*.csv``, logs of `read_log`, or pandas DataFrames.

    A DataFrame has every signal that the platform declares as a column in SI, and the time in s as
    a column `time` or as its index. `progress` is called with a line for every stage. Raises
    InputError for logs and platforms that do not fit each other.

    >>> import ptp_symbolic as ptp
    >>> folder = ptp.sample("tilted_base")
    >>> found = ptp.fit(folder / "platform.toml", folder / "train")  # doctest: +SKIP
    >>> found.parameters["b_pan"].interval  # doctest: +SKIP
    """
    from ptp_symbolic.workflows.fit import fit_platform

    declared = platform_of(platform)
    with log_paths(declared, logs) as (files,):
        return FitResult(fit_platform(declared, files, progress))


def diagnose(
    platform: Source,
    train: Logs,
    validate: Logs,
    *,
    time_limit: float | None = None,
    effort: float = 1.0,
    black_box: bool = False,
    resume: Path | str | None = None,
    keep: Path | str | None = None,
    progress: Progress = _silent,
) -> Diagnosis:
    """Fit `platform` to the logs `train`, find the effect that is missing, and validate it on the
    logs `validate`, which are never fitted.

    `platform` is what `load` takes; logs are what `fit` takes. The search ends with what it has
    tried when it has simulated so many samples (4e8, times `effort`), which is the same on every
    machine, and after `time_limit` s (None: 900) at the latest; with `black_box` the result is
    compared with black-box models. What was evaluated is written into the folder `keep` meanwhile,
    and into the folder of the result; `resume` names such a folder, or the evidence.npz in it, to
    go on from. Raises InputError for logs and platforms that do not fit each
    other, for a run in both parts, for limits that are none, and for evidence of other logs,
    another platform or another version.

    >>> import ptp_symbolic as ptp
    >>> folder = ptp.sample("tilted_base")
    >>> found = ptp.diagnose(  # doctest: +SKIP
    ...     folder / "platform.toml", train=folder / "train", validate=folder / "validate")
    >>> found.verdict  # doctest: +SKIP
    'explained'
    """
    from ptp_symbolic.workflows.diagnosis import diagnose_platform

    declared = platform_of(platform)
    with log_paths(declared, train, validate) as (fitted, judging):
        found = diagnose_platform(
            declared,
            fitted,
            judging,
            progress,
            rivals=black_box,
            time_limit=None if time_limit is None else number_of(time_limit, "`time_limit`", "s"),
            effort=number_of(effort, "`effort`"),
            resume=None if resume is None else path_of(resume, "`resume`", FOLDER),
            keep=None if keep is None else path_of(keep, "`keep`", FOLDER),
        )
    return Diagnosis(found)


def experiment(
    platform: Source,
    *,
    between: Sequence[str] = (),
    parameters: Sequence[str] = (),
    limits: Mapping[str, str] | Sequence[str] = (),
    diagnosis: Diagnosis | Path | str | None = None,
    logs: Logs = (),
    duration: float = 10.0,
    period: float | None = None,
    initial: Mapping[str, float | str] | None = None,
    tries: int = 240,
    seed: int = 1,
    progress: Progress = _silent,
) -> Experiment:
    """Design the run that separates the effects `between`, or determines `parameters` best.

    `limits` say how far inputs, states and outputs may go: {"u_pan": "12 V", "theta_pan":
    "-90..45 deg"}. A `diagnosis` that ended with a group gives its effects. `duration` and
    `period` (None: that of the logs) are in s, `initial` states by name in SI or with units.
    Raises InputError for names, limits, states and times that do not fit the platform.

    >>> import ptp_symbolic as ptp
    >>> ptp.experiment("payload", parameters=["J_pan"], tries=3)
    Traceback (most recent call last):
    ptp_symbolic.errors.InputError: `tries` 3: give at least 60.
    """
    from ptp_symbolic.api.values import initial_vector
    from ptp_symbolic.workflows.experiment_design import Request, design_experiment
    from ptp_symbolic.workflows.experiment_group import group_of

    declared = platform_of(platform)
    between = names_of(between, "`between`")
    parameters = names_of(parameters, "`parameters`")
    known: Mapping[str, float] = {}
    if diagnosis is not None:
        group, known = group_of(_saved(diagnosis), declared)
        if not (between or parameters or group):
            raise InputError(
                "This `diagnosis` ended without a group; say by `between` or `parameters` what the"
                " experiment is for."
            )
        between = between or (() if parameters else group)
    if isinstance(limits, Mapping):
        limits = [f"{name}={limit}" for name, limit in limits.items()]
    texts = names_of(limits, "`limits`")
    states: dict[str, float] = {}
    if initial:
        machine = load(declared)
        vector = initial_vector(machine, initial)
        states = {n: float(vector[machine.state_names.index(n)]) for n in initial}
    request = Request(
        tuple(between),
        parameters,
        texts,
        number_of(duration, "`duration`", "s"),
        None if period is None else number_of(period, "`period`", "s"),
        states,
        known,
        int(number_of(tries, "`tries`")),
        int(number_of(seed, "`seed`")),
    )
    with log_paths(declared, logs) as (files,):
        return Experiment(design_experiment(declared, request, files, progress))


def friction_map(
    points: Path | str,
    *,
    rate: str = "rate",
    torque: str = "torque",
    spread: str | None = None,
    nominal: str | None = None,
    axis: str = "pan",
    confidence: float = 0.95,
) -> FrictionMap:
    r"""Fit laws of friction to steady points, a CSV of rates [rpm] and torques [mN m], and name the
    smallest that predicts as well as any other; `save` writes it as part of a platform.

    `rate`, `torque` and `spread` name the columns; `nominal` is the torque that % is of. A point at
    rate 0 is a breakaway torque. Raises InputError for a file or columns that cannot be used.

    >>> import ptp_symbolic as ptp, pathlib
    >>> rows = ["rate [rad/s],torque [N m]", *(f"{w},{0.2 + 0.1 * w}" for w in (1, 2, 3, 4, 5))]
    >>> size = pathlib.Path("points.csv").write_text("\n".join(rows))
    >>> round(ptp.friction_map("points.csv").parameters["F_v_pan"]["value"], 6)
    0.1
    """
    import json

    from ptp_symbolic.numeric.friction_map.points import Columns, read_points
    from ptp_symbolic.numeric.friction_map.summary import friction_map as fit_map
    from ptp_symbolic.numeric.friction_map.summary import platform_fragment
    from ptp_symbolic.platform import AXES
    from ptp_symbolic.report.friction_map import friction_map_picture
    from ptp_symbolic.workflows.result import Output

    if not 0.5 <= number_of(confidence, "`confidence`") < 1.0:
        raise InputError(f"`confidence` {confidence:g}: give at least 0.5 and less than 1.")
    if axis not in AXES:
        raise unknown("axis", axis, AXES)
    summary = fit_map(
        read_points(
            path_of(points, "`points`", "the path of a CSV file"),
            Columns(rate, torque, spread, nominal),
        ),
        axis,
        confidence,
    )
    files: dict[str, str | bytes] = {
        "friction.toml": platform_fragment(summary),
        "friction.png": friction_map_picture(summary),
        "friction.json": json.dumps(summary, indent=2) + "\n",
    }
    return FrictionMap(Output(summary, files))


def estimates_of(table: Mapping[str, Mapping[str, Any]]) -> dict[str, Estimate]:
    """The parameters of a summary as estimates, by name."""
    return {
        name: Estimate(
            name,
            row["value"],
            (row["ci95"][0], row["ci95"][1]),
            row["unit"],
            row["meaning"],
            row["start"],
            row["at_bound"],
            row["identified"],
        )
        for name, row in table.items()
    }


def _table_of(parameters: Mapping[str, Estimate]) -> Table:
    rows = tuple((e.name, e.value, *e.interval, e.unit, e.meaning) for e in parameters.values())
    heads = ("parameter", "value", "lower 95 %", "upper 95 %", "unit", "meaning")
    return Table("Parameter", heads, rows)


def _platform(output: "Output") -> Platform:
    if output.platform is None:
        raise InputError("This result has no platform.")
    return output.platform


def _plot(output: "Output", hidden: Sequence[str] = ()) -> "Figure":
    from ptp_symbolic.api.plots import measured_and_simulated

    if not output.curves:
        raise InputError("Nothing was simulated: the fit failed.")
    return measured_and_simulated(output.curves, hidden)


def _saved(diagnosis: Diagnosis | Path | str) -> Any:
    if isinstance(diagnosis, Diagnosis):
        return diagnosis.summary
    return path_of(diagnosis, "`diagnosis`", "a Diagnosis, or the folder of one")
