"""Jaart side by side with its peers: every contestant of every case in one run, taking turns.

A peer that is slow to prepare does so once or twice, its row says how often; rays are sent seven times.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from benchmarks.cases import Case
from benchmarks.contest import Absent, Contestant, First, Jaart, View
from benchmarks.footprint import peak
from benchmarks.table import Row, heading, line
from benchmarks.timing import Spread, in_turns, ratios
from jaart.core.records import Hits


@dataclass(frozen=True)
class Effort:
    """How often things are measured, and how many seconds a contestant may take for it at each picture."""

    repeats: int = 7
    prep_s: float = 4.0
    rays_s: float = 25.0


QUICK = Effort(3, 1.0, 1.0)


@dataclass
class Entry:
    """What is known of a contestant on a case: its first pictures, the memory of the very first, its failure."""

    contestant: Contestant
    firsts: list[First]
    memory: float | None = None
    failure: str = ""


def rows_of(cases: Iterable[Case], effort: Effort) -> list[Row]:
    """All rows, each block printed when it is done."""
    rows = []
    for case in cases:
        for block in blocks(case, effort):
            print("\n".join([heading(case.name, block[0].size, case.error_of), *map(line, block), ""]), flush=True)
            rows += block
    return rows


def blocks(case: Case, effort: Effort) -> Iterator[list[Row]]:
    """The rows of each picture of a case."""
    absent = [Row(scene=case.name, size="", program=c.name, note=c.why) for c in case.contestants
              if isinstance(c, Absent)]
    entries = [Entry(c, []) for c in case.contestants if not isinstance(c, Absent)]
    if not entries:
        yield absent
        return
    for number, view in enumerate(case.views):
        prepare(entries, view, effort, again=number > 0)
        yield [*measured(case, entries, view, effort), *absent]


def prepare(entries: list[Entry], view: View, effort: Effort, again: bool) -> None:
    """First pictures of a view; what is made for any view is made at the first one alone."""
    todo = [e for e in entries if not e.failure and (e.contestant.lazy or not again)]
    for entry in todo:
        entry.firsts = []
        if isinstance(entry.contestant, Jaart) and not again:
            entry.contestant.load_kernels(view)
    in_turns({e.contestant.name: lambda e=e: _first(e, view) for e in todo}, effort.repeats, effort.prep_s)


def _first(entry: Entry, view: View) -> None:
    """One more first picture; a peer that fails becomes a row that says so."""
    if entry.failure:
        return
    try:
        made, memory = peak(lambda: entry.contestant.first(view))
    except Exception as error:
        if isinstance(entry.contestant, Jaart):
            raise
        entry.failure = f"failed: {str(error).strip() or type(error).__name__}"
        return
    entry.memory = memory if entry.memory is None else entry.memory
    entry.firsts.append(made)


def measured(case: Case, entries: list[Entry], view: View, effort: Effort) -> list[Row]:
    """The rows of one picture: rays are sent in turns by all that are prepared."""
    pictures = in_turns({e.contestant.name: lambda e=e: e.firsts[-1].shoot(view) for e in entries if e.firsts},
                        effort.repeats, effort.rays_s)
    peers = [e.contestant.name for e in entries if e.firsts and not isinstance(e.contestant, Jaart)]
    against = [hits.ray_s for hits in pictures[peers[0]]] if peers else []
    return [row(case, entry, view, pictures.get(entry.contestant.name, []), against) for entry in entries]


def row(case: Case, entry: Entry, view: View, pictures: list[Hits], against: list[float]) -> Row:
    """What was measured of one contestant at one picture."""
    place = {"scene": case.name, "size": f"{view.size[0]}x{view.size[1]}", "program": entry.contestant.name}
    if not pictures:
        return Row(**place, note=entry.failure)
    hits, rays = pictures[-1], Spread(tuple(hits.ray_s for hits in pictures))
    prep = Spread(tuple(first.prep_s for first in entry.firsts))
    lazy, first = entry.contestant.lazy, entry.firsts[-1]
    picture = Spread(tuple(f.picture_s for f in entry.firsts)).median if lazy else prep.median + rays.median
    bvh = None if first.bvh_s is None else Spread(tuple(f.bvh_s for f in entry.firsts)).median
    ratio, met = ratios([h.ray_s for h in pictures], against), int(hits.hit.sum())
    return Row(**place, prep_s=prep.median, prep_runs=len(prep), bvh_s=bvh, rays_s=rays.median,
               rays_least_s=rays.least, rays_quartiles_s=rays.quartiles, rays_runs=len(rays), first_s=picture,
               embree_ratio=ratio.median if ratio else None, error=case.error(hits) if case.error else None,
               error_of=case.error_of, evaluations_per_hit=hits.evaluations.sum() / met if met and lazy else None,
               hits=met, memory_mib=entry.memory, note=first.note)
