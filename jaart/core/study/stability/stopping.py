"""Rows 50 to 52: tolerances beyond the floor, too few steps, lists too short."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np

from jaart.core.chosen import chosen
from jaart.core.records import STATUS, Hits
from jaart.core.samples import fibonacci
from jaart.core.scene import Array, Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.study.stability.case import Outcome, case, largest
from jaart.core.study.stability.scenes import shot
from jaart.core.trace import trace

#: Middle of the ball's lattice.
MIDDLE = 8.0
#: Feature size in cells, as where nobody says.
H = 0.8
#: Tolerances, in h, from that of the default settings to the floor.
TOLERANCES = (0.125, 1e-3, 1e-6, 1e-9, 1e-12)


@case(50, "tolerance 0 and 1e-300", "a hit at the precision floor: status floor and a residual of some 1e-14 h",
      rays=(2000, 200))
def tolerance_beyond_the_floor(rays: int) -> Outcome:
    """With 1e-300 a step of exactly 0, or an f of exactly 0, has arrived, and says so; with 0 none has."""
    floor, arrived, worst = 0, 0, 0.0
    for search in ("iterate", "secant", "newton", "safe"):
        for tolerance in (0.0, 1e-300):
            hits = _towards_the_middle(rays, Settings(search=search, tolerance=tolerance, max_iterations=50))
            exact = (hits.status == STATUS["converged"]) & (hits.energy == 0.0) & (tolerance > 0)
            floor, arrived = floor + int((hits.status == STATUS["floor"]).sum()), arrived + int(exact.sum())
            worst = largest(worst, hits.energy / H)
    return Outcome(f"{floor} floor, {arrived} arrived by a step of 0, of {8 * rays} rays; residual up to {worst:.1e} h",
                   floor + arrived == 8 * rays and floor >= 4 * rays and worst <= 1e-13)


@case(51, "one iteration a start is allowed", "status cap for every ray, with its residual", rays=(2000, 200))
def a_cap_of_one_step(rays: int) -> Outcome:
    """The residual is the step that was left to do; no hit is made up."""
    hits = _towards_the_middle(rays, Settings(max_iterations=1, tolerance=1e-9))
    capped, known = int((hits.status == STATUS["cap"]).sum()), int(np.isfinite(hits.energy).sum())
    return Outcome(f"{capped} of {rays} cap, {known} with a residual, {hits.energy.min():.1e} to "
                   f"{hits.energy.max():.1e} cells; {int(hits.hit.sum())} hits",
                   capped == known == rays and not hits.hit.any() and bool(np.isnan(hits.t).all()))


@case(52, "lists of surfels that end at a radius, where h is 0.8 cells",
      "f jumps at cell faces, the less the larger the radius; where nobody says how large, no jump exceeds the "
      "tolerance", rays=(100, 20))
def lists_that_are_too_short(rays: int) -> Outcome:
    """The radius that `auto` stands for is h √(ln 10/τ) and half a cell's diagonal for τ below 0.01, else 3.125 h.

    The row has 1 for 10, with which f may jump by more than the tolerance.
    """
    fixed = [_jump(rays, Settings(radius=str(radius))) for radius in (2, 3, 4, 6)]
    auto = [_jump(rays, Settings(tolerance=tolerance)) for tolerance in TOLERANCES]
    radii = [chosen(_ball(), Settings(tolerance=tolerance)).radius for tolerance in TOLERANCES]
    falls = all(a > 10 * b for a, b in pairwise(fixed)) and fixed[-1] < 1e-14
    return Outcome("radius 2, 3, 4, 6: " + ", ".join(f"{jump:.0e}" for jump in fixed) + " h; auto: "
                   + ", ".join(f"{jump:.0e} h at {radius:.2f} for {tolerance:g}"
                               for jump, radius, tolerance in zip(auto, radii, TOLERANCES, strict=True)),
                   falls and all(jump <= tolerance for jump, tolerance in zip(auto, TOLERANCES, strict=True)))


@cache
def _ball() -> Scene:
    """The sphere of radius 4 cells in 16³ cells."""
    return Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))


def _towards_the_middle(rays: int, settings: Settings) -> Hits:
    """Rays from all sides to the ball's middle."""
    ways = fibonacci(rays)
    return shot(_ball(), settings, MIDDLE - 20 * ways, ways)


def _jump(rays: int, settings: Settings) -> float:
    """How far f jumps, in h, at the faces that rays to the ball's middle cross within a cell of their hit.

    They meet the ball head-on, so that a step along them is f.
    """
    return largest([_jumps(settings, way).max(initial=0.0) for way in fibonacci(rays)]) / H


def _jumps(settings: Settings, way: Array) -> Array:
    ray = trace(_ball(), settings, MIDDLE - 20 * way, way)
    samples = len(ray.curves.t) // len(ray.cells)
    before, after = ray.curves.tangent[samples - 1:-1:samples], ray.curves.tangent[samples::samples]
    jumps: Array = np.abs(after - before)[np.abs(ray.borders[1:-1] - ray.t) < 1.0]
    return jumps
