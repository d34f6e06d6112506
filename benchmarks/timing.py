"""Wall seconds, and contestants that take turns: noise of the machine falls on all of them alike."""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

#: What every program may take.
THREADS = os.cpu_count() or 1
#: How often a thing is measured.
REPEATS = 7

T = TypeVar("T")


@dataclass(frozen=True)
class Spread:
    """What repeated measurements came to."""

    values: tuple[float, ...]

    @property
    def median(self) -> float:
        return statistics.median(self.values)

    @property
    def least(self) -> float:
        return min(self.values)

    @property
    def quartiles(self) -> float:
        """The interquartile range, 0 for a single value."""
        if len(self.values) < 2:
            return 0.0
        low, _, high = statistics.quantiles(self.values, n=4, method="inclusive")
        return high - low

    def __len__(self) -> int:
        return len(self.values)

    def __str__(self) -> str:
        return f"median {self.median:.3g}, least {self.least:.3g}, quartiles {self.quartiles:.2g} apart, of {len(self)}"


def timed(work: Callable[[], object]) -> float:
    """Seconds that some work takes."""
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def in_turns(works: Mapping[str, Callable[[], T]], most: int, seconds: float) -> dict[str, list[T]]:
    """What each work gave, in rounds of one call of each.

    A work is called once, and up to `most` times until its calls have taken so many seconds: a slow one drops out.
    """
    given: dict[str, list[T]] = {name: [] for name in works}
    spent = dict.fromkeys(works, 0.0)
    for _ in range(most):
        for name, work in works.items():
            if not given[name] or spent[name] < seconds:
                spent[name] += timed(lambda name=name, work=work: given[name].append(work()))
    return given


def ratios(some: Sequence[float], others: Sequence[float]) -> Spread | None:
    """Seconds over those of another in the same round, None where no round has both."""
    both = tuple(a / b for a, b in zip(some, others, strict=False))
    return Spread(both) if both else None
