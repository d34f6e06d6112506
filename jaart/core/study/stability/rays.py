"""Rows 32 to 38: rays along a plane, from within, from the surface itself, and without a direction."""

from __future__ import annotations

import numpy as np

from jaart.core.lights import lights
from jaart.core.phong import phong
from jaart.core.records import STATUS_NAMES, Hits
from jaart.core.samples import fibonacci
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, counted, error_of, largest
from jaart.core.study.stability.scenes import cloud, plane, shot, sphere
from jaart.core.trace import trace

SEARCHES = ("iterate", "secant", "newton", "minimise", "march", "safe", "centres")
#: Those that end at a root of f as exactly as they are asked to.
EXACT = ("iterate", "secant", "newton", "safe")
FLAT = Settings(h="1.0", tolerance=1e-13, max_iterations=100)
ROUND = Settings(h="0.1d", tolerance=1e-13, max_iterations=100)


def _layer() -> Scene:
    """A lattice of 9³ cells with a flat surface at z = 4.5."""
    filled = np.zeros((9, 9, 9))
    filled[:, :, :4], filled[:, :, 4] = 1.0, 0.5
    return Scene("case", levels=filled)


def _missed(cloud_rays: tuple[object, object], lattice_rays: tuple[object, object]) -> Outcome:
    """Whether rays meet neither the plane at z = 0 nor the layer at z = 4.5, whatever the search; how they ended."""
    found = [shot(scene, FLAT.replace(search=search, h=h), *rays) for search in SEARCHES
             for scene, h, rays in ((plane(), 1.0, cloud_rays), (_layer(), 0.8, lattice_rays))]
    ends = sum(np.bincount(hits.status, minlength=len(STATUS_NAMES)) for hits in found)
    clean = all(np.isnan(hits.t).all() and np.isnan(hits.point).all() for hits in found)
    return Outcome(", ".join(f"{n} {name}" for name, n in zip(STATUS_NAMES, np.atleast_1d(ends), strict=True) if n),
                   clean and not any(hits.hit.any() for hits in found))


@case(32, "rays parallel to a plane, above and below it, with every search",
      "misses with a named end: background, left_trust or parallel")
