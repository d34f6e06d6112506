"""The slow oracle: every formula as it stands in its source, in plain Python, one point at a time.

Lengths are cells. A point or normal is a sequence of three floats. Nothing here is fast, shifted,
cached or shared with the package, so that an error would have to be made twice to go unseen.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from tests.naive_cells import Cell, Vector, crossed_cells, on_faces


def dot(a: Vector, b: Vector) -> float:
    """<a, b>."""
    return sum(x * y for x, y in zip(a, b, strict=True))


def minus(a: Vector, b: Vector) -> list[float]:
    """a - b."""
    return [x - y for x, y in zip(a, b, strict=True)]


def times(a: Vector, s: float) -> list[float]:
    """a·s."""
    return [x * s for x in a]


def along(origin: Vector, direction: Vector, t: float) -> list[float]:
    """The point o + t·d of a ray."""
    return [o + t * d for o, d in zip(origin, direction, strict=True)]


def weighted_mean(vectors: Sequence[Vector], weights: Vector) -> list[float]:
    """Σθ_i v_i / Σθ_i."""
    total = sum(weights)
    return [sum(w * v[k] for w, v in zip(weights, vectors, strict=True)) / total for k in range(3)]


def gaussian(q: float, h: float) -> float:
    """Weight exp(-q²/h²) of a surfel at distance q [T 2.7]."""
    return math.exp(-q * q / (h * h))


@dataclass
class Cloud:
    """Surfels (points with unit normals) and the width h of their weight."""

    points: Sequence[Vector]
    normals: Sequence[Vector]
    h: float

    def weights(self, x: Vector) -> list[float]:
        """θ_i of every surfel at x."""
        return [gaussian(math.dist(x, p), self.h) for p in self.points]

    def barycentre(self, x: Vector) -> list[float]:
        """a(x) = Σθ_i p_i / Σθ_i [T 2.12]."""
        return weighted_mean(self.points, self.weights(x))

    def mean_normal(self, x: Vector) -> list[float]:
        """Σθ_i n_i / Σθ_i: n(x) before its length is taken out."""
        return weighted_mean(self.normals, self.weights(x))

    def normal(self, x: Vector) -> list[float]:
        """n(x) = Σθ_i n_i / |Σθ_i n_i| [T 2.13]."""
        m = self.mean_normal(x)
        return times(m, 1 / math.hypot(*m))

    def f(self, x: Vector) -> float:
        """f(x) = <n(x), a(x) - x> [T 2.15]."""
        return dot(self.normal(x), minus(self.barycentre(x), x))

    def tangent_step(self, x: Vector, direction: Vector) -> float:
        """e_ts(x) = f(x) / <n(x), d>: the way along d to the plane H(x) [T 2.20]."""
        return self.f(x) / dot(self.normal(x), direction)

    def off_centre(self, x: Vector) -> float:
        """e_oc(x) = |x - a(x)| [T 2.22]."""
        return math.dist(x, self.barycentre(x))

    def mahalanobis(self, x: Vector, c: float = 0.25) -> float:
        """e_M(x): mean of the squared distance to each plane and c times that within it [T 2.17, 2.18]."""
        weights = self.weights(x)
        total = 0.0
        for weight, p, n in zip(weights, self.points, self.normals, strict=True):
            away = minus(x, p)
            height = dot(away, n)
            inside = minus(away, times(n, height))
            total += weight * (height * height + c * dot(inside, inside))
        return total / sum(weights)


def cell_of(x: Vector) -> Cell:
    """The cell [i, i+1)×[j, j+1)×[k, k+1) that holds x."""
    i, j, k = (math.floor(c) for c in x)
    return i, j, k


def cell_ball(cell: Cell, points: Sequence[Vector], radius: float) -> list[int]:
    """Which surfels lie within the radius of the cell's centre [T §3.1.3]."""
    centre = [c + 0.5 for c in cell]
    return [i for i, p in enumerate(points) if math.dist(p, centre) <= radius]


#: The lattice's outer faces belong to it, and rounding may lead this many cells beyond them.
SLACK = 1e-9


@dataclass
class Rules:
    """The numbers that end the search of a ray; lengths in cells but for the tolerance, in h (in radii where the
    radius is smaller)."""

    h: float = 0.8
    radius: float = 2.0
    tolerance: float = 0.125
    max_iterations: int = 20
    trust: float = 2.0
    max_off_centre: float = 0.3
    growth: bool = False


@dataclass
class Step:
    """One step of the search: from x at t to t_next on the plane H(x)."""

    cell: Cell
    t: float
    x: list[float]
    neighbours: list[int]
    barycentre: list[float] | None = None
    normal: list[float] | None = None
    f: float = math.nan
    t_next: float = math.nan
    outcome: str = "continue"


