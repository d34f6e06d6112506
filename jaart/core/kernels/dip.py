"""Whether a ray passes by the surface: f falls towards 0 along it and rises again on the same side."""

from __future__ import annotations

from math import inf, nan
from typing import NamedTuple

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Rule, Search

#: Of the least |f| that was found so much is to be left at the lowest place of the parabola.
_LEFT = 0.5


class Dip(NamedTuple):
    """Where |f| was least, and the nearest places before and behind that were looked at: each s with its f.

    NaN where there is none yet; f is infinite then.
    """

    s: float
    f: float
    before: float
    f_before: float
    behind: float
    f_behind: float


@kernel(STRICT, inline=True)
def nothing_known() -> Dip:
    """The dip before the first look."""
    return Dip(nan, inf, nan, nan, nan, nan)


@kernel(STRICT, inline=True)
def tells_sides(how: Search, rule: Rule) -> bool:
    """Whether a search is for a root of f, whose sign says on which side of the surface a place is."""
    return how.kind != r.ITERATE and (rule.normal == r.SURFEL or rule.oriented == 1)


@kernel(STRICT)
def with_look(dip: Dip, s: float, f: float) -> Dip:
    """The dip with f known at one more place."""
    deeper = abs(f) < abs(dip.f)
    least, f_least = (s, f) if deeper else (dip.s, dip.f)
    other, f_other = (dip.s, dip.f) if deeper else (s, f)
    before = f_before = behind = f_behind = nan
    for place, value in ((dip.before, dip.f_before), (dip.behind, dip.f_behind), (other, f_other)):
        if place < least and not place <= before:
            before, f_before = place, value
        if place > least and not place >= behind:
            behind, f_behind = place, value
    return Dip(least, f_least, before, f_before, behind, f_behind)


@kernel(STRICT)
def passes_by(dip: Dip) -> bool:
    """Whether all three places are on one side, and with them, by far, the parabola through their f."""
    if not (dip.f_before * dip.f > 0.0 and dip.f_behind * dip.f > 0.0):
        return False
    falling = (dip.f - dip.f_before) / (dip.s - dip.before)
    rising = (dip.f_behind - dip.f) / (dip.behind - dip.s)
    bend = (rising - falling) / (dip.behind - dip.before)
    slope = falling + bend * (dip.s - dip.before)
    return (dip.f - slope * slope / (4.0 * bend)) / dip.f > _LEFT
