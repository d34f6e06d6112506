"""Rows 25 to 29: coordinates far from the origin, tiny and huge ones, and numbers of neighbours."""

from __future__ import annotations

import numpy as np

from jaart.core.notes import notes
from jaart.core.prepare import levels
from jaart.core.records import Hits
from jaart.core.samples import fibonacci
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, error_of, largest
from jaart.core.study.stability.looks import thesis_sphere
from jaart.core.study.stability.scenes import cloud, shot, sphere

#: As exact as float64 is, with every length a share of the scene.
FINE = Settings(tolerance=1e-13, h="0.12d", radius="0.72d", max_iterations=100)
#: Points of the sphere.
COUNT = 300
#: Rays from around a unit sphere, from multiples of 2^-10, that meet it, and one that does not.
EYES = np.round(3 * fibonacci(40) * 1024) / 1024
WAYS = np.concatenate((-EYES[:39] + 0.8 * fibonacci(40)[38::-1], EYES[39:]))
#: What mirror images and turns may differ by; an ulp of t is 1.8e-15.
ROUNDED = 1e-14


def _same(a: Hits, b: Hits, factor: float = 1.0) -> bool:
    """Whether hits have the same bits, those of b after division by a factor."""
    return (np.array_equal(a.status, b.status) and np.array_equal(a.t, b.t / factor, equal_nan=True)
            and np.array_equal(a.point, b.point / factor, equal_nan=True)
            and np.array_equal(a.normal, b.normal, equal_nan=True))


def _moved(scene: Scene, by: float) -> Scene:
    assert scene.points is not None
    return cloud(scene.points + by, scene.normals)


def _scaled(scene: Scene, by: float) -> Scene:
    assert scene.points is not None
    return cloud(scene.points * by, scene.normals)


@case(25, "a sphere of radius 1 at coordinates 1e6, 1e9 and 1e12, tolerance 1e-13 h",
      "t off by less than an ulp of the offset, which is what rounding the points takes; none where the points need no "
      "rounding; a note says the attainable precision")
def coordinates_far_from_the_origin() -> Outcome:
    """Points and rays are taken relative to the middle of the cloud, so that only their own rounding is left."""
    exact = cloud(np.round(fibonacci(COUNT) * 1024) / 1024, fibonacci(COUNT))
    errors, kept, said = [], [], []
    at_home, exactly = (shot(scene, FINE, EYES, WAYS) for scene in (sphere(COUNT), exact))
    for far in (1e6, 1e9, 1e12):
        there = _moved(sphere(COUNT), far)
        hits = shot(there, FINE, EYES + far, WAYS)
        same = np.array_equal(hits.hit, at_home.hit)
        errors.append(float(np.nanmax(np.abs(hits.t - at_home.t))) / np.spacing(far) if same else np.inf)
        kept.append(np.array_equal(shot(_moved(exact, far), FINE, EYES + far, WAYS).t, exactly.t, equal_nan=True))
        said.append(any(f"{np.spacing(far):.2g}" in note for note in notes(there, FINE)))
    return Outcome(f"errors of {', '.join(f'{e:.2f}' for e in errors)} ulp of the offset; without rounding "
                   f"{'no bit' if all(kept) else 'bits'} changed; {sum(said)} of 3 notes",
                   largest(errors) < 1 and all(kept) and all(said))


@case(26, "coordinates times 1e-12, tolerance 1e-9",
      "t times 1e-12 to the last digits, and the same bits at 2^-40: the tolerance counts in h")
def coordinates_in_picometres() -> Outcome:
    """A tolerance in the scene's units would take every start for a hit."""
    settings = FINE.replace(tolerance=1e-9)
    base = shot(sphere(COUNT), settings, EYES, WAYS)
    tiny = shot(_scaled(sphere(COUNT), 1e-12), settings, EYES * 1e-12, WAYS)
    error = float(np.nanmax(np.abs(tiny.t * 1e12 / base.t - 1)))
    halved = _same(base, shot(_scaled(sphere(COUNT), 2.0**-40), settings, EYES * 2.0**-40, WAYS), 2.0**-40)
    return Outcome(f"{tiny.hit.sum()} of {base.hit.sum()} hits, off by a share of {error:.1e}; at 2^-40 "
                   f"{'the same bits' if halved else 'other bits'}",
                   np.array_equal(tiny.hit, base.hit) and error < 1e-14 and halved)


