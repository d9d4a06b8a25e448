"""Sweeps: samples of distributions simulated chunk by chunk, written to disk as they come.

A chunk is whole or not there: it counts from the moment that its Parquet file is renamed into
place. What a chunk holds follows from the plan and its number alone, so that a run that was
interrupted goes on where it stopped, and processes of a cluster compute the same bits.
"""

from __future__ import annotations

import io
import json
import shutil
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.api.batch import SHARE, machine_memory, simulate_batch
from ptp_symbolic.api.batch_results import Batch, slope_name
from ptp_symbolic.api.extras import extra_library
from ptp_symbolic.api.machine import Machine
from ptp_symbolic.api.reductions import line_of_sight_error, reference
from ptp_symbolic.atomic_files import write_files_atomically
from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.simulation.run import output_times
from ptp_symbolic.platform.units import quantity

FloatArray = NDArray[np.float64]

PLAN, PARTS, WHOLE, BANDS = "plan.json", "trajectories", "trajectories.zarr", "bands"
BAND_BYTES = 256_000_000  # of the values that quantiles are taken of at once
BAND_TIMES = 201  # of the bands, between start and end
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
POINTING = "pointing error"
SOBOL_BITS = 30  # SciPy skips no points of sequences with more than 32
CHUNK_BYTES = 64e6
CONNECT_WITHIN = "5s"
MOST_ROWS = 16_384  # of a chunk, so that little is lost where a run is interrupted
FORMS = (
    "NAME=LOW:HIGH, NAME=loguniform:LOW:HIGH, NAME=normal:MEAN:SD, NAME=lognormal:MEDIAN:SIGMA,"
    " NAME=triangular:LOW:MODE:HIGH"
)


@dataclass(frozen=True)
class SweepPlan:
    """What a sweep computes: the hash of the equations; `vary`: per name its distribution as text;
    number of samples, seed of the Sobol sequence; duration and interval in s; inputs, initial
    states, outputs, references of the line of sight by name; tolerances; runs per chunk; whether
    whole trajectories are kept, and values for bands; what outputs are differentiated by.
    """

    model: str
    vary: Mapping[str, str]
    samples: int
    seed: int
    duration: float
    every: float
    inputs: Mapping[str, str]
    initial: Mapping[str, float]
    outputs: Sequence[str]
    signals: Sequence[str]
    aim: Mapping[str, str]
    rtol: float
    atol: float
    chunk: int
    whole: bool = False
    bands: bool = True
    sensitivities: Sequence[str] = ()

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.samples // self.chunk)

    @property
    def times(self) -> FloatArray:
        """Output times [k] in s."""
        return output_times(self.duration, self.every)

    def rows(self, chunk: int) -> tuple[int, int]:
        """First run of a chunk, and the one after its last."""
        return chunk * self.chunk, min((chunk + 1) * self.chunk, self.samples)


def distribution(name: str, text: str, unit: str) -> Any:
    """The SciPy distribution that `text` describes, in SI. Raises InputError for other forms."""
    kind, *parts = text.split(":")
    if kind.strip() not in ("uniform", "loguniform", "normal", "lognormal", "triangular"):
        kind, parts = "uniform", [kind, *parts]
    what, kind = f"'{name}'", kind.strip()
    if len(parts) != (3 if kind == "triangular" else 2):
        raise InputError(f"Distribution {name}={text}: write {FORMS}.")

    def number(part: str, own: str = unit) -> float:
        try:
            return float(part)
        except ValueError:
            return quantity(part, own, what)

    first = number(parts[0])
    last = number(parts[-1], "1" if kind == "lognormal" else unit)
    if kind in ("normal", "lognormal"):
        if not last > 0.0 or (kind == "lognormal" and not first > 0.0):
            raise InputError(f"Distribution {name}={text}: spread and median are above zero.")
        return stats.norm(first, last) if kind == "normal" else stats.lognorm(last, scale=first)
    if not first < last or (kind == "loguniform" and not first > 0.0):
        raise InputError(f"Distribution {name}={text}: {first:g} is not below {last:g} {unit}.")
    if kind == "triangular":
        mode = number(parts[1])
        return stats.triang((mode - first) / (last - first), first, last - first)
    return (
        stats.loguniform(first, last)
        if kind == "loguniform"
        else stats.uniform(first, last - first)
    )


