"""A case of the catalogue: an input that breaks a literal program, and what a person should get instead."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from jaart.core.errors import JaartError

#: Verdicts of a case.
HOLDS, DIFFERS, FAILED = "holds", "differs", "failed"


@dataclass(frozen=True)
class Outcome:
    """What came of a case.

    got: in words and figures; holds: whether it is what was expected.
    """

    got: str
    holds: bool


@dataclass(frozen=True)
class Result:
    """A row of the study's table: case, expected, got, verdict (holds, differs, or failed with an error)."""

    number: int
    name: str
    title: str
    expected: str
    got: str
    verdict: str


@dataclass(frozen=True)
class Case:
    """A row of the catalogue.

    number: of the row; name: for a test; title: the input; expected: what a person should get; run: does it, with a
    number of rays where the case takes many; rays: how many, in full and in a quick study.
    """

    number: int
    name: str
    title: str
    expected: str
    run: Callable[..., Outcome]
    rays: tuple[int, int] | None = None

    def outcome(self, quick: bool = False) -> Outcome:
        """Run the case."""
        return self.run() if self.rays is None else self.run(self.rays[quick])

    def result(self, quick: bool = False) -> Result:
        """The row of the table; a case that raises has failed, and the others go on."""
        try:
            outcome = self.outcome(quick)
            got, verdict = outcome.got, HOLDS if outcome.holds else DIFFERS
        except Exception as error:
            got, verdict = f"{type(error).__name__}: {error}", FAILED
        return Result(self.number, self.name, self.title, self.expected, got, verdict)


#: Every case by its number, in the order of the modules that declare them.
CASES: dict[int, Case] = {}


def case(number: int, title: str, expected: str,
         rays: tuple[int, int] | None = None) -> Callable[[Callable[..., Outcome]], Callable[..., Outcome]]:
    """Declare the function below as the case of a row; its name is the function's.

    rays: how many it is given, in full and in a quick study. Raises ValueError for a row that is there already.
    """
    def declare(run: Callable[..., Outcome]) -> Callable[..., Outcome]:
        if number in CASES:
            raise ValueError(f"case {number} is declared twice: {CASES[number].name} and {run.__name__}")
        CASES[number] = Case(number, run.__name__, title, expected, run, rays)
        return run

    return declare


def largest(*values: Any) -> float:
    """The largest of numbers and arrays; NaN where one of them is: what has no value must not pass for a small one."""
    return float(max((float(np.max(value)) for value in values), key=lambda one: (math.isnan(one), one)))


def counted(counts: Mapping[str, int]) -> str:
    """In words, how many rays ended in each state."""
    return ", ".join(f"{count} {name}" for name, count in counts.items())


def error_of(run: Callable[[], object]) -> str:
    """The message of the program's own error that a call ends in, "no error" without one."""
    try:
        run()
    except JaartError as error:
        return str(error)
    return "no error"


def refused(run: Callable[[], object], *words: str) -> Outcome:
    """The outcome of a call that must end in one clear error with these words in it."""
    message = error_of(run)
    return Outcome(message, all(word in message for word in words) and "\n" not in message)
