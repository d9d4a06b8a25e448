"""Trajectories per second on a GPU, beside one core of this machine, and the share of its peak.

    python3 scripts/benchmark_gpu.py [--trajectories 100000]

Without a GPU it says so, and compiles the same kernels for one that is named (`--capability 9.0`):
registers, memory of a thread and what spills, as NVIDIA's assembler reports them.

The share of the peak counts additions and multiplications of the derivative alone, as the docstring
of the emitted module states them: 7 derivatives per step of order 5(4), 2 per fixed step with 2
factorisations of n states (2/3 n^3). Steps that are repeated for their modes, input tables and
step control come on top, so that it is a lower bound.
"""

from __future__ import annotations

import argparse
import importlib.util
import re
import subprocess
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

import ptp_symbolic as ptp
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.gpu.batch import cuda_library, integrate_on_gpu
from ptp_symbolic.numeric.gpu.machine import Layout
from ptp_symbolic.numeric.simulation.inputs import InputSignal, parse_profile

DURATION = 10.0  # s
CASES = {
    "payload": ("runge_kutta", ("multisine:0.05@0.3,0.7", "multisine:0.05@0.2,0.9")),
    "pan_drive": ("fixed_step", ("trapezoid:24,1,3,1@0.5",)),
}
ACCURACY = {"rtol": 1e-6, "atol": 1e-6}
STEP = 1e-3  # s
DERIVATIVES = 7  # per step of the explicit pair
OPERATIONS = re.compile(
    r"Operations of the state derivative: .*?(\d+) of\s+them at every", re.DOTALL
)
# Double-precision operations per clock and multiprocessor: CUDA C++ Programming Guide, table of
# arithmetic throughput; a fused multiply-add counts two.
PER_CLOCK = {(6, 0): 64, (7, 0): 64, (8, 0): 64, (9, 0): 128, (10, 0): 128}
CONSUMER_PER_CLOCK = 4


def operations(model: ptp.Machine) -> int:
    """Operations of one derivative, from the docstring of the emitted module."""
    found = OPERATIONS.search(str(model.module.__doc__))
    return int(found[1]) if found else 0


def problem(name: str, count: int) -> tuple[ptp.Machine, np.ndarray, np.ndarray, list[InputSignal]]:
    """Model, parameters [b, np] that differ by 10 %, initial states [b, n] and signals."""
    model = ptp.load(name)
    spread = np.random.default_rng(1).uniform(0.95, 1.05, (count, 1))
    p = np.repeat(model.parameter_vector()[None], count, 0)
    p[:, :1] *= spread
    x = np.repeat(np.array(model.module.STATE_INITIAL)[None], count, 0)
    return model, p, x, [parse_profile(text, DURATION) for text in CASES[name][1]]


def processor_rate(name: str, runs: int = 20) -> float:
    """Trajectories per second of `simulate` on one core, final states alone."""
    model, _, _, signals = problem(name, 1)
    inputs = dict(zip(model.input_names, signals, strict=True))
    method = CASES[name][0]
    how: dict[str, Any] = ACCURACY if method == "runge_kutta" else {"step": STEP, "method": method}
    ptp.simulate(model, [0.0, DURATION], inputs, ledger=False, **how)
    start = time.perf_counter()
    for _ in range(runs):
        ptp.simulate(model, [0.0, DURATION], inputs, ledger=False, **how)
    return runs / (time.perf_counter() - start)