@case(27, "a scene scaled by 2^k, mirrored, and turned by 90 degrees", "scaled: the same bits; mirrored and turned: "
      "images that differ by 1e-14 at most")
def scaled_mirrored_and_turned() -> Outcome:
    """The row's 1e-15 is the rounding of one number; a root far from its ray's origin collects some ten of them.

    The levels of the lattice are turned, for those of a solid that is turned are integrated anew, to 1e-6.
    """
    bits = [_same(shot(sphere(COUNT), settings, EYES, WAYS),
                  shot(_scaled(sphere(COUNT), 2.0**k), settings, EYES * 2.0**k, WAYS), 2.0**k)
            for k in (-300, -40, 1, 40, 300)
            for settings in (FINE, FINE.replace(search="safe"), FINE.replace(method="polynomial", search="newton"))]
    errors = [error for turn in TURNS for name in ("cloud", "lattice") for error in _images(turn, name)]
    return Outcome(f"{sum(bits)} of {len(bits)} scales with the same bits; {len(errors)} images differ by "
                   f"{largest(errors):.1e} at most", all(bits) and largest(errors) < ROUNDED)


#: Each as a matrix of -1, 0 and 1: a mirror image along x, and turns about z and x.
TURNS = tuple(np.array(rows, float) for rows in ([[-1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
                                                 [[1, 0, 0], [0, 0, -1], [0, 1, 0]]))


def _images(turn: Array, name: str) -> list[float]:
    """How far the image of the hits is from the hits of the image, infinite where one is missing; for two normals."""
    around = fibonacci(COUNT)
    settings, base, image, low, unit = FINE, cloud(around, around), cloud(around @ turn.T, around @ turn.T), 0, 1
    if name == "lattice":
        settings, low, unit = FINE.replace(h=0.8, radius=6), 8, 4
        base = Scene("case", levels=levels(thesis_sphere((0.47, 0.52, 0.55)), settings))
        image = Scene("case", levels=_turned(base, turn))
    errors = []
    for chosen in (settings, settings.replace(normal="covariance")):
        a = shot(base, chosen, low + unit * EYES, WAYS)
        b = shot(image, chosen, low + unit * EYES @ turn.T, WAYS @ turn.T)
        same = np.array_equal(a.status, b.status) and a.hit.any()
        errors.append(float(np.nanmax(np.abs([a.t - b.t, *(a.normal @ turn.T - b.normal).T]))) if same else np.inf)
    return errors


def _turned(scene: Scene, turn: Array) -> Array:
    """The levels of a lattice of 16³ turned about its middle."""
    assert scene.levels is not None
    cells = np.argwhere(np.ones(scene.levels.shape, bool))
    at = np.rint((cells - 7.5) @ turn.T + 7.5).astype(np.intp)
    result = np.empty_like(scene.levels)
    result[tuple(at.T)] = scene.levels[tuple(cells.T)]
    return result


@case(28, "k = 1000 and ball_k = 100 with 9 points", "the picture of all of them, and a note")
def more_neighbours_than_points() -> Outcome:
    """Every point counts; the notes say what k was clipped to."""
    few, rays = sphere(9), (EYES, -EYES)
    pairs = [(Settings(neighbourhood="knn", h="1.0", k=1000), Settings(neighbourhood="knn", h="1.0", k=9)),
             (Settings(h="1.0", ball_k=100), Settings(h="1.0", ball_k=8))]
    same = [_same(shot(few, asked, *rays), shot(few, clipped, *rays)) for asked, clipped in pairs]
    said = [note for asked, _ in pairs for note in notes(few, asked) if note.startswith(("k =", "ball_k ="))]
    hits = int(shot(few, pairs[0][0], *rays).hit.sum())
    return Outcome(f"{hits} of {len(EYES)} hits; {'; '.join(said) or 'no note'}", all(same) and hits > 0
                   and any("k = 1000" in note for note in said) and any("ball_k = 100" in note for note in said))


@case(29, "k and ball_k of 0 and -3", "one error each: k: expected a whole number >= 1")
def no_neighbours_and_fewer() -> Outcome:
    """Refused where they are set, before anything is computed."""
    found = [error_of(lambda name=name, k=k: Settings(**{name: k})) for name in ("k", "ball_k")  # type: ignore[misc]
             for k in (0, -3)]
    return Outcome("; ".join(found), all("k = " in f and "expected a whole number >= 1" in f for f in found))