def parallel_to_a_plane() -> Outcome:
    """No step along the ray leads to the plane: e_ts is infinite, and is not stepped."""
    across = [[1, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    return _missed(([[-20, 0.1, 0.5], [-20, 0.3, 1], [0, 0, 1.2], [-20, -20, -0.7]], across),
                   ([[-3, 4.3, 4.7], [-3, 4.5, 4.2], [4, -3, 5], [-3, -3, 4]], across))


@case(33, "rays within the plane of the surface, with every search", "documented misses: the ray meets the surface "
      "nowhere, for it never crosses it")
def within_the_plane_of_the_surface() -> Outcome:
    """f is 0 all along, <n, d> as well. There is no first point to name, and a face seen from its edge has no area."""
    across = [[1, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    return _missed(([[-20, 0, 0], [-20, 0.3, 0], [0, 0, 0], [-20, -20, 0]], across),
                   ([[-3, 4.3, 4.5], [-3, 4.5, 4.5], [4.2, 4.3, 4.5], [-3, -3, 4.5]], across))


@case(34, "rays that start just above a surface and leave it", "misses: t > 0 counts alone")
def surface_behind_the_start() -> Outcome:
    """At 0.3, 0.05 and 1e-9 above the surface; the plane through it is met at t < 0."""
    heights, up = np.array([0.3, 0.05, 1e-9]), [[0, 0, 1], [0, 0.5, 1], [0.3, 0, 1]]
    return _missed(([[0.2, 0.3, z] for z in heights], up), ([[4.2, 4.3, 4.5 + z] for z in heights], up))


@case(35, "a camera inside a sphere, 0.3 from its middle", "the far wall at R - 0.3; the normal stays outwards, the "
      "picture is shaded with it turned to the viewer, and the hit is flagged: from_behind")
def camera_inside_the_object() -> Outcome:
    """Hits keep the normal outwards, as refraction and the errors of normals need it, where the row flips it."""
    scene, ways = sphere(2000), fibonacci(30)
    radius = float(shot(scene, ROUND, [0, 0, 0], [1, 0, 0]).t[0])
    q = 2 * radius / 0.12  # h² = (0.1 √12)²; for a dense sphere radius = coth q - 1/q
    dense = abs(radius - 1 / np.tanh(q) + 1 / q)
    inside, ahead = shot(scene, ROUND, 0 * ways + [0.3, 0, 0], ways), shot(scene, ROUND, [0.3, 0, 0], [1, 0, 0])
    outside = shot(scene, ROUND, inside.point + ways, -ways)
    wall = abs(float(ahead.t[0]) - (radius - 0.3))
    same = float(np.abs(outside.t - 1).max())
    flags = int(inside.from_behind.sum()), int(outside.from_behind.sum())
    shaded = np.array_equal(_brightness(inside, 1), _brightness(inside, -1))
    return Outcome(f"R = {radius:.4f}, off a dense sphere's by {dense:.0e}; t off R - 0.3 by {wall:.1e}, the same "
                   f"walls from outside to {same:.1e}; from_behind: {flags[0]} of 30 from within, {flags[1]} from "
                   f"outside; {'the same' if shaded else 'another'} shade with turned normals",
                   dense < 1e-3 and wall < 1e-13 and same < 1e-13 and flags == (30, 0) and shaded)


def _brightness(hits: Hits, side: int) -> Array:
    """Light of hits in the headlight, with their normals turned to a side."""
    normal, view = side * hits.normal, -hits.direction
    return phong(lights(hits.settings, hits.point, normal, view), normal, view, hits.settings)


@case(36, "a camera exactly on the surface, about 0 and at 1e6",
      "no hit at the start: outwards a miss, inwards the far wall; from 1e-9 above it a hit at 1e-9: no fixed epsilon")
def camera_exactly_on_the_surface() -> Outcome:
    """Such an origin is a root of f up to a bound on its rounding; then hits count from where the ray has left it."""
    own, far, near, close, total = 0, 0, np.inf, [], 0
    around = fibonacci(400)
    for offset in (0.0, 1e6):
        scene = cloud(around + offset, around)
        on = shot(scene, ROUND.replace(search="newton", tolerance=0), 3 * fibonacci(50) + offset, 0.2 - fibonacci(50))
        at, n = on.point[on.hit], on.normal[on.hit]
        for search in EXACT:
            settings = ROUND.replace(search=search)
            inwards = shot(scene, settings, at, -n)
            own += int(shot(scene, settings, at, n).hit.sum() + (inwards.t < 1).sum())
            far, near, total = far + int((inwards.t > 1).sum()), min(near, float(inwards.t.min())), total + len(at)
            if not offset:
                close.append(float(np.abs(shot(scene, settings, at + 1e-9 * n, -n).t - 1e-9).max()))
    return Outcome(f"{own} of {2 * total} rays met their own start, {far} of {total} the far wall, at t >= {near:.2f}; "
                   f"from 1e-9 above t is off by {largest(close):.1e}",
                   own == 0 and far == total and largest(close) < 1e-13)


@case(37, "directions of length zero, NaN and infinite", "trace: an error that says so; in a batch: bad_ray, and the "
      "other rays as ever")
def no_direction() -> Outcome:
    """A picture is not lost for one ray; who asks for a single ray is told."""
    bad = [[0.0, 0.0, 0.0], [np.nan, 0.0, 1.0], [0.0, np.inf, 0.0]]
    errors = [error_of(lambda d=d: trace(plane(), FLAT, (0, 0, 5), d)) for d in bad]  # type: ignore[misc]
    hits = shot(plane(), FLAT, [[0, 0, 5]] * 4, [*bad, [0, 0, -1]])
    said = "zero length" in errors[0] and all("three finite numbers" in e for e in errors[1:])
    return Outcome(f"{'; '.join(errors)}; {counted(hits.counts())}, t = {hits.t[3]:g}",
                   said and hits.counts() == {"bad_ray": 3, "converged": 1} and hits.t[3] == 5)


@case(38, "directions of length 1e-3, 1e-300 and 1e300, a plane 5 away", "t = 5: along the unit direction")
def direction_of_any_length() -> Outcome:
    """Scaled by the largest component first, so that no square under- or overflows."""
    lengths = (1e-3, 1e-300, 1e300)
    t = shot(plane(), FLAT, [[0, 0, 5]] * 3, [[0, 0, -length] for length in lengths]).t
    single = [trace(plane(), FLAT, (0, 0, 5), (0, 0, -length)).t for length in lengths]
    return Outcome(f"t = {', '.join(f'{v:g}' for v in t)}; of trace {', '.join(f'{v:g}' for v in single)}",
                   bool((t == 5).all()) and single == [5.0] * 3)
