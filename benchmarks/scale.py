"""Cost against size: lattices and clouds from small to huge, each in a process of its own; a table, CSV and SVG.

`python -m benchmarks.scale --lattices 64 128 --clouds 100000 1000000` is a short run. What the sizes measured before
say would not fit into the memory that is free is a row that says so, and is not tried.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks import machine
from benchmarks.scale_plot import cost
from benchmarks.scale_table import KEEP, TOUCHED, Row, heading, line, summary, write_csv
from jaart.core.memory import words

LATTICES = (64, 128, 256, 512)
CLOUDS = (100_000, 1_000_000, 3_000_000, 10_000_000)
ROOT = Path(__file__).resolve().parent.parent


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Print what scenes of growing size cost.")
    parser.add_argument("--lattices", type=int, nargs="*", default=LATTICES, help="cells along an edge, rising")
    parser.add_argument("--clouds", type=int, nargs="*", default=CLOUDS, help="points, rising")
    parser.add_argument("--size", type=int, nargs=2, default=(512, 512), help="width and height of the pictures")
    parser.add_argument("--output", type=Path, default=Path("out/bench"), help="folder for CSV and SVG")
    asked = parser.parse_args(arguments)
    asked.output.mkdir(parents=True, exist_ok=True)
    print(f"{machine.words()}\nbytes an item beyond the data themselves, an item is an interface cell or a point: at "
          f"most {KEEP} kept wanted, and {TOUCHED} for each touched cell or ball\n{heading()}", flush=True)
    rows: list[Row] = []
    for kind, sizes in (("lattice", asked.lattices), ("cloud", asked.clouds)):
        for size in sizes:
            rows.append(row_of(kind, size, asked.size, rows))
            print(line(rows[-1]), flush=True)
    print("\n".join(summary(rows)))
    write_csv(rows, asked.output / "scale.csv")
    cost(rows).savefig(asked.output / "scale.svg")
    print(f"saved: {asked.output / 'scale.csv'}, {asked.output / 'scale.svg'}")


def row_of(kind: str, size: int, picture: Sequence[int], before: Sequence[Row]) -> Row:
    """The row of one size, measured where it is expected to fit."""
    need, free = expected(kind, size, before), available()
    if need is not None and free is not None and need > free:
        return Row(kind=kind, size=size, note=f"not tried: would need some {words(need)}, {words(free)} are free")
    command = [sys.executable, "-P", "-m", "benchmarks.scale_one", kind, str(size), *map(str, picture)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or [f"ended by signal {-done.returncode}"])[-1]
        return Row(kind=kind, size=size, note=f"failed: {last}")
    return Row(**json.loads(done.stdout.splitlines()[-1]))


def expected(kind: str, size: int, before: Sequence[Row]) -> float | None:
    """Bytes that a size will need; None where nothing smaller was measured.

    The peak of the preparation grows as the data do; what pictures take is counted once more as it was.
    """
    known = [row for row in before if row.kind == kind and row.peak_bytes is not None]
    if not known:
        return None
    times = (size / known[-1].size) ** (3 if kind == "lattice" else 1)
    return times * (known[-1].data_bytes + known[-1].peak_bytes) + (known[-1].whole_bytes or 0)


def available() -> float | None:
    """Bytes of memory that are free for a process, None where nobody knows."""
    try:
        found = re.search(r"^MemAvailable:\s+(\d+) kB", Path("/proc/meminfo").read_text(encoding="utf-8"), flags=re.M)
    except OSError:
        return None
    return None if found is None else 1024.0 * int(found[1])


if __name__ == "__main__":
    main()
