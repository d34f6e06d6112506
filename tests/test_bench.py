"""What `make bench` runs, with small scenes: the rows, who is missing, and what is saved."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

import pytest

from benchmarks import cases, goals, scale
from benchmarks.compare import QUICK, rows_of
from benchmarks.contest import Absent, why_absent
from benchmarks.scale_table import Row as Size
from benchmarks.table import Row

ROOT = Path(__file__).resolve().parent.parent


def run(*arguments: str, folder: Path) -> str:
    """What a script of the benchmarks prints in a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-P", *arguments, "--output", str(folder)], cwd=ROOT, env=environment,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def read(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def drawn(path: Path) -> bool:
    return ElementTree.parse(path).getroot().tag.endswith("svg")


def test_a_quick_run_has_a_row_for_every_program_and_saves_its_tables(tmp_path: Path) -> None:
    printed = run("benchmarks/run.py", "--quick", folder=tmp_path)
    rows = read(tmp_path / "peers.csv")
    assert {row["scene"] for row in rows} == {"standard 16^3", "standard 32^3", "bumpy 2,000"}
    for row in rows:
        assert bool(row["rays_s"]) != (not row["prep_s"])
        assert row["rays_s"] or row["note"], row
        assert row["program"] in printed
    ours = {(row["scene"], row["program"]): row for row in rows if row["program"].startswith("Jaart")}
    assert len(ours) == 5
    assert all(int(row["hits"]) > 700 and float(row["error"]) < 0.2 for row in ours.values())
    assert float(ours["standard 32^3", "Jaart, best"]["error"]) < float(ours["standard 16^3", "Jaart, best"]["error"])
    peers = {row["program"] for row in rows} - {program for _, program in ours}
    assert peers == {"marching cubes + Embree", "ball pivoting + Embree", "Poisson + Embree", "APSS + Embree"}
    assert [row["work"] for row in read(tmp_path / "threads.csv")][1:] == ["standard, thesis", "standard, best",
                                                                          "splash, best"]
    assert drawn(tmp_path / "work_precision.svg")


def test_a_library_that_is_not_installed_is_named() -> None:
    assert why_absent("jaart", "jaart_has_no_such_peer") == "jaart_has_no_such_peer is not installed"
    assert why_absent("numpy") == ""


def test_a_scan_that_is_not_there_is_a_row_that_says_where_it_was_looked_for() -> None:
    (row,) = rows_of([cases.scanned("no such cloud", ())], QUICK)
    assert (row.scene, row.program) == ("no such cloud", "every program") and "JAART_DATA" in row.note


def test_a_program_that_cannot_run_is_a_row_that_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    case = cases.Case("nothing", (Absent("a mesher", "it is not installed"),), ())
    (row,) = rows_of([case], QUICK)
    assert (row.program, row.note, row.rays_s) == ("a mesher", "it is not installed", None)
    assert "it is not installed" in capsys.readouterr().out


@pytest.mark.parametrize(("name", "scenes"), [(["standard 16^3"], ["standard 16^3"]), (["splash"], ["splash"])])
def test_a_named_case_is_made_alone(name: list[str], scenes: list[str]) -> None:
    assert [case.name for case in cases.chosen(name, (cases.SMALL,))] == scenes


def lattice_rows(thesis: float, best: float) -> list[Row]:
    place = {"scene": "standard 64^3", "size": "512x512", "rays_s": 1.0}
    return [Row(**place, program="Jaart, thesis", embree_ratio=thesis, error=0.045),
            Row(**place, program="Jaart, best", embree_ratio=best, error=0.012),
            Row(**place, program="marching cubes + Embree", embree_ratio=1.0, error=0.06)]


def test_goals_are_read_off_the_rows() -> None:
    place = {"scene": "bumpy 67,038", "size": "512x512", "rays_s": 1.0}
    clouds = [Row(**place, program="Jaart, best", first_s=0.5, hits=1000),
              Row(**place, program="ball with holes", first_s=1.0, hits=900),
              Row(**place, program="whole", first_s=6.0, hits=1000)]
    text = "\n".join(goals.lines([*lattice_rows(1.2, 2.5), *clouds]))
    assert "thesis: rays 1.20 times those of Embree, at most 1.3 wanted; delta 0.75" in text
    assert "best: rays 2.50 times" in text and "delta 0.20" in text
    assert "first picture 12.00 times as soon as with whole" in text


def sizes(printed: str, kind: str) -> Sequence[str]:
    return [line for line in printed.splitlines() if line.startswith(f"  {kind} ")]


def test_scale_measures_each_size_and_saves(tmp_path: Path) -> None:
    arguments = ("--lattices", "16", "--clouds", "1000", "2000", "--size", "32", "32")
    printed = run("-m", "benchmarks.scale", *arguments, folder=tmp_path)
    rows = read(tmp_path / "scale.csv")
    assert [(row["kind"], row["size"], row["note"]) for row in rows] == [
        ("lattice", "16", ""), ("cloud", "1000", ""), ("cloud", "2000", "")]
    assert [int(row["data_bytes"]) for row in rows] == [8 * 16**3, 24 * 1000, 24 * 2000]
    for row in rows:
        named = dict(pair.split("=") for pair in row["arrays"].split(";"))
        whole = int(row["array_bytes"]) / int(row["items"])
        assert 0.95 * whole <= sum(map(float, named.values())) <= 1.05 * whole
        assert int(row["touched"]) > 0 and int(row["hits"]) > 0
    assert len(sizes(printed, "cloud")) == 2 + 1  # the rows, and the arrays of the largest
    assert drawn(tmp_path / "scale.svg")


def test_a_size_that_would_not_fit_is_not_tried() -> None:
    measured = Size(kind="cloud", size=1000, data_bytes=24_000, items=1000, peak_bytes=300_000.0)
    row = scale.row_of("cloud", 10**15, (32, 32), [measured])
    if scale.available() is None:
        pytest.skip("this system does not say how much memory is free")
    assert row.items is None and row.note.startswith("not tried: would need some 288 PiB")