def sampled(machine: Machine, plan: SweepPlan, first: int, last: int) -> dict[str, FloatArray]:
    """Values of what varies in the runs `first` to `last`, of a scrambled Sobol sequence."""
    sequence = stats.qmc.Sobol(len(plan.vary), scramble=True, bits=SOBOL_BITS, seed=plan.seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of a number that is no power of two
        points = (sequence.fast_forward(first) if first else sequence).random(last - first)
    inside = np.clip(points, 2.0**-SOBOL_BITS, 1.0 - 2.0**-SOBOL_BITS)
    return {
        name: np.asarray(distribution(name, text, machine.units[name]).ppf(inside[:, j]))
        for j, (name, text) in enumerate(plan.vary.items())
    }


@dataclass(frozen=True, eq=False)
class Part:
    """Results of one chunk: a row per run, signals [m, k] by name where whole trajectories are
    kept, and values [m, BAND_TIMES] of what bands are drawn of.
    """

    table: dict[str, NDArray[Any]]
    signals: dict[str, FloatArray]
    bands: dict[str, FloatArray]


def compute_part(machine: Machine, plan: SweepPlan, chunk: int, threads: int | None = None) -> Part:
    """Simulate a chunk of `plan`; the same bits wherever and beside whatever it is computed."""
    first, last = plan.rows(chunk)
    values = sampled(machine, plan, first, last)
    states = {n: v for n, v in values.items() if n in machine.state_names}
    parameters = {n: v for n, v in values.items() if n not in states}
    found = simulate_batch(
        machine,
        plan.times,
        dict(plan.inputs),
        parameters,
        outputs=[*(plan.signals if plan.whole or plan.bands else ()), *plan.outputs],
        rtol=plan.rtol,
        atol=plan.atol,
        threads=threads,
        x0={**plan.initial, **states},
        sensitivities=plan.sensitivities,
    )
    table = {"run": np.arange(first, last), **found.table()}
    table["seed"] = np.full(last - first, plan.seed)
    bands = _bands(plan, found) if plan.bands else {}
    return Part(table, dict(found.signals) if plan.whole else {}, bands)


def _bands(plan: SweepPlan, found: Batch) -> dict[str, FloatArray]:
    """Values of signals and of the pointing error at the times of the bands."""
    t = plan.times
    at = band_columns(plan)
    bands = {name: values[:, at].copy() for name, values in found.signals.items()}
    if plan.aim:
        aim = {n: reference(text, found.units[n], t)[at] for n, text in plan.aim.items()}
        bands[POINTING] = line_of_sight_error(bands, aim)
    return bands


def band_columns(plan: SweepPlan) -> NDArray[np.int64]:
    """Indices of the output times at which bands are drawn."""
    k = len(plan.times)
    return np.unique(np.linspace(0, k - 1, min(k, BAND_TIMES)).round().astype(np.int64))


def refuse_plan(machine: Machine, plan: SweepPlan, out: Path) -> None:
    """Raise InputError for names and distributions that are wrong, and for a plan that needs more
    memory or disk than there is.
    """
    known = (*machine.parameter_names, *machine.state_names)
    for name, text in plan.vary.items():
        if name not in known:
            raise unknown("parameter or state", name, known)
        distribution(name, text, machine.units[name])
    if not 1 <= plan.samples <= 2**SOBOL_BITS or plan.chunk < 1:
        raise InputError(
            f"{plan.samples} samples in chunks of {plan.chunk}; give at least one, and at most"
            f" {2**SOBOL_BITS} samples."
        )
    for name in plan.sensitivities:
        if name not in known:
            raise unknown("parameter or state", name, known)
    if not plan.vary:
        raise InputError(f"Nothing varies; give `vary`: {FORMS}.")
    k, n = len(plan.times), len(machine.state_names) + len(plan.signals)
    n *= 1 + len(plan.sensitivities)
    need, have = 8.0 * min(plan.chunk, plan.samples) * k * n, machine_memory()
    if need > SHARE * have:
        raise InputError(
            f"A chunk of {min(plan.chunk, plan.samples)} runs with {k} times of {n} signals needs"
            f" {need / 1e9:.3g} GB"
            f" of memory, and this machine has {have / 1e9:.3g} GB; take a smaller `chunk`."
        )
    numbers = len(plan.outputs) * (1 + len(plan.sensitivities))
    row = 8.0 * (len(plan.vary) + numbers + 4)
    row += 8.0 * BAND_TIMES * (len(plan.signals) + bool(plan.aim)) if plan.bands else 0.0
    row += 8.0 * k * len(plan.signals) if plan.whole else 0.0
    place = next(p for p in (out, *out.absolute().parents) if p.is_dir())
    free = shutil.disk_usage(place).free
    if plan.samples * row > free:
        raise InputError(
            f"{plan.samples} runs need {plan.samples * row / 1e9:.3g} GB on disk, and"
            f" '{place}' has {free / 1e9:.3g} GB; take fewer samples, or leave out whole"
            " trajectories."
        )


def begin(machine: Machine, plan: SweepPlan, out: Path, resume: bool) -> list[int]:
    """Prepare the folder `out`; returns the chunks that are not there yet.

    Raises InputError where it holds another sweep, or the same one and `resume` is not asked for.
    """
    refuse_plan(machine, plan, out)
    text = json.dumps(asdict(plan), indent=1, sort_keys=True) + "\n"
    there = out / PLAN
    if there.is_file():
        if there.read_text(encoding="utf-8") != text:
            raise InputError(f"'{out}' holds another sweep; give another `out`, or its settings.")
        missing = [c for c in range(plan.chunks) if not part_path(out, c).is_file()]
        if not resume and missing != list(range(plan.chunks)):
            done = plan.chunks - len(missing)
            if not missing:
                raise InputError(f"'{out}' holds this sweep, complete; give another `out`.")
            raise InputError(
                f"'{out}' holds {done} of {plan.chunks} chunks of this sweep; add --resume to"
                " compute the others, or give another `out`."
            )
        return missing
    write_files_atomically(out, {PLAN: text})
    if plan.whole:
        _new_store(machine, plan, out)
    return list(range(plan.chunks))


def part_path(out: Path, chunk: int) -> Path:
    """The Parquet file of a chunk."""
    return out / PARTS / f"part-{chunk:06d}.parquet"


def _new_store(machine: Machine, plan: SweepPlan, out: Path) -> None:
    xarray, dask = extra_library("xarray", "sweep"), extra_library("dask.array", "sweep")
    extra_library("zarr", "sweep")
    t, shape = plan.times, (plan.samples, len(plan.times))
    empty = dask.full(shape, np.nan, chunks=(min(plan.chunk, plan.samples), shape[1]))
    data = {n: (("run", "time"), empty, {"units": machine.units[n]}) for n in plan.signals}
    found = xarray.Dataset(data, coords={"time": ("time", t, {"units": "s"})})
    found.to_zarr(out / WHOLE, mode="w", compute=False, consolidated=False)


def write_part(plan: SweepPlan, out: Path, chunk: int, part: Part) -> None:
    """Write a chunk; its Parquet file comes last and makes it whole."""
    arrow, parquet = extra_library("pyarrow", "sweep"), extra_library("pyarrow.parquet", "sweep")
    first, last = plan.rows(chunk)
    if part.signals:
        data = {name: (("run", "time"), values) for name, values in part.signals.items()}
        dataset = extra_library("xarray", "sweep").Dataset(data)
        region = {"run": slice(first, last)}
        dataset.to_zarr(out / WHOLE, region=region, consolidated=False)
    buffer, bands = io.BytesIO(), io.BytesIO()
    columns = {n: v.tolist() if v.dtype.kind in "OU" else v for n, v in part.table.items()}
    parquet.write_table(arrow.table(columns), buffer)
    if part.bands:
        np.savez(bands, **part.bands)  # type: ignore[arg-type]
        write_files_atomically(out / BANDS, {f"part-{chunk:06d}.npz": bands.getvalue()})
    path = part_path(out, chunk)
    write_files_atomically(path.parent, {path.name: buffer.getvalue()})


def run_sweep(
    machine: Machine,
    plan: SweepPlan,
    out: Path,
    resume: bool = False,
    cluster: str | None = None,
    progress: Callable[[str], None] = lambda text: None,
) -> None:
    """Compute and write every chunk that is missing, on this machine or on the workers of the Dask
    scheduler at `cluster`. Raises InputError as `begin` does, for a cluster that does not answer,
    and for a disk that is full, with whole chunks left.
    """
    client = None if cluster is None else connected(cluster)
    missing = begin(machine, plan, out, resume)
    parts = (
        ((c, compute_part(machine, plan, c)) for c in missing)
        if client is None
        else _on_cluster(machine, plan, missing, client)
    )
    done = plan.chunks - len(missing)
    for chunk, part in parts:
        try:
            write_part(plan, out, chunk, part)
        except (InputError, OSError) as error:
            raise InputError(
                f"{error} {done} of {plan.chunks} chunks are whole; make room and add --resume."
            ) from error
        done += 1
        progress(f"{done} of {plan.chunks} chunks, {min(done * plan.chunk, plan.samples)} runs")


def connected(address: str) -> Any:
    """A client of the Dask scheduler at `address`. Raises InputError where none answers."""
    distributed = extra_library("distributed", "cluster")
    try:
        return distributed.Client(address, timeout=CONNECT_WITHIN)
    except (OSError, ValueError) as error:
        raise InputError(
            f"No Dask scheduler answers at '{address}'; start one with `dask scheduler` and workers"
            f" with `dask worker {address}`."
        ) from error


def _on_cluster(
    machine: Machine, plan: SweepPlan, missing: Sequence[int], client: Any
) -> Iterator[tuple[int, Part]]:
    """The chunks in the order in which the workers of a Dask cluster finish them.

    A worker that dies loses nothing: the scheduler gives its chunks to others. The machine travels
    as its platform and the hash of its equations. As many chunks are under way as keep all workers
    busy, and no more are kept in memory. Raises InputError where the scheduler is lost.
    """
    distributed = extra_library("distributed", "cluster")
    with client:
        room = 2 * max(1, sum(client.nthreads().values()))
        waiting = iter(missing)
        futures: dict[Any, int] = {}
        finished = distributed.as_completed(loop=client.loop)

        def submit() -> None:
            chunk = next(waiting, None)
            if chunk is not None:
                future = client.submit(compute_part, machine, plan, chunk, 1, pure=False, retries=3)
                futures[future] = chunk
                finished.add(future)

        for _ in range(min(room, len(missing))):
            submit()
        for future in finished:
            try:
                part = future.result()
            except (distributed.CancelledError, OSError) as error:
                raise InputError(
                    f"The Dask scheduler is lost ({error}); start it again and add --resume."
                ) from error
            chunk = futures.pop(future)
            submit()
            yield chunk, part


def bands_of(plan: SweepPlan, out: Path) -> dict[str, FloatArray]:
    """Quantiles [QUANTILES, times] of every signal, and of the pointing error, over all runs that
    reached their end.
    """
    if not plan.bands:
        return {}
    files = [np.load(out / BANDS / f"part-{c:06d}.npz") for c in range(plan.chunks)]
    found: dict[str, FloatArray] = {}
    for name in files[0].files:
        k = files[0][name].shape[1]
        blocks = -(-int(8.0 * plan.samples * k) // BAND_BYTES)
        quantiles = []
        for columns in np.array_split(np.arange(k), min(k, blocks)):
            values = np.concatenate([file[name][:, columns] for file in files])
            values = values[np.isfinite(values).all(axis=1)]
            if len(values):
                quantiles.append(np.quantile(values, QUANTILES, axis=0))
        if quantiles:
            found[name] = np.concatenate(quantiles, axis=1)
    return found


def summary_of(plan: SweepPlan, out: Path) -> dict[str, Any]:
    """Number of runs by status; mean, standard deviation and quantiles of every output, and mean
    and root mean square of its derivatives (the measures of Sobol and Kucherenko, 2009).
    """
    parquet = extra_library("pyarrow.parquet", "sweep")
    slopes = {(n, by): slope_name(n, by) for n in plan.outputs for by in plan.sensitivities}
    columns = ["status", *plan.outputs, *slopes.values()]
    tables = [parquet.read_table(part_path(out, c), columns=columns) for c in range(plan.chunks)]

    def finite(name: str) -> FloatArray:
        values = np.concatenate([table[name].to_numpy() for table in tables])
        found: FloatArray = values[np.isfinite(values)]
        return found

    status = np.concatenate([table["status"].to_numpy() for table in tables])
    words, counts = np.unique(status.astype(np.str_), return_counts=True)
    outputs: dict[str, Any] = {}
    for name in plan.outputs:
        values = finite(name)
        if len(values):
            spread = float(values.std(ddof=1)) if len(values) > 1 else 0.0
            quantiles = dict(
                zip(map(str, QUANTILES), map(float, np.quantile(values, QUANTILES)), strict=True)
            )
            outputs[name] = {"mean": float(values.mean()), "sd": spread, "quantiles": quantiles}
    for (name, by), column in slopes.items():
        values = finite(column)
        if len(values):
            size = {"mean": float(values.mean()), "rms": float(np.sqrt(np.mean(values**2)))}
            outputs[name].setdefault("sensitivities", {})[by] = size
    by_status = dict(zip(map(str, words), map(int, counts), strict=True))
    return {"runs": plan.samples, "status": by_status, "outputs": outputs}
