"""Cost against size: the rows of the table, as text, as CSV and what they say together."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path

#: Bytes that a point or an interface cell may keep, and that a touched cell or ball may.
KEEP, TOUCHED = 300, 4096
#: Columns of the text: head, width, form and the value of a row.
COLUMNS = (("items", 10, ",d", "items"), ("prep_s", 8, ".3f", "prep_s"), ("peak B", 8, ".0f", "peak_each"),
           ("kept B", 8, ".0f", "kept_each"), ("arrays B", 8, ".0f", "arrays_each"), ("touched", 9, ",d", "touched"),
           ("B each", 7, ".0f", "touched_each"), ("first_s", 8, ".2f", "first_s"), ("us/ray", 7, ".2f", "ray_us"),
           ("hits", 7, "d", "hits"), ("GiB", 6, ".2f", "whole_gib"))


@dataclass(frozen=True, kw_only=True)
class Row:
    """What was measured of one size; None where it was not, and note says why.

    kind, size: "lattice" of size^3 cells or "cloud" of size points; data_bytes: of the levels or points themselves,
    beyond which all other bytes are; items: interface cells or points; prep_s: one preparation with the choice of
    settings, kernels loaded before; peak_bytes: that the process grew by at most meanwhile; kept_bytes: that it is
    larger by after it; array_bytes: of the arrays that the scene keeps then, the named ones in arrays, bytes an item;
    first_s: preparation and the first picture; ray_us: a ray with everything kept, median of pictures; evaluations: of
    a hit in the first picture; touched, touched_bytes: cells or balls with neighbours written down, and these;
    whole_bytes: the most that the process held, from the preparation to the last picture.
    """

    kind: str
    size: int
    data_bytes: int = 0
    items: int | None = None
    prep_s: float | None = None
    peak_bytes: float | None = None
    kept_bytes: int | None = None
    array_bytes: int | None = None
    first_s: float | None = None
    ray_us: float | None = None
    evaluations: float | None = None
    hits: int | None = None
    touched: int | None = None
    touched_bytes: int | None = None
    whole_bytes: int | None = None
    arrays: dict[str, float] = field(default_factory=dict)
    note: str = ""

    @property
    def name(self) -> str:
        return f"lattice {self.size}^3" if self.kind == "lattice" else f"cloud {self.size:,}"

    @property
    def peak_each(self) -> float | None:
        return self._each(self.peak_bytes)

    @property
    def kept_each(self) -> float | None:
        return self._each(self.kept_bytes)

    @property
    def arrays_each(self) -> float | None:
        return self._each(self.array_bytes)

    @property
    def touched_each(self) -> float | None:
        return None if not self.touched else (self.touched_bytes or 0) / self.touched

    @property
    def whole_gib(self) -> float | None:
        return None if self.whole_bytes is None else self.whole_bytes / 2**30

    def _each(self, count: float | None) -> float | None:
        return None if count is None or not self.items else count / self.items


def heading() -> str:
    return f"  {'':18}" + " ".join(f"{head:>{width}}" for head, width, _, _ in COLUMNS)


def line(row: Row) -> str:
    """A row as text."""
    if row.note:
        return f"  {row.name:18}{row.note}"
    values = ((getattr(row, name), width, form) for _, width, form, name in COLUMNS)
    return f"  {row.name:18}" + " ".join(f"{'-' if v is None else format(v, form):>{w}}" for v, w, form in values)


def summary(rows: Sequence[Row]) -> list[str]:
    """From the smallest to the largest size of each kind, and the arrays of the largest."""
    found = []
    for kind in ("lattice", "cloud"):
        own = [row for row in rows if row.kind == kind and row.items]
        if len(own) > 1:
            found.append(f"  {kind}: " + growth(own[0], own[-1]))
        if own:
            largest = ", ".join(f"{name} {each:g}" for name, each in own[-1].arrays.items())
            found.append(f"  {own[-1].name}, bytes an item: {largest}")
    return found


def growth(small: Row, large: Row) -> str:
    """How the costs grew between two sizes, items^p for preparation, beside log n for rays."""
    power = math.log(large.prep_s / small.prep_s) / math.log(large.items / small.items)
    logs = math.log(large.items) / math.log(small.items)
    return (f"preparation grows as items^{power:.2f} (1 wanted); a ray takes {large.ray_us / small.ray_us:.2f} times "
            f"as long, log n is {logs:.2f} times as large (less wanted)")


def write_csv(rows: Sequence[Row], path: Path) -> None:
    """All fields with their full names; arrays as name=bytes, parted by semicolons."""
    names = [f.name for f in fields(Row)]
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(names)
        writer.writerows([_plain(getattr(row, name)) for name in names] for row in rows)


def _plain(value: object) -> object:
    return ";".join(f"{k}={v:g}" for k, v in value.items()) if isinstance(value, dict) else value
