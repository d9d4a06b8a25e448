"""Commands of the benchmark.

    python -m tests.benchmark make  --out DIR [--half build|report] [--only REGEX]
    python -m tests.benchmark run   --out DIR [--half ...] [--only REGEX] [--jobs N]
                                    [--scale SECTION=FACTOR | NAME=FACTOR] [--redraw N]
    python -m tests.benchmark table --out DIR [--half ...] [--only REGEX]
    python -m tests.benchmark draw  --out DIR [--half ...] [--only REGEX] FILE.png
    python -m tests.benchmark constants --out DIR --half build --only REGEX [--jobs N]
    python -m tests.benchmark price [--simulate] [--rule REGEX] [--as VALUE] FOLDER...

`run` makes what is missing and leaves out what has an outcome; with --scale, a chosen constant, or
all of a section of their table, "effort" for one, are taken times the factor. With --redraw, the
sets of the build half are drawn anew, surroundings and all, once for every N: what is right on the
half may be right by chance. `table` also writes table.md and table.json into DIR. `constants` runs
a few sets with every chosen constant halved and doubled in turn, and prints a row for each. `price`
decides again upon the evidence in folders, of sets or of `ptp-symbolic diagnose`, without one rule
after the other, or with another value of a rule that is a number, and prints the verdicts that
change; with --simulate, what is missing for that is simulated, and added to the evidence.
"""

import argparse
import re
from pathlib import Path

from tests.benchmark.catalogue import catalogue, redrawn
from tests.benchmark.constant_rows import halved_and_doubled
from tests.benchmark.entry import Entry
from tests.benchmark.runner import diagnose_one, make_missing, progress_bar, run_all
from tests.benchmark.sizing import AbsorbedError
from tests.benchmark.table import figures, read_results, show, write_tables


def chosen(arguments: argparse.Namespace) -> list[Entry]:
    """Entries of the half and the pattern asked for, drawn anew where that is."""
    entries = [
        entry
        for entry in catalogue()
        if arguments.half in (None, entry.half) and re.search(arguments.only, entry.id)
    ]
    number = arguments.redraw
    return entries if number is None else [redrawn(entry, number) for entry in entries]


def make(arguments: argparse.Namespace) -> None:
    """Write the sets that are missing."""
    entries = chosen(arguments)
    with progress_bar() as progress:
        task = progress.add_task("make", total=len(entries))
        for entry in entries:
            try:
                if make_missing(entry, arguments.out / entry.id):
                    print(entry.id, flush=True)
            except AbsorbedError as absorbed:
                print(f"not made: {absorbed}", flush=True)
            progress.advance(task)


def run(arguments: argparse.Namespace) -> None:
    """Diagnose the sets that have no outcome."""
    run_all(chosen(arguments), arguments.out, arguments.jobs, arguments.scale)


def tabulate(arguments: argparse.Namespace) -> None:
    """Print and write the figures of the sets that have an outcome."""
    results = read_results(chosen(arguments), arguments.out)
    title = f"{len(results)} sets, {arguments.half or 'both halves'}"
    data = figures(results)
    show(data, title)
    stem = "table" if arguments.half is None else f"table-{arguments.half}"
    write_tables(data, arguments.out, title, stem)


def constants(arguments: argparse.Namespace) -> None:
    """Print what hangs on every chosen constant."""
    for line in halved_and_doubled(chosen(arguments), arguments.out, arguments.jobs):
        print(line, flush=True)


def draw(arguments: argparse.Namespace) -> None:
    """Draw power and confusion of the sets that have an outcome."""
    from tests.benchmark.draw import draw_all

    draw_all(read_results(chosen(arguments), arguments.out), arguments.files[0])


def one(arguments: argparse.Namespace) -> None:
    """Diagnose the set in the folder `out`, in this process."""
    cores = [int(core) for core in arguments.cores.split(",")]
    diagnose_one(arguments.out, cores, arguments.scale)


def price(arguments: argparse.Namespace) -> None:
    """Print what each rule is worth."""
    from tests.benchmark.price import prices

    folders = [Path(folder) for folder in arguments.files]
    for line in prices(folders, arguments.rule, arguments.simulate, arguments.value):
        print(line, flush=True)


COMMANDS = {
    "make": make,
    "run": run,
    "table": tabulate,
    "draw": draw,
    "constants": constants,
    "price": price,
    "diagnose-one": one,
}


def main() -> None:
    """Run the command asked for."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.benchmark",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("command", choices=COMMANDS)
    parser.add_argument(
        "files", nargs="*", type=Path, help="picture that draw writes; folders with evidence"
    )
    parser.add_argument("--out", type=Path, help="folder of the sets")
    parser.add_argument("--half", choices=["build", "report"])
    parser.add_argument("--only", default="", metavar="REGEX", help="part of the identity")
    parser.add_argument("--jobs", type=int, default=1, help="sets at a time")
    parser.add_argument("--scale", metavar="WHICH=FACTOR", help="of constants that were chosen")
    parser.add_argument("--redraw", type=int, metavar="N", help="the build half in other draws")
    parser.add_argument("--rule", default="", metavar="REGEX", help="part of the name of rules")
    parser.add_argument("--simulate", action="store_true", help="what is not stored for a price")
    parser.add_argument(
        "--as", dest="value", type=float, help="value of the rules, not switched off"
    )
    parser.add_argument("--cores", default="0", help=argparse.SUPPRESS)
    arguments = parser.parse_intermixed_args()
    if arguments.command == "draw" and len(arguments.files) != 1:
        parser.error("draw needs the file to write")
    if arguments.command == "price" and not arguments.files:
        parser.error("price needs folders with evidence")
    if arguments.command != "price" and arguments.out is None:
        parser.error(f"{arguments.command} needs --out, the folder of the sets")
    if arguments.command == "constants" and arguments.half != "build":
        parser.error("constants is for --half build alone: nothing is chosen on the report half")
    if arguments.redraw is not None and arguments.half != "build":
        parser.error("--redraw is for --half build alone: the report half is drawn once")
    COMMANDS[arguments.command](arguments)


if __name__ == "__main__":
    main()