@dataclass
class End:
    """How a ray ended: t and normal are None without a hit.

    starts: the steps of each start; margin: how near any decision came to going the other way, in cells or
    as a share of its bound.
    """

    status: str = "background"
    t: float | None = None
    normal: list[float] | None = None
    starts: list[list[Step]] = field(default_factory=list)
    margin: float = math.inf

    def near(self, *distances: float) -> None:
        """Note how far some decisions were from the other side."""
        self.margin = min(self.margin, *(abs(d) for d in distances))

    @property
    def evaluations(self) -> list[int]:
        """For each start, its steps that found neighbours to evaluate."""
        return [sum(1 for step in steps if step.neighbours) for steps in self.starts]


class Search:
    """The `iterate` search: intersect the ray with the plane H(x) again and again [T §2.3.5, A §4]."""

    def __init__(self, points: Sequence[Vector], normals: Sequence[Vector], surfel_cells: set[Cell],
                 extent: Cell, rules: Rules) -> None:
        self.points, self.normals, self.surfel_cells = points, normals, surfel_cells
        self.extent, self.rules = extent, rules

    def run(self, origin: Vector, direction: Vector) -> End:
        """Follow one ray: every crossed cell with a surfel is a start, until one hits."""
        end = End()
        for crossing in crossed_cells(origin, direction, self.extent):
            cells = [c for c in on_faces(crossing.cell, origin, direction) if c in self.surfel_cells]
            if not cells:
                continue
            steps = self.start(origin, direction, float(crossing.enter), cells[0], end)
            end.starts.append(steps)
            end.status = steps[-1].outcome
            if end.status == "converged":
                end.t, end.normal = steps[-1].t_next, steps[-1].normal
                break
        return end

    def start(self, origin: Vector, direction: Vector, t_start: float, cell: Cell, end: End) -> list[Step]:
        """All steps from the ray's entry into one cell."""
        steps: list[Step] = []
        t = t_start
        while not steps or steps[-1].outcome == "continue":
            step = self.step(origin, direction, t, cell)
            before = steps[-1] if steps else None
            step.outcome = self.judge(origin, direction, t_start, step, before, len(steps) + 1, end)
            steps.append(step)
            t = step.t_next
            if step.outcome == "continue":
                x = along(origin, direction, t)
                i, j, k = (min(max(c, 0), n - 1) for c, n in zip(cell_of(x), self.extent, strict=True))
                cell = i, j, k
                end.near(min(abs(c - round(c)) for c, d in zip(x, direction, strict=True) if d != 0))
        return steps

    def step(self, origin: Vector, direction: Vector, t: float, cell: Cell) -> Step:
        """Evaluate the neighbourhood of the cell at x = o + t·d."""
        x = along(origin, direction, t)
        return Step(cell, t, x, cell_ball(cell, self.points, self.rules.radius))

    def judge(self, origin: Vector, direction: Vector, t_start: float, step: Step, before: Step | None,
              number: int, end: End) -> str:
        """Fill in where the step leads, and name what follows."""
        rules = self.rules
        if not step.neighbours:
            return "few_neighbours"
        cloud = Cloud([self.points[i] for i in step.neighbours], [self.normals[i] for i in step.neighbours],
                      rules.h)
        step.barycentre = cloud.barycentre(step.x)
        if _below(math.hypot(*cloud.mean_normal(step.x)), 1e-8, end):
            return "undefined_normal"
        step.normal, step.f = cloud.normal(step.x), cloud.f(step.x)
        cosine = dot(step.normal, direction)
        if _below(abs(cosine), 1e-12, end):
            return "parallel"
        step.t_next = step.t + step.f / cosine
        if rules.growth and before and _below(abs(before.f), abs(step.f), end):
            return "cap"
        if not self.trusted(along(origin, direction, step.t_next), step.t_next, t_start, end):
            return "left_trust"
        if _below(abs(step.t_next - step.t), rules.tolerance * min(rules.h, rules.radius), end):
            near = _below(cloud.off_centre(step.x), rules.max_off_centre, end)
            return "converged" if near else "bounded"
        return "cap" if number == rules.max_iterations else "continue"

    def trusted(self, x: Vector, t: float, t_start: float, end: End) -> bool:
        """Whether the next point lies in the trust region, in the lattice and before the viewer."""
        end.near(*(c + SLACK for c in x), *(c - n - SLACK for c, n in zip(x, self.extent, strict=True)))
        inside = all(-SLACK <= c <= n + SLACK for c, n in zip(x, self.extent, strict=True))
        end.near(t)
        return t > 0 and _below(abs(t - t_start), self.rules.trust, end) and inside


def _below(value: float, bound: float, end: End) -> bool:
    """value < bound, noting how near it was, as a share of the bound."""
    end.near((value - bound) / bound if bound else value)
    return value < bound
