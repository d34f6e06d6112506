"""How far a picture is from the exact surface: δ, δ_p and δ_n [T 3.4, 3.5]."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event

import numpy as np
from numpy.typing import NDArray

from jaart.core import extents, prepare, shapes
from jaart.core.errors import Cancelled
from jaart.core.records import STATUS, Hits, Quality
from jaart.core.scene import Scene, frozen
from jaart.core.telling import doing, tell

Array = NDArray[np.float64]

#: A hit farther than this (cells, spacings of a cloud) from the exact one is a distance miss.
TOO_FAR = 1.0
#: So many rays are measured between two looks at whether to stop.
RAYS_AT_ONCE = 1 << 14
#: A solid that ends on the lattice's faces is not cut off: cells that rounding may add.
TOUCH = 1e-6


def known(scene: Scene) -> bool:
    """Whether a scene's surface is known exactly, by its solids or as it is."""
    return scene.known


@doing("errors against the exact surface")
def quality(hits: Hits, scene: Scene, cancel: Event | None = None,
            progress: Callable[[int, int], None] | None = None) -> Quality | None:
    """The errors of hits against the scene's exact surface, or None when nobody knows it.

    cancel: set it to stop; progress(done, all rays) is called now and then.

    Each false hit, false miss and distance miss adds a penalty of 1 in place of its error. Normals are
    turned to the viewer first. Rays that cannot be traced (bad_ray), and those that meet a solid where the
    lattice cuts it off, are left out. Lengths are in cells, of a cloud in mean spacings.
    Raises Cancelled after cancel was set.
    """
    if not known(scene):
        return None
    good = np.flatnonzero(hits.status != STATUS["bad_ray"])
    exact_t, exact_normal = np.full(len(hits), np.nan), np.full((len(hits), 3), np.nan)
    for first in range(0, len(good), RAYS_AT_ONCE):
        if cancel is not None and cancel.is_set():
            raise Cancelled("the measuring of errors was cancelled")
        some = good[first:first + RAYS_AT_ONCE]
        exact_t[some], exact_normal[some] = _exact_hits(scene, hits, some)
        tell(first + len(some), len(good))
        if progress:
            progress(first + len(some), len(good))
    counted = np.ones(len(hits), bool)
    if scene.model is not None:
        counted[good[_cut_off(scene, hits, exact_t, good)]] = False
    return against(hits, exact_t, exact_normal, counted, extents.spacing(scene))


def _exact_hits(scene: Scene, hits: Hits, rays: NDArray[np.intp]) -> tuple[Array, Array]:
    """First t (R,) of some of the rays on the exact surface, and its normals (R, 3)."""
    solids = prepare.solids(scene, hits.settings)
    if solids is not None:
        return shapes.first_hit(solids, hits.origin[rays], hits.direction[rays])
    assert scene.exact is not None
    return scene.exact.hit(hits.origin[rays], hits.direction[rays])


def _cut_off(scene: Scene, hits: Hits, exact_t: Array, rays: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Which of some rays meet a solid beyond the lattice."""
    met = hits.origin[rays] + exact_t[rays, None] * hits.direction[rays]
    size = np.asarray(extents.extent(scene, hits.settings))
    return np.asarray(((met < -TOUCH) | (met > size + TOUCH)).any(axis=1))


def against(hits: Hits, exact_t: Array, exact_normal: Array, counted: NDArray[np.bool_] | None = None,
            unit: float = 1.0) -> Quality:
    """The errors of hits against exact ones.

    exact_t: (R,), NaN = no hit; exact_normal: (R, 3), unit length; counted: (R,) which rays matter, all when None;
    unit: what lengths are counted in, the size of a cell or the spacing of a cloud.
    """
    counted = np.ones(len(hits), bool) if counted is None else counted
    hit, exact = hits.hit & counted, np.isfinite(exact_t) & counted
    distance = np.where(hit & exact, np.abs(hits.t - exact_t) / unit, np.nan)
    both = np.flatnonzero(hit & exact)
    normal = turned(hits.normal[both], hits.direction[both])
    expected = turned(exact_normal[both], hits.direction[both])
    angle = np.full(len(hits), np.nan)
    angle[both] = angles(normal, expected)

    near = distance[both] <= TOO_FAR
    penalties = (int((hit & ~exact).sum()), int((exact & ~hit).sum()), int((~near).sum()))
    relevant = int((hit | exact).sum())
    steepness = np.abs(dots(normal, hits.direction[both]))
    errors = terms(distance[both], angle[both], steepness)
    delta, delta_p, delta_n = ((e[near].sum() + sum(penalties)) / relevant if relevant else np.nan for e in errors)
    return Quality(float(delta), float(delta_p), float(delta_n), relevant, *penalties,
                   distance=frozen(distance), angle=frozen(angle))


def terms(distance: Array, angle: Array, steepness: Array) -> tuple[Array, Array, Array]:
    """Each ray's share of δ, δ_p and δ_n: ρ_combined [T 3.5], |p_r - p_e| and 1 - <n_r, n_e>.

    distance: cells; angle: degrees; steepness: |<n_r, r>|. 1 - cos α is computed as 2 sin²(α/2).
    """
    bent = 2 * np.sin(np.radians(angle) / 2) ** 2
    return steepness * bent + (1 - steepness) * distance, distance, bent


def turned(normals: Array, directions: Array) -> Array:
    """The normals (R, 3), each turned to where its ray comes from."""
    return np.where(dots(normals, directions)[:, None] > 0, -normals, normals)


def angles(a: Array, b: Array) -> Array:
    """Angles (R,) in degrees between vectors, exact also where they are small."""
    angle: Array = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), dots(a, b))
    return np.degrees(angle)


def dots(a: Array, b: Array) -> Array:
    """Scalar products (R,) of rows."""
    products: Array = np.einsum("ij,ij->i", a, b)
    return products
