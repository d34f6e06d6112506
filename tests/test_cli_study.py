"""The command that lets the program examine itself."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from jaart.__main__ import main
from jaart.cli_study import _lines
from jaart.core.study.stability.case import Case, Outcome, counted


def test_the_table_is_printed_and_saved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "stability", "--quick", "--output", str(tmp_path / "made")]) == 0
    out = capsys.readouterr().out
    assert out.count("expected  ") == out.count("got       ") == 74 and "74 of 74 cases hold" in out
    with (tmp_path / "made" / "stability.csv").open(encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["case", "name", "input", "expected", "got", "verdict"]
    assert [row[0] for row in rows[1:]] == [str(n) for n in range(1, 75)] and {row[5] for row in rows[1:]} == {"holds"}
    assert (tmp_path / "made" / "stability.md").read_text(encoding="utf-8").startswith("# Stiff and extreme cases: 74")


def test_a_case_says_what_was_expected_and_what_came() -> None:
    got = counted({"background": 256, "converged": 1})
    for holds, verdict in ((True, "holds"), (False, "differs")):
        first, expected, came = _lines(Case(55, "name", "an input", "a hit", lambda h=holds: Outcome(
            got, h)).result()).splitlines()
        assert first.split() == ["55", verdict, "an", "input"]
        assert expected.split() == ["expected", "a", "hit"]
        assert came.strip() == "got       256 background, 1 converged"


@pytest.mark.parametrize(("name", "output", "status", "says"), [
    ("work", "new", 2, "expected stability"), ("stability", "file", 1, "is a file; expected a folder")])
def test_what_cannot_be_studied_is_said_before_any_work(name: str, output: str, status: int, says: str, tmp_path: Path,
                                                        capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").touch()
    assert main(["study", name, "--output", str(tmp_path / output)]) == status
    assert says in capsys.readouterr().err and not (tmp_path / "new").exists()
