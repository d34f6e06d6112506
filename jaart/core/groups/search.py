"""How a ray finds the surface, and which hits are refused."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from jaart.core.groups.surface import ENERGIES, MESHES
from jaart.core.parameter import Length, parameter

#: Searches that step from x to x, and those that look at a stretch of the ray.
STEPPING = ("iterate", "secant", "newton")
STRETCHES = ("minimise", "march", "safe")


#: In words, when searches() and _steps() are true.
_SEARCHED = "a method other than isosurface, fill_level and cylinder"
_STEPPED = "search = iterate, secant or newton, and a surface that is no energy"


def searches(settings: Any) -> bool:
    """Whether a ray searches: a mesh and a cylinder are hit at once."""
    return settings.method not in (*MESHES, "cylinder")


def _steps(settings: Any) -> bool:
    return searches(settings) and settings.search in (*STEPPING, "auto") and settings.method not in ENERGIES


@dataclass(frozen=True, kw_only=True)
class SearchSettings:
    """The search along a ray."""

    search: str = parameter(
        "choice", "auto", choices=("auto", "iterate", "secant", "newton", "minimise", "march", "safe", "centres"),
        group="Search", label="Search", stage="rays", source="[T §2.3.5, 2.4.4; A §4, 6]", when=searches,
        needs=_SEARCHED,
        help="How a ray finds the surface. iterate: intersect it with the plane or polynomial at x, again and again. "
             "secant, newton: the same on f/<n, r>, with fewer steps. minimise: the least energy in each cell. march: "
             "even steps to a change of sign, then a straight line. safe: short steps with f and its slope, so that "
             "no hit is missed where f is continuous. centres: the plane or polynomial at the cell's or ball's centre "
             "alone. auto: iterate, or minimise for an energy.")
    tolerance: float | str = parameter(
        "number", 0.125, choices=("auto",), low=0, high=10, step=0.005, unit="h", group="Search", label="Tolerance",
        stage="rays", source="[T 2.14]", when=lambda s: searches(s) and s.search not in ("march", "centres"),
        needs=f"{_SEARCHED}, and a search other than march and centres",
        help="A ray has arrived when its next step is shorter than this; it counts in radii where the radius is "
             "below h. auto: a tenth of what can be seen, a pixel or the surface's own error, whichever is larger.")
    max_iterations: int = parameter(
        "integer", 20, low=1, high=10_000, step=1, group="Search", label="Iterations a start", stage="rays",
        source="[T §2.4.5, footnote 14]", when=_steps, needs=_STEPPED,
        help="After so many steps from one start the ray tries the next cell.")
    trust: Length | str = parameter(
        "length", "radius", choices=("radius",), low=0, open_low=True, high=1e6, step=0.25, unit="cells",
        group="Search", label="Trust region", stage="rays", source="[A §4]", when=_steps, needs=_STEPPED,
        scenes=("lattice", "model"),
        help="How far from its start a search may go before it is given up; by default the radius. In a cloud it is "
             "the ball.")
    bail: str = parameter(
        "choice", "cap", choices=("cap", "growth"), group="Search", label="Give up at", stage="rays",
        source="[A §4]", when=_steps, needs=_STEPPED,
        help="cap: after the iterations allowed; growth: also as soon as |f| grows.")
    proof: bool = parameter(
        "flag", False, group="Search", label="Prove misses", stage="rays",
        source="[Kalra & Barr 1989]",
        when=lambda s: searches(s) and s.search == "safe",
        needs="search = safe",
        help="A ray of the safe search misses only where bounds of the weights, wider than rounding, prove that there "
             "is no surface; a miss that they cannot prove is undecided. For the tangent surface with the average of "
             "the surfels' normals; it takes some times as long. Set method=tangent search=safe with it.")
    traversal: str = parameter(
        "choice", "exact", choices=("exact", "uniform"), group="Search", label="Traversal", stage="rays",
        source="[T §3.1.4]", scenes=("lattice", "model"), when=searches, needs=_SEARCHED,
        help="How the cells along a ray are found. exact visits every cell it crosses; uniform goes on by the step "
             "and misses some.")
    step: float | str = parameter(
        "number", "auto", choices=("auto",), low=0, open_low=True, high=100, step=0.05, unit="cells",
        group="Search", label="Step", stage="rays", source="[T §2.3.5, 3.1.4]",
        when=lambda s: searches(s) and (s.search == "march" or s.traversal == "uniform"),
        needs="search = march or traversal = uniform",
        help="Length of the steps of march (in a cloud: in h) and of the uniform traversal. auto: 0.25 h, and 1 cell.")


@dataclass(frozen=True, kw_only=True)
class BoundarySettings:
    """Bounds that a hit must pass."""

    max_off_centre: Length | str = parameter(
        "length", "auto", choices=("auto", "none"), low=0, open_low=True, high=1e6, step=0.01, unit="units",
        group="Boundary", label="Off-centre bound", stage="rays", source="[T 2.21]", when=searches, needs=_SEARCHED,
        help="A hit farther than this from its barycentre a(x) is refused; it removes shreds at silhouettes. "
             "auto: h; none: no bound.")
    min_weight: float | str = parameter(
        "number", "none", choices=("none",), low=-1e6, high=100, step=0.5, group="Boundary", label="Least log weight",
        stage="rays", source="[T §2.5]", when=searches, needs=_SEARCHED,
        help="A hit where log Σθ is below this is refused: the space Ω of points with enough weight.")
    max_nearest: Length | str = parameter(
        "length", "auto", choices=("auto", "none"), low=0, open_low=True, high=1e6, step=0.05, unit="units",
        group="Boundary", label="Distance to the nearest surfel", stage="rays", source="[T §2.5]", when=searches,
        needs=_SEARCHED,
        help="A hit farther than this from its nearest surfel is refused. auto: 1.5 h in a cloud, so that its holes "
             "stay open, and no bound in a lattice; none: no bound.")
    max_angle: float | str = parameter(
        "number", "none", choices=("none",), low=0, high=1, step=0.05, group="Boundary", label="Angle bound",
        stage="rays", source="[T 2.23]", when=searches, needs=_SEARCHED,
        help="A hit where |<c/|c|, n>| is above this is refused.")
    min_gap: float | str = parameter(
        "number", "none", choices=("none",), low=0, high=1, step=0.05, group="Boundary", label="Least sampling",
        stage="rays", source="[A Definition 2]", when=searches, needs=_SEARCHED,
        help="A hit where (λ1 - λ0)/λ2 of the points' covariance is below this is refused: they are no well-sampled "
             "sheet.")
