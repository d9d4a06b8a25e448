"""Write field logs with a chosen hidden effect.

Usage: python -m tests.independent.make_logs --effect base_tilt --out FOLDER --seed 1
       [--platform pan|two_axis] [--size 1.0] [--set NAME=VALUE ...] [--run train/crawl ...]

Two effects at once are joined by a plus sign. The truth goes to FOLDER/truth.json.
"""

import argparse
import json
from pathlib import Path
from types import ModuleType

from tests.independent import pan_logs, two_axis_logs

PLATFORMS: dict[str, ModuleType] = {"pan": pan_logs, "two_axis": two_axis_logs}


def read_setting(text: str) -> tuple[str, float]:
    """NAME=VALUE as a pair; argparse reports what is neither."""
    name, _, value = text.partition("=")
    return name, float(value)


def main(arguments: list[str] | None = None) -> None:
    """Write the logs and the truth, and say what was hidden."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--effect", required=True, help="effect, or effects joined by +")
    parser.add_argument("--platform", choices=sorted(PLATFORMS), default="pan")
    parser.add_argument("--out", type=Path, required=True, help="folder to write into")
    parser.add_argument("--seed", type=int, required=True, help="fixes all chance")
    parser.add_argument("--size", type=float, default=1.0, help="factor on the default strength")
    parser.add_argument(
        "--set", type=read_setting, action="append", default=[], metavar="NAME=VALUE"
    )
    parser.add_argument("--run", action="append", help="write only this run, like train/crawl")
    chosen = parser.parse_args(arguments)
    logs, effects = PLATFORMS[chosen.platform], chosen.effect.split("+")
    if unknown := [effect for effect in effects if effect not in logs.EFFECTS]:
        parser.error(f"unknown effect {unknown[0]!r}; choose from {', '.join(logs.EFFECTS)}")
    truth = logs.write_logs(
        chosen.out, effects, chosen.seed, chosen.size, dict(chosen.set), chosen.run
    )
    truth["seed"] = chosen.seed
    (chosen.out / "truth.json").write_text(json.dumps(truth, indent=2) + "\n")
    print(f"{chosen.out}: {chosen.platform}, hidden {truth['planted'] or 'nothing'}")


if __name__ == "__main__":
    main()
