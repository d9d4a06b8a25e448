"""Print what exported models take of a microcontroller: flash, RAM, stack, instructions per call.

    python scripts/firmware_table.py [--out FILE.json] [PLATFORM...]

Needs Debian's gcc-arm-none-eabi, libnewlib-arm-none-eabi and qemu-system-arm, and the package
itself. Cortex-M4F runs single precision, Cortex-M7 double. Instructions are counted by QEMU, which
does not know waits for memory and the pipeline: a core takes about one to two cycles for each.
"""

import argparse
import json
import shutil
import subprocess
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

HERE = Path(__file__).parent / "firmware"
PLATFORMS = ("thesis-payload", "thesis-pan-drive", "thesis-tilt-drive", "thesis-full")
VOLTS, STEP = 6.0, 1e-3
SHIFT, TICK = 5, 40  # 2^5 ns of virtual time an instruction; ns a tick of SysTick at 25 MHz
CORES = {
    "Cortex-M4F, float": (
        "c99-float",
        "mps2-an386",
        ["-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16"],
    ),
    "Cortex-M7, double": ("c99", "mps2-an500", ["-mcpu=cortex-m7", "-mfpu=fpv5-d16"]),
}
ARM = ["-mthumb", "-mfloat-abi=hard", "-O2", "-std=gnu99", "-ffunction-sections", "-fdata-sections"]
TOOLS = ("arm-none-eabi-gcc", "arm-none-eabi-size", "qemu-system-arm")


@dataclass(frozen=True)
class Row:
    """One model on one core. Bytes: `flash` of the model alone and `image` with libm and start-up,
    `ram` of the machine between steps, `stack` of a step. Instructions: of the vector field, its
    Jacobian by the state, the outputs, a step on average and the worst seen.
    """

    model: str
    core: str
    flash: int
    image: int
    ram: int
    stack: int
    vector_field: int
    jacobian: int
    outputs: int
    step: int
    worst_step: int


def measured(platform: str, core: str, folder: Path) -> Row:
    """Compile a platform for a core, run it there, and read what it says."""
    from ptp_symbolic import export

    target, board, options = CORES[core]
    header, source = export(platform, target, folder)
    name = source.stem
    sizes = [f"-D{word}={name.upper()}_{word}" for word in ("STATES", "INPUTS", "PARAMETERS")]
    given = [f"-DMODEL={name}", f'-DHEADER="{header.name}"', f"-DVOLTS={VOLTS}", f"-DSTEP={STEP}"]
    compiler = [TOOLS[0], *ARM, *options, f"-I{folder}"]
    _run([*compiler, "-c", str(source), "-o", str(folder / "model.o")])
    image = folder / "image.elf"
    _run(
        [
            *compiler,
            *given,
            *sizes,
            str(HERE / "main.c"),
            str(folder / "model.o"),
            f"-T{HERE / 'cortex_m.ld'}",
            "-nostartfiles",
            "--specs=nosys.specs",
            "-Wl,--gc-sections",
            "-Wl,--no-warn-rwx-segments",
            "-lm",
            "-o",
            str(image),
        ]
    )
    run = [TOOLS[2], "-M", board, "-icount", f"shift={SHIFT}", "-semihosting", "-nographic"]
    said = _run([*run, "-monitor", "none", "-serial", "none", "-kernel", str(image)], timeout=300)
    failed, *ticks, stack, ram = (int(word) for word in said.split())
    if failed:
        raise RuntimeError(f"{name} on {core}: a step failed with status {failed}")
    instructions = [round(t * TICK / 2**SHIFT) for t in ticks]
    return Row(name, core, _flash(folder / "model.o"), _flash(image), ram, stack, *instructions)


def _flash(binary: Path) -> int:
    return int(_run([TOOLS[1], str(binary)]).splitlines()[1].split()[0])


def _run(command: list[str], timeout: float = 120.0) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}\n{done.stderr[-2000:]}")
    return done.stdout + done.stderr


def main() -> int:
    """Print the table; write it as JSON with --out."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("platforms", nargs="*", default=PLATFORMS)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        print(f"Not found: {', '.join(missing)}; install the Debian packages named above.")
        return 2
    rows = []
    for platform in arguments.platforms:
        for core in CORES:
            with tempfile.TemporaryDirectory() as folder:
                rows.append(measured(platform, core, Path(folder)))
    table = Table(title="Exported C on microcontrollers: bytes, and instructions per call")
    for field in asdict(rows[0]):
        table.add_column(field.replace("_", " "), justify="left" if field == "model" else "right")
    for row in rows:
        table.add_row(*(str(value) for value in asdict(row).values()))
    Console(width=150).print(table)
    if arguments.out:
        arguments.out.write_text(json.dumps([asdict(row) for row in rows], indent=1) + "\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
