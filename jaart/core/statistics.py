"""Numbers that describe a whole picture: ends of its rays, histograms, errors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core.records import Hits, Quality

Array = NDArray[np.float64]
Row = tuple[str, str, float | int | str]


@dataclass(frozen=True, eq=False)
class Histogram:
    """How many rays have each whole number: values (K,) without gaps from 1, counts (K,), and their mean."""

    values: NDArray[np.int64]
    counts: NDArray[np.int64]
    mean: float

    @property
    def rays(self) -> int:
        """How many rays were counted."""
        return int(self.counts.sum())

    def shares(self, width: int = 1, bars: int = 20) -> tuple[list[str], Array]:
        """Bars of so many values each: names and shares in percent; the last takes all above [T fig. 2.26]."""
        counts = np.zeros(bars)
        np.add.at(counts, np.minimum((self.values - 1) // width, bars - 1), self.counts)
        used = max(1, int(np.flatnonzero(counts)[-1]) + 1) if self.rays else 0
        first = [1 + bar * width for bar in range(used)]
        names = [str(n) if width == 1 else f"{n}–{n + width - 1}" for n in first]
        if used == bars and self.values[-1] > bars * width:
            names[-1] = f"{first[-1]}+"
        return names, 100.0 * counts[:used] / max(1, self.rays)


@dataclass(frozen=True, eq=False)
class Statistics:
    """One picture in numbers.

    rays, hits: counts; status: rays by end state; iterations: steps of the start that hit, of the rays
    that hit; evaluations: of all starts, of the rays that evaluated anything; cells: cells
    or balls visited, of the rays that visited any; neighbours: surfels an evaluation, on average (NaN without
    one); prep_s, ray_s: wall seconds; quality: errors against the exact surface if known; lowered: evaluations whose
    polynomial has fewer degrees than asked for; starts, eigenvectors, gradients, gathered, fits: as of Hits, summed.
    """

    rays: int
    hits: int
    status: dict[str, int]
    iterations: Histogram
    evaluations: Histogram
    cells: Histogram
    neighbours: float
    prep_s: float
    ray_s: float
    quality: Quality | None = None
    lowered: int = 0
    starts: int = 0
    eigenvectors: int = 0
    gradients: int = 0
    gathered: int = 0
    fits: int = 0


def statistics(hits: Hits, quality: Quality | None = None) -> Statistics:
    """The statistics of a picture or a list of rays."""
    evaluations = int(hits.evaluations.sum())
    return Statistics(
        rays=len(hits), hits=int(hits.hit.sum()), status=hits.counts(),
        iterations=_histogram(hits.iterations[hits.hit]), evaluations=_histogram(hits.evaluations),
        cells=_histogram(hits.cells), prep_s=hits.prep_s, ray_s=hits.ray_s, quality=quality,
        lowered=int(hits.lowered.sum()), starts=int(hits.starts.sum()), gathered=hits.gathered, fits=hits.fits,
        eigenvectors=int(hits.eigenvectors.sum()), gradients=int(hits.gradients.sum()),
        neighbours=float(hits.neighbours.sum()) / evaluations if evaluations else float("nan"))


def table(statistics: Statistics) -> list[Row]:
    """Rows (statistic, bin, value) for CSV, the header first; bins are end states or whole numbers.

    A value that is not defined, such as a mean or an error of no ray, is an empty text.
    """
    s = statistics
    rows: list[Row] = [("statistic", "bin", "value"), ("rays", "", s.rays), ("hits", "", s.hits),
                       ("mean iterations", "", s.iterations.mean), ("mean evaluations", "", s.evaluations.mean),
                       ("mean cells", "", s.cells.mean), ("mean neighbours", "", s.neighbours),
                       ("evaluations of a lower degree", "", s.lowered),
                       ("searches begun", "", s.starts), ("eigenvectors", "", s.eigenvectors),
                       ("gradients", "", s.gradients), ("places gathered", "", s.gathered),
                       ("fits at centres", "", s.fits), ("preparation [s]", "", s.prep_s), ("rays [s]", "", s.ray_s)]
    rows += [("end state", name, count) for name, count in s.status.items()]
    for name in ("iterations", "evaluations", "cells"):
        histogram: Histogram = getattr(s, name)
        rows += [(name, str(value), int(count))
                 for value, count in zip(histogram.values, histogram.counts, strict=True)]
    return [(name, bin, "" if isinstance(value, float) and math.isnan(value) else value)
            for name, bin, value in rows + _errors(s.quality)]


def _errors(quality: Quality | None) -> list[Row]:
    names = ("delta", "delta_p", "delta_n", "relevant", "false_hit", "false_miss", "distance_miss")
    return [] if quality is None else [(name, "", getattr(quality, name)) for name in names]


def _histogram(numbers: NDArray[np.int32]) -> Histogram:
    above = numbers[numbers > 0]
    if not len(above):
        return Histogram(np.empty(0, np.int64), np.empty(0, np.int64), float("nan"))
    counts = np.bincount(above)[1:]
    return Histogram(np.arange(1, len(counts) + 1), counts, float(above.mean()))
