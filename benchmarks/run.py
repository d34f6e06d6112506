"""The figures of the project, printed and saved: `make bench`, and with the peers that pip brings `make bench-peers`.

`python benchmarks/run.py --quick` shows the same tables of small scenes within seconds, --case and
--small a part of the whole. `python -m benchmarks.methods` takes a quarter of an hour more.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks import adamson_alexa, cases, compare, goals, jumps, machine, quality, scaling, speed, switching
from benchmarks.cases import Case
from benchmarks.table import write_csv
from benchmarks.work_precision import work_precision


def main() -> None:
    parser = argparse.ArgumentParser(description="Print the figures of Jaart, side by side with its peers.")
    parser.add_argument("--quick", action="store_true", help="small scenes, three repetitions, the comparison alone")
    parser.add_argument("--output", type=Path, default=Path("out/bench"), help="folder for CSV and SVG")
    parser.add_argument("--case", action="append", default=[], choices=tuple(cases.WHOLE),
                        help="compare on this one alone; may be given again")
    parser.add_argument("--small", action="store_true", help="pictures of 512x512 alone")
    asked = parser.parse_args()
    if asked.quick and asked.case:
        parser.error("--case picks from the whole comparison; expected it without --quick, perhaps with --small")
    asked.output.mkdir(parents=True, exist_ok=True)
    print(machine.words(), flush=True)
    wanted = cases.few() if asked.quick else cases.chosen(asked.case, cases.SIZES[:1] if asked.small else cases.SIZES)
    compared(asked.output, wanted, asked.quick)
    if not asked.quick and not asked.case:
        for table in (quality, jumps, adamson_alexa, switching, speed):
            print()
            table.main()
        window_figures()


def compared(folder: Path, wanted: Iterable[Case], quick: bool) -> None:
    """Jaart beside its peers, two threads beside one, and the goals; all saved into a folder."""
    print()
    rows = compare.rows_of(wanted, compare.QUICK if quick else compare.Effort())
    write_csv(rows, folder / "peers.csv")
    work_precision(rows).savefig(folder / "work_precision.svg")
    scaling.main(folder, repeats=3 if quick else scaling.REPEATS, small=quick)
    print("\n" + "\n".join(goals.lines(rows)))
    print(f"\nsaved: {', '.join(str(folder / name) for name in ('peers.csv', 'work_precision.svg', 'threads.csv'))}",
          flush=True)


def window_figures() -> None:
    """How quickly the window answers, where there is a display."""
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        print()
        from benchmarks import window

        window.main()
    else:
        print("\nthe window is measured where there is a display (xvfb-run -a make bench)")


if __name__ == "__main__":
    main()
