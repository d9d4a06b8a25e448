"""Make and diagnose sets, each in a process of its own on its share of the cores.

Per set: diagnosis.json as the package writes it, the evidence.npz that it rests on, which `price`
decides upon again, and outcome.json with times, memory and the score.
A set whose outcome exists is left alone, so that a run can be taken up again.
"""

import json
import os
import queue
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from tests.benchmark.entry import Entry
from tests.benchmark.scaled import apply
from tests.benchmark.score import score
from tests.benchmark.sets import generate
from tests.benchmark.sizing import AbsorbedError

TIME_OUT = 480.0  # s; the limit of a search, 300 s, and what comes after it
POLL = 0.25  # s between looks at the memory
CHECKOUT = Path(__file__).resolve().parents[2]


def make_missing(entry: Entry, folder: Path) -> bool:
    """Write the set of an entry unless it is there; whether it was missing."""
    if (folder / "truth.json").exists():
        return False
    generate(entry, folder)
    return True


def diagnose_one(folder: Path, cores: Sequence[int], scale: str | None = None) -> None:
    """In a process of its own: diagnose a set on `cores`, write diagnosis.json and usage.json."""
    os.sched_setaffinity(0, set(cores))
    if scale is not None:
        apply(scale)
    import resource

    from ptp_symbolic.platform import read_platform
    from ptp_symbolic.workflows.diagnosis import diagnose_platform
    from ptp_symbolic.workflows.stored_evidence import FILE

    begun = time.monotonic()
    platform = read_platform(folder / "platform.toml")
    train, validate = (sorted((folder / half).glob("*.csv")) for half in ("train", "validate"))
    found = diagnose_platform(platform, train, validate, keep=folder)
    summary = found.summary
    wall = time.monotonic() - begun
    usage = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    cpu = sum(one.ru_utime + one.ru_stime for one in usage)
    (folder / FILE).write_bytes(bytes(found.files[FILE]))  # type: ignore[arg-type]
    (folder / "diagnosis.json").write_text(json.dumps(summary, indent=1, default=float) + "\n")
    (folder / "usage.json").write_text(
        json.dumps({"wall_s": round(wall, 2), "cpu_s": round(cpu, 2)}) + "\n"
    )


def _session_memory(session: int) -> float:
    """Memory in MB of all processes of a session, shared pages counted once in all."""
    total = 0.0
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if os.getsid(int(process.name)) == session:
                lines = (process / "smaps_rollup").read_text().splitlines()
                total += sum(float(line.split()[1]) for line in lines if line.startswith("Pss:"))
        except (OSError, ValueError):
            continue  # the process has ended meanwhile
    return total / 1024


def _watch(process: "subprocess.Popen[bytes]", deadline: float) -> tuple[bool, float]:
    """Wait for the end; whether it came in time, and the largest memory in MB."""
    peak = 0.0
    while process.poll() is None:
        peak = max(peak, _session_memory(process.pid))
        if time.monotonic() > deadline:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return False, peak
        time.sleep(POLL)
    return True, peak


def run_one(
    entry: Entry, out: Path, cores: Sequence[int], scale: str | None = None
) -> dict[str, Any]:
    """Make and diagnose a set, write its outcome.json and return it."""
    folder = out / entry.id
    make_missing(entry, folder)
    for stale in ("diagnosis.json", "usage.json", "evidence.npz"):
        (folder / stale).unlink(missing_ok=True)
    arguments = ["diagnose-one", "--out", str(folder), "--cores", ",".join(map(str, cores))]
    arguments += [] if scale is None else ["--scale", scale]
    begun = time.monotonic()
    with (folder / "log.txt").open("wb") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "tests.benchmark", *arguments],
            cwd=CHECKOUT,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        in_time, peak = _watch(process, begun + TIME_OUT)
    outcome: dict[str, Any] = {"id": entry.id, "peak_mb": round(peak, 1)}
    outcome["process_s"] = outcome["wall_s"] = round(time.monotonic() - begun, 2)
    answer = folder / "diagnosis.json"
    if in_time and process.returncode == 0 and answer.exists():
        outcome |= {"status": "done", **json.loads((folder / "usage.json").read_text())}
    else:
        outcome["status"] = "error" if in_time else "time-out"
        outcome["message"] = (folder / "log.txt").read_text(errors="replace")[-500:]
    outcome["score"] = score(*read_set(folder)).as_dict()
    (folder / "outcome.json").write_text(json.dumps(outcome, indent=1) + "\n")
    return outcome


def read_set(folder: Path) -> tuple[dict[str, Any], dict[str, Any] | None]:
    """Truth and diagnosis of a set; None where there is no answer."""
    answer = folder / "diagnosis.json"
    truth = json.loads((folder / "truth.json").read_text())
    return truth, json.loads(answer.read_text()) if answer.exists() else None


def line_of(outcome: dict[str, Any]) -> str:
    """One line for a finished set."""
    result = outcome["score"]
    named = ", ".join(result["named"]) or "no name"
    group = " (group)" if result["group"] else ""
    status = "" if outcome["status"] == "done" else f" [{outcome['status']}]"
    return (
        f"{result['answer']:6}{group} {outcome['wall_s']:6.1f} s {outcome['peak_mb']:6.0f} MB  "
        f"{outcome['id']}: {result['verdict']}, {named}{status}"
    )


def progress_bar() -> Progress:
    """A bar on the terminal's error stream."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    return Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True))


def run_all(entries: Sequence[Entry], out: Path, jobs: int, scale: str | None = None) -> None:
    """Diagnose the entries without an outcome, `jobs` at a time; prints a line per set; where no
    machine drawn shows the effects at a sane size, why the set was not made.
    """
    run_under([(entry, out, scale) for entry in entries], jobs)


def run_under(wanted: Sequence[tuple[Entry, Path, str | None]], jobs: int) -> None:
    """The same with a folder and a scaling of constants for each."""
    todo = [one for one in wanted if not (one[1] / one[0].id / "outcome.json").exists()]
    cores = sorted(os.sched_getaffinity(0))
    jobs = min(jobs, len(cores))
    shares: queue.SimpleQueue[list[int]] = queue.SimpleQueue()
    for number in range(jobs):
        shares.put(cores[number::jobs])

    def work(entry: Entry, out: Path, scale: str | None) -> str:
        share = shares.get()
        try:
            line = line_of(run_one(entry, out, share, scale))
        except AbsorbedError as absorbed:
            line = f"not made: {absorbed}"
        finally:
            shares.put(share)
        return line if scale is None else f"{scale}: {line}"

    with progress_bar() as progress, ThreadPoolExecutor(jobs) as pool:
        task = progress.add_task("diagnose", total=len(todo))
        for done in as_completed([pool.submit(work, *one) for one in todo]):
            print(done.result(), flush=True)
            progress.advance(task)