def on_gpu(name: str, count: int, cuda: Any) -> str:
    """One line: rates on the GPU and the processor, and the share of the peak."""
    model, p, x, signals = problem(name, count)
    method = CASES[name][0]
    how: dict[str, Any] = ACCURACY if method == "runge_kutta" else {"step": STEP}
    seconds, steps = np.inf, 0
    for _ in range(3):
        start = time.perf_counter()
        found = integrate_on_gpu(model, p, x, [signals], None, (0.0, DURATION), method, **how)
        seconds, steps = min(seconds, time.perf_counter() - start), int(found.steps.sum())
    n, each = len(model.state_names), operations(model)
    work = DERIVATIVES * each if method == "runge_kutta" else 2 * each + 2 / 3 * n**3
    device = cuda.get_current_device()
    clock = PER_CLOCK.get(device.compute_capability, CONSUMER_PER_CLOCK)
    peak = device.MULTIPROCESSOR_COUNT * clock * device.CLOCK_RATE * 1e3
    own, rate = count / seconds, processor_rate(name)
    return (
        f"{name:9s} {count} trajectories of {DURATION:g} s, {method}: {own:,.0f} per s,"
        f" {rate:,.0f} on one core ({own / rate:.0f} x);"
        f" {100 * steps * work / seconds / peak:.2g} % of the peak of"
        f" {peak / 1e12:.3g} TFLOP/s"
    )


def device_code(name: str, capability: tuple[int, int]) -> str:
    """One line: what NVIDIA's assembler says of the kernel of a model, compiled without a GPU.

    Raises InputError where the compilers of the extra `gpu` are not installed.
    """
    found = importlib.util.find_spec("nvidia.cuda_nvcc")
    places = [] if found is None else [Path(p) for p in found.submodule_search_locations or ()]
    assembler = next((p / "bin" / "ptxas" for p in places if (p / "bin" / "ptxas").exists()), None)
    if assembler is None:
        raise InputError("ptxas is not installed; run pip install 'ptp-symbolic[gpu]'.")
    import numba.cuda.dispatcher
    from numba import cuda, types

    # numba asks the present GPU for its capability while it compiles device functions.
    numba.cuda.dispatcher.get_current_device = lambda: SimpleNamespace(
        compute_capability=capability
    )
    from ptp_symbolic.numeric.gpu.batch import Accuracy, smooth_kernel, stepping_kernel
    from ptp_symbolic.numeric.gpu.machine import Drives, Runs

    f, v, m, i = types.float64, types.float64[::1], types.float64[:, ::1], types.int64[::1]
    runs = types.NamedTuple((m, m, m, i, i, v, i), Runs)
    drives = types.NamedTuple((v, m, i, m, i, m, i, v, i), Drives)
    smooth, layout = CASES[name][0] == "runge_kutta", Layout.of(ptp.load(name))
    kernel = smooth_kernel(layout) if smooth else stepping_kernel(layout)
    last = types.NamedTuple((f, v, f, types.int64), Accuracy) if smooth else f
    code, _ = cuda.compile_ptx(kernel.py_func, types.void(runs, drives, f, f, last), cc=capability)
    architecture = f"-arch=sm_{capability[0]}{capability[1]}"
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder, "kernel.ptx")
        source.write_text(code, encoding="utf-8")
        command = [str(assembler), architecture, "-v", str(source), "-o", f"{source}.cubin"]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    registers, stack, stores, loads = (
        max(int(number) for number in re.findall(pattern, said))
        for pattern in (
            r"Used (\d+) registers",
            r"(\d+) bytes stack frame",
            r"(\d+) bytes spill stores",
            r"(\d+) bytes spill loads",
        )
    )
    return (
        f"{name:9s} {CASES[name][0]}, compute capability {capability[0]}.{capability[1]}:"
        f" {registers} registers, {stack} bytes of local memory per thread,"
        f" {stores + loads} bytes spilled"
    )


def main() -> None:
    """Measure on a GPU, or say what its code would need."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--trajectories", type=int, default=100_000)
    parser.add_argument("--capability", default="9.0", help="of a GPU to compile for without one")
    given = parser.parse_args()
    try:
        cuda = cuda_library()
    except InputError as error:
        print(error)
        major, _, minor = given.capability.partition(".")
        try:
            for name in CASES:
                print(device_code(name, (int(major), int(minor or 0))))
        except InputError as why:
            print(why)
        return
    for name in CASES:
        print(on_gpu(name, given.trajectories, cuda))


if __name__ == "__main__":
    main()
