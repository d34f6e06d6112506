"""The rows of the comparison, as text and as CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path

#: Columns of the text: a field, its head, its width and its form.
COLUMNS = (("prep_s", "prep_s", 8, "s"), ("bvh_s", "bvh_s", 7, "s"), ("rays_s", "rays_s", 8, "s"),
           ("rays_least_s", "least", 8, "s"), ("rays_quartiles_s", "quart.", 7, "s"), ("first_s", "first_s", 8, "s"),
           ("embree_ratio", "/Embree", 7, ".2f"), ("error", "error", 8, ".3g"),
           ("evaluations_per_hit", "evals", 6, ".2f"), ("hits", "hits", 7, "d"), ("memory_mib", "MiB", 6, ".0f"),
           ("runs", "runs", 5, ""))


@dataclass(frozen=True, kw_only=True)
class Row:
    """What was measured of a program on a scene; None or empty where there is nothing to measure.

    prep_s: median seconds from loaded data to before the first ray, of prep_runs; bvh_s: of it the tree; rays_s,
    rays_least_s, rays_quartiles_s: median, least and interquartile range of rays_runs pictures with everything kept;
    first_s: the first picture, preparation and all; embree_ratio: rays_s to those of the first peer, in the same
    rounds; evaluations_per_hit: those of all rays; memory_mib: that the process grew by for the first picture.
    """

    scene: str
    size: str
    program: str
    prep_s: float | None = None
    prep_runs: int = 0
    bvh_s: float | None = None
    rays_s: float | None = None
    rays_least_s: float | None = None
    rays_quartiles_s: float | None = None
    rays_runs: int = 0
    first_s: float | None = None
    embree_ratio: float | None = None
    error: float | None = None
    error_of: str = ""
    evaluations_per_hit: float | None = None
    hits: int | None = None
    memory_mib: float | None = None
    note: str = ""

    @property
    def runs(self) -> str:
        """How often was measured: preparations, pictures."""
        return f"{self.prep_runs},{self.rays_runs}" if self.rays_runs else ""


def heading(scene: str, size: str, error_of: str) -> str:
    """The lines above a block of rows."""
    heads = " ".join(f"{head:>{width}}" for _, head, width, _ in COLUMNS)
    return f"{scene}{f', {size}' if size else ''}{f'; error: {error_of}' if error_of else ''}\n  {'program':24} {heads}"


def line(row: Row) -> str:
    """A row as text."""
    if row.rays_s is None:
        return f"  {row.program:24} {row.note}"
    cells = " ".join(f"{_cell(getattr(row, name), form):>{width}}" for name, _, width, form in COLUMNS)
    return f"  {row.program:24} {cells}{f'  {row.note}' if row.note else ''}"


def _cell(value: object, form: str) -> str:
    if value is None:
        return "-"
    if form == "s":
        return seconds(float(value))  # type: ignore[arg-type]
    return format(value, form)


def seconds(value: float) -> str:
    """Seconds, to a tenth of a millisecond where they are few."""
    return f"{value:.4f}" if value < 10 else f"{value:.1f}"


def write_csv(rows: Iterable[Row], path: Path) -> None:
    """All columns with their full names, empty cells for what was not measured."""
    names = [field.name for field in fields(Row)]
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(names)
        writer.writerows([getattr(row, name) for name in names] for row in rows)
