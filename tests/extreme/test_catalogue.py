"""Every row of the catalogue of stiff and extreme cases, run through the program as `jaart study stability` does.

What a row expects, and where its statement is judged wrong and why, stands at the case itself
(jaart/core/study/stability).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core.study.stability.case import CASES, FAILED, HOLDS, Case, Outcome, case, largest, refused
from jaart.core.study.stability.study import as_csv, as_markdown, cases


@pytest.mark.parametrize("one", [pytest.param(one, id=f"row_{one.number:02d}_{one.name}") for one in cases()])
def test_the_program_gives_what_the_row_expects(one: Case) -> None:
    outcome = one.outcome(quick=True)
    assert outcome.holds, f"{one.title}: expected {one.expected}, got {outcome.got}"


def test_every_row_has_its_case() -> None:
    assert sorted(CASES) == list(range(1, 75))
    assert len({one.name for one in cases()}) == 74


def test_a_row_cannot_be_declared_twice() -> None:
    with pytest.raises(ValueError, match="case 1 is declared twice"):
        case(1, "again", "nothing")(lambda: Outcome("", True))


def test_a_case_that_raises_has_failed_and_one_that_differs_says_so() -> None:
    def broken() -> Outcome:
        raise ZeroDivisionError("by nothing")

    result = Case(99, "broken", "an input", "no error", broken).result()
    assert (result.verdict, result.got) == (FAILED, "ZeroDivisionError: by nothing")
    differing = Case(98, "differing", "an input", "0", lambda: Outcome("1 | 2", False)).result()
    assert differing.verdict == "differs"
    assert "0 of 2 hold" in as_markdown((result, differing)) and "1 \\| 2" in as_markdown((result, differing))
    assert as_csv((differing,)).splitlines()[1] == "98,differing,an input,0,1 | 2,differs"


def test_the_largest_of_numbers_is_nan_where_one_is() -> None:
    assert largest(1.0, [2.0, 3.0], np.array([[0.5]])) == 3.0
    for place in range(3):
        values = [1.0, 2.0, 3.0]
        values[place] = math.nan
        assert math.isnan(largest(values)) and math.isnan(largest(*values))


def test_what_is_not_refused_does_not_hold() -> None:
    assert not refused(lambda: None, "anything").holds
    assert Case(97, "open", "an input", "an error", lambda: refused(lambda: 1, "h")).result().verdict != HOLDS
