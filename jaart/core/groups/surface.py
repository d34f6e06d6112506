"""Which surface is shown, and which surfels count how much at a point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from jaart.core.parameter import Length, parameter

#: Surfaces that are minima of an energy along the ray.
ENERGIES = ("off_centre", "mahalanobis", "angle")
#: Surfaces that are fitted to the points in a local frame.
FITTED = ("polynomial", "projection")
#: Surfaces that are meshes before a ray meets them.
MESHES = ("isosurface", "fill_level")


#: In words, when evaluates() is true.
_EVALUATED = "a method other than fill_level"


def evaluates(settings: Any) -> bool:
    """Whether weights of surfels enter the surface at all."""
    return bool(settings.method != "fill_level")


def _energetic(settings: Any) -> bool:
    if settings.method == "isosurface":
        return bool(settings.energy != "angle")
    return settings.method in ENERGIES or (settings.method == "tangent" and settings.search == "minimise")


def _levelled(settings: Any) -> bool:
    return settings.method in (*MESHES, *ENERGIES) or settings.search == "minimise"


@dataclass(frozen=True, kw_only=True)
class SurfaceSettings:
    """The definition of the surface."""

    method: str = parameter(
        "choice", "tangent", choices=("tangent", "polynomial", "projection", "off_centre", "mahalanobis", "angle",
                                      "cylinder", "isosurface", "fill_level"),
        group="Surface", label="Surface", stage="rays", source="[T 2.15–2.24; A 5, 10]",
        help="tangent: zero set of f(x) = <n(x), a(x) - x>. polynomial: a polynomial fitted above the plane at x. "
             "projection: the point-set surface of Alexa et al. off_centre: minimum of |x - a(x)|. mahalanobis: "
             "minimum of the mean distance to the surfels' planes. angle: minimum of |<c/|c|, n>|. cylinder: Schaufler "
             "& Jensen's mean of the points around the ray. isosurface: an energy's level as a mesh. fill_level: "
             "marching cubes of the lattice itself.")
    degree: int = parameter(
        "integer", 2, low=0, high=4, step=1, group="Surface", label="Degree", stage="rays", source="[A 10]",
        when=lambda s: s.method in FITTED, needs=f"method = {' or '.join(FITTED)}",
        help="Degree of the polynomial; lowered, and counted, where too few points are near.")
    patch: float = parameter(
        "number", 0.0, low=0, high=4, step=0.05, unit="cells", group="Surface", label="Patch of a surfel",
        stage="rays", when=lambda s: s.method == "polynomial", needs="method = polynomial", scenes=("lattice", "model"),
        help="Beyond the sources: a surfel of fill levels is the mean of a patch of the surface, about a cell wide, "
             "and the polynomial's mean over the patch is fitted to it. 0: it is fitted to the point alone.")
    emphasise: bool = parameter(
        "flag", False, group="Surface", label="Emphasise by the angle", stage="rays", source="[T 2.24]",
        when=_energetic, needs="method = off_centre, mahalanobis or isosurface, or search = minimise",
        help="Minimise 1 - (1 - e_angle)(1 - e) in the place of the energy e.")
    mahalanobis_c: float = parameter(
        "number", 0.25, low=0, high=1, step=0.05, group="Surface", label="Mahalanobis c", stage="rays",
        source="[T 2.17]",
        help="Share of the distance along a surfel's plane in the energy e_M.")
    energy: str = parameter(
        "choice", "tangent", choices=("tangent", "off_centre", "mahalanobis", "angle"), group="Surface",
        label="Energy", stage="rays", source="[T §2.4.6]", when=lambda s: s.method == "isosurface",
        needs="method = isosurface",
        help="Whose level the isosurface is; tangent is |f|, which no ray direction enters.")
    subdivide: int = parameter(
        "integer", 2, low=1, high=8, step=1, group="Surface", label="Samples a cell", stage="rays",
        source="[T §2.4.6]", when=lambda s: s.method == "isosurface", needs="method = isosurface",
        help="Along each edge of a cell the energy is sampled so many times.")
    level: float | str = parameter(
        "number", "auto", choices=("auto",), low=0, high=1e6, step=0.01, unit="cells", group="Surface",
        label="Level", stage="rays", source="[T §2.4.4, 2.4.6]", when=_levelled,
        needs="search = minimise, or a method that is an energy or a mesh",
        help="Of minimise: a minimum below it is a hit. Of a mesh: its isovalue. auto: as the energy needs it, 0.5 "
             "for fill levels.")


@dataclass(frozen=True, kw_only=True)
class WeightSettings:
    """Weights, normals and neighbourhoods."""

    weight: str = parameter(
        "choice", "gaussian", choices=("gaussian", "hat", "squared_hat", "wendland"), group="Weight and area",
        label="Weight", stage="rays", source="[T 2.7, §3.2.2; A §6]", when=evaluates, needs=_EVALUATED,
        help="How the influence of a surfel falls with its distance q. gaussian: exp(-q²/h²). hat: 1 - q/h. "
             "squared_hat: 1 - q²/h². wendland: (1 - q/s)⁴(4q/s + 1), s = 2.653 h, as wide as the Gaussian at half "
             "its height and exactly 0 from s on.")
    h: Length | str = parameter(
        "length", "auto", choices=("auto",), low=0, open_low=True, high=1e6, step=0.05, unit="units",
        group="Weight and area", label="Feature size h", stage="rays", source="[T 2.7]", when=evaluates,
        needs=_EVALUATED,
        help="Width of the weight: larger values smooth more and shrink round shapes by about h²/2R. auto: 0.8 cells, "
             "or what a cloud's spacing asks for. 0.004d is a share of the diagonal, 2s a multiple of the spacing.")
    normal: str = parameter(
        "choice", "auto", choices=("auto", "surfel", "covariance", "covariance_at_x"), group="Weight and area",
        label="Normal", stage="rays", source="[T 2.13, §2.3.3; A 8, 9]", when=evaluates, needs=_EVALUATED,
        help="Where n(x) comes from. surfel: the weighted average of the surfels' normals. covariance: the direction "
             "of least spread of the points about a(x). covariance_at_x: about x, as the sources have it. auto: surfel "
             "where there are normals.")
    neighbourhood: str = parameter(
        "choice", "auto", choices=("auto", "cell_ball", "ball", "cell_knn", "knn"), group="Weight and area",
        label="Neighbourhood", stage="neighbours", source="[T §3.1.3]", when=evaluates, needs=_EVALUATED,
        help="Which surfels count at x. cell_ball: within the radius of the centre of the cell that holds x. ball: "
             "within the radius of x. cell_knn, knn: the k nearest to that centre, or to x. auto: cell_ball on a "
             "lattice, ball in a cloud.")
    radius: Length | str = parameter(
        "length", "auto", choices=("auto",), low=0, open_low=True, high=1e6, step=0.25, unit="units",
        group="Weight and area", label="Radius", stage="neighbours", source="[T §3.1.3]",
        when=lambda s: evaluates(s) and s.neighbourhood in ("auto", "cell_ball", "ball"),
        needs=f"neighbourhood = cell_ball or ball, and {_EVALUATED}",
        help="Radius of the neighbourhood, best 3 h or more: what it cuts off makes f jump at cell faces, and "
             "holes open. auto: where the weight has fallen to nothing that counts, on a lattice for the tolerance.")
    k: int = parameter(
        "integer", 12, low=1, high=1000, step=1, group="Weight and area", label="Nearest k", stage="neighbours",
        source="[T §3.1.3]", when=lambda s: evaluates(s) and s.neighbourhood in ("cell_knn", "knn"),
        needs=f"neighbourhood = cell_knn or knn, and {_EVALUATED}",
        help="How many nearest surfels count.")
    ball_k: int = parameter(
        "integer", 6, low=1, high=100, step=1, group="Weight and area", label="Balls to the k-th neighbour",
        stage="surfels", source="[A §5]", scenes=("cloud",),
        help="The balls in which rays search reach to so many neighbours; below 11 they grow towards as many, so that "
             "fewer of them cover the points.")
