"""The kernels compile to code of a real GPU, which needs none."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.long
def test_kernels_compile_for_a_gpu_and_spill_no_registers(checkout: Path) -> None:
    pytest.importorskip("numba_cuda", reason="numba-cuda is not installed: the extra gpu")
    pytest.importorskip("nvidia.cuda_nvcc", reason="no CUDA compiler installed: the extra gpu")
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_ENABLE_CUDASIM"}
    said = subprocess.run(
        [sys.executable, "scripts/benchmark_gpu.py", "--trajectories", "1000"],
        cwd=checkout,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    if "No NVIDIA GPU" not in said:
        assert said.count("trajectories of 10 s") == 2  # measured on the GPU of this machine
        return
    found = re.findall(r"compute capability 9\.0: (\d+) registers, \d+ bytes .*, (\d+) bytes", said)
    assert len(found) == 2
    for registers, spilled in found:
        assert 0 < int(registers) <= 255
        assert spilled == "0"
