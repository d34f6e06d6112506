"""All cases in the order of their rows, and their table in files."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from threading import Event

from jaart.core.errors import Cancelled
from jaart.core.io.atomic import replacing
from jaart.core.study.stability.case import CASES, HOLDS, Case, Result

#: The modules that declare the cases.
MODULES = ("far", "shrinkage", "sheets", "degenerate", "scales", "weights", "rays", "walks", "silhouettes", "optics",
           "stopping", "lattices", "fills", "options", "measures", "machine")
COLUMNS = ("case", "name", "input", "expected", "got", "verdict")


def cases() -> tuple[Case, ...]:
    """Every case, by its number."""
    for name in MODULES:
        import_module(f"jaart.core.study.stability.{name}")
    return tuple(CASES[number] for number in sorted(CASES))


def stability(quick: bool = False, progress: Callable[[int, int], None] | None = None,
              cancel: Event | None = None) -> tuple[Result, ...]:
    """Run every stiff and extreme case.

    quick: fewer rays where a case takes many; progress(done, all cases); cancel: set it to stop. Raises Cancelled.
    """
    todo, results = cases(), []
    for done, one in enumerate(todo):
        if cancel is not None and cancel.is_set():
            raise Cancelled("the study was cancelled")
        results.append(one.result(quick))
        if progress:
            progress(done + 1, len(todo))
    return tuple(results)


def holding(results: tuple[Result, ...]) -> int:
    """How many cases hold."""
    return sum(result.verdict == HOLDS for result in results)


def rows(results: tuple[Result, ...]) -> list[tuple[str, ...]]:
    """The table's rows under COLUMNS."""
    return [(str(r.number), r.name, r.title, r.expected, r.got, r.verdict) for r in results]


def as_csv(results: tuple[Result, ...]) -> str:
    """The table as comma-separated values."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(rows(results))
    return text.getvalue()


def as_markdown(results: tuple[Result, ...]) -> str:
    """The table for people."""
    def line(cells: tuple[str, ...]) -> str:
        return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

    shown = [(r.number, r.title, r.expected, r.got, r.verdict) for r in results]
    head = [f"# Stiff and extreme cases: {holding(results)} of {len(results)} hold", "",
            line(("case", "input", "expected", "got", "verdict")), "|---" * 5 + "|"]
    return "\n".join([*head, *(line((str(n), *texts)) for n, *texts in shown)]) + "\n"


def save(results: tuple[Result, ...], folder: Path) -> tuple[Path, ...]:
    """Write the table as stability.csv and stability.md into a folder, which is made when absent."""
    folder.mkdir(parents=True, exist_ok=True)
    files = {folder / "stability.csv": as_csv(results), folder / "stability.md": as_markdown(results)}
    for path, text in files.items():
        with replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
    return tuple(files)
