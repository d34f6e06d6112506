"""Jaart side by side with its peers: every contestant of every case in one run, taking turns.

A peer that is slow to prepare does so once or twice, its row says how often; rays are sent seven times.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

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
    """What is known of a contestant on a case: seconds of its first pictures, memory of the very first, its failure.

    first, last: its newest first picture and newest picture; older ones are let go before the next is made, so that no
    program's next picture pays for memory that nobody has entered before.
    """

    contestant: Contestant
    prep_s: list[float] = field(default_factory=list)
    bvh_s: list[float] = field(default_factory=list)
    picture_s: list[float] = field(default_factory=list)
    first: First | None = None
    last: Hits | None = None
    memory: float | None = None
    failure: str = ""

    def prepare(self, view: View) -> None:
        """One more first picture; a peer that fails becomes a row that says so."""
        self.first = None
        made, memory = peak(lambda: self.contestant.first(view))
        self.memory = memory if self.memory is None else self.memory
        self.first = made
        self.prep_s.append(made.prep_s)
        self.picture_s.append(made.picture_s)
        if made.bvh_s is not None:
            self.bvh_s.append(made.bvh_s)

    def shoot(self, view: View) -> float:
        """Seconds of one more picture with what is prepared."""
        assert self.first is not None
        self.last = None
        self.last = self.first.shoot(view)
        return self.last.ray_s

    def forget(self) -> None:
        """Begin anew with another picture."""
        self.prep_s, self.bvh_s, self.picture_s, self.first = [], [], [], None


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
    entries = [Entry(c) for c in case.contestants if not isinstance(c, Absent)]
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
        entry.forget()
        if isinstance(entry.contestant, Jaart) and not again:
            entry.contestant.load_kernels(view)
    in_turns({e.contestant.name: lambda e=e: _first(e, view) for e in todo}, effort.repeats, effort.prep_s)


def _first(entry: Entry, view: View) -> None:
    """One more first picture; a peer that fails becomes a row that says so."""
    if entry.failure:
        return
    try:
        entry.prepare(view)
    except Exception as error:
        if isinstance(entry.contestant, Jaart):
            raise
        entry.failure = f"failed: {str(error).strip() or type(error).__name__}"


def measured(case: Case, entries: list[Entry], view: View, effort: Effort) -> list[Row]:
    """The rows of one picture: rays are sent in turns by all that are prepared."""
    pictures = in_turns({e.contestant.name: lambda e=e: e.shoot(view) for e in entries if e.first},
                        effort.repeats, effort.rays_s)
    peers = [e.contestant.name for e in entries if e.first and not isinstance(e.contestant, Jaart)]
    against = pictures[peers[0]] if peers else []
    return [row(case, entry, view, pictures.get(entry.contestant.name, []), against) for entry in entries]


def row(case: Case, entry: Entry, view: View, seconds: list[float], against: list[float]) -> Row:
    """What was measured of one contestant at one picture."""
    place = {"scene": case.name, "size": f"{view.size[0]}x{view.size[1]}", "program": entry.contestant.name}
    hits, first = entry.last, entry.first
    if hits is None or first is None:
        return Row(**place, note=entry.failure)
    rays, prep, lazy = Spread(tuple(seconds)), Spread(tuple(entry.prep_s)), entry.contestant.lazy
    picture = Spread(tuple(entry.picture_s)).median if lazy else prep.median + rays.median
    bvh = Spread(tuple(entry.bvh_s)).median if entry.bvh_s else None
    ratio, met = ratios(seconds, against), int(hits.hit.sum())
    return Row(**place, prep_s=prep.median, prep_runs=len(prep), bvh_s=bvh, rays_s=rays.median,
               rays_least_s=rays.least, rays_quartiles_s=rays.quartiles, rays_runs=len(rays), first_s=picture,
               embree_ratio=ratio.median if ratio else None, error=case.error(hits) if case.error else None,
               error_of=case.error_of, evaluations_per_hit=hits.evaluations.sum() / met if met and lazy else None,
               hits=met, memory_mib=entry.memory, note=first.note)
