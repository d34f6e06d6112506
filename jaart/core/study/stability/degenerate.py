"""Rows 17 to 24: clouds with too little in them, and points that are none."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from jaart.core.io import load
from jaart.core.samples import fibonacci
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, counted, error_of, largest
from jaart.core.study.stability.scenes import cloud, plane, shot
from jaart.core.trace import trace

SEARCHES = ("iterate", "secant", "newton", "safe", "march")
#: Normals from the points alone, h = 0.5.
BARE = Settings(normal="covariance").replace(h=0.5)
UNDEFINED = "undefined_normal for every ray, with every search"


def loaded(points: Array, normals: Array | None = None) -> Scene:
    """A cloud as it comes out of a file, cloud.npz."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "cloud.npz"
        if normals is None:
            np.savez(path, points=points)
        else:
            np.savez(path, points=points, normals=normals)
        return load(path)


def complaint(points: Array, normals: Array | None = None) -> str:
    """What is said of a file that is refused, without its folder."""
    message = error_of(lambda: loaded(points, normals))
    return message[message.find("cloud.npz"):] if "cloud.npz" in message else message


@case(17, "a cloud without points", "one error: a cloud needs at least one point")
def a_cloud_without_points() -> Outcome:
    """The catalogue asks for background and a note. But a cloud without points has no box for a camera to look at, no
    spacing and no h: whoever opens such a file has the wrong file, or one that was never filled, and is told so. A
    lattice without surfels (row 55) has a box, and gives background with a note.
    """
    message = complaint(np.empty((0, 3)))
    made = error_of(lambda: Scene("case", points=np.empty((0, 3))))
    return Outcome(message, message == "cloud.npz: points: holds no points; expected at least one"
                   and "at least one" in made)


@case(18, "two points, and 21 along a line, normals by covariance", UNDEFINED)
def points_along_a_line() -> Outcome:
    """Two eigenvalues are 0: any direction across the line would do, so none is taken."""
    line = np.linspace(-1, 1, 21)[:, None] * (1 / 3, 2 / 3, 2 / 3)
    return _all_undefined(((cloud([(0, 0, 0), (1, 0, 0)]), (0.5, 0, 0)), (cloud(line), (0, 0, 0))))


@case(19, "20 points in one place, normals by covariance", UNDEFINED)
def points_in_one_place() -> Outcome:
    """All eigenvalues are 0. A file's duplicates are merged (row 22): here they are one scene's by intention."""
    place = (0.5, 0.25, 0.125)
    return _all_undefined(((cloud([place] * 20), place),))


def _all_undefined(aimed: tuple[tuple[Scene, Any], ...]) -> Outcome:
    """The outcome of 12 rays past the middle of each cloud, with every search."""
    around, ends = fibonacci(12), dict[str, int]()
    for scene, middle in aimed:
        for search in SEARCHES:
            origins = np.array(middle) + 0.05 * around[::-1] - 3 * around
            for name, count in shot(scene, BARE.replace(search=search), origins, around).counts().items():
                ends[name] = ends.get(name, 0) + count
    return Outcome(counted(ends), ends == {"undefined_normal": 12 * len(SEARCHES) * len(aimed)})


@case(20, "300 scattered points of a tilted plane, normals by covariance",
      "the plane, to 1e-15: points on it, and its normal")
def points_of_a_plane() -> Outcome:
    """The middle of any of its points lies on it, and its normal is the direction without any spread."""
    n, across = np.array((1, 2, 2)) / 3, np.array(((2, -2, 1), (2, 1, -2))) / 3
    places = np.random.default_rng(5).uniform(-1, 1, (300, 2)) @ across
    scene, aimed = cloud(places + 0.7 * n), 0.6 * places[:40] + 0.7 * n
    directions = fibonacci(160)[:40] * (1, 1, -1)
    directions *= -np.sign(directions @ n)[:, None]
    slanted = np.abs(directions @ n) > 0.3
    off, turned, met = [], [], 0
    for search in SEARCHES:
        hits = shot(scene, BARE.replace(search=search, h=0.4, tolerance=1e-9), (aimed - 3 * directions)[slanted],
                    directions[slanted])
        met += int(hits.hit.sum())
        off.append(float(np.abs(hits.point @ n - 0.7).max()))
        turned.append(float(np.linalg.norm(np.cross(hits.normal, n), axis=1).max()))
    rays = len(SEARCHES) * int(slanted.sum())
    return Outcome(f"{met} of {rays} hit, off the plane by {largest(off):.1e}, normal by {largest(turned):.1e} rad",
                   met == rays and largest(off) <= 1e-15 and largest(turned) <= 1e-15)


@case(21, "covariance normals up to 2.2 h above a plane",
      "e_z at every distance; about x, as the sources have it, only below h/√2")
def covariance_normals_far_above_a_plane() -> Outcome:
    """About x the spread across the plane, d², is larger than that along it, h²/2, from d = 0.7071 h on."""
    points = plane(16, 0.4).points
    assert points is not None
    settings = Settings(search="march", step=0.05, ball_k=100, max_nearest="none", max_off_centre="none").replace(h=1.0)
    tilt: dict[str, tuple[Array, Array]] = {}
    for normal in ("covariance", "covariance_at_x"):
        followed = trace(cloud(points), settings.replace(normal=normal), (0.03, 0.05, 5), (0, 0, -1))
        tilt[normal] = followed.query[:, 2], np.hypot(followed.step_normal[:, 0], followed.step_normal[:, 1])
    (z, about_a), (again, about_x) = tilt["covariance"], tilt["covariance_at_x"]
    upright, flipped = float(again[about_x < 1e-3].max()), float(again[about_x > 0.5].min())
    return Outcome(f"about a(x) tilted by {about_a.max():.1e} up to {z.max():.2f} h; about x upright up to "
                   f"{upright:.3f} h, tangential from {flipped:.3f} h",
                   about_a.max() <= 1e-15 and z.max() > 2.2 and upright < math.sqrt(0.5) < flipped)


@case(22, "a file with one of two points 1000 times", "duplicates are merged, it is said how many, and a(x) is midway")
def a_thousand_duplicates() -> Outcome:
    """In a scene that is made with the duplicates they count, each with its weight: a(x) is drawn to them."""
    points = np.vstack((np.zeros((1000, 3)), (1.0, 0.0, 0.0)))
    up = np.tile((0.0, 0.0, 1.0), (1001, 1))
    settings = Settings().replace(h=1.0)
    merged, whole = loaded(points, up), Scene("case", points=points, normals=up)
    a = [float(trace(scene, settings, (0.5, 0, 3), (0, 0, -1)).barycentre[-1, 0]) for scene in (merged, whole)]
    assert merged.points is not None
    return Outcome(f"{'; '.join(merged.notes)}; a = {a[0]:.3f}, unmerged {a[1]:.3f}",
                   a[0] == 0.5 and len(merged.points) == 2 and abs(a[1] - 1 / 1001) < 1e-12
                   and merged.notes == ("999 exact duplicates of points merged",))


@case(23, "coordinates that are NaN or infinite", "one error that names the file, how many, and the first")
def coordinates_that_are_no_numbers() -> Outcome:
    """Nothing is left out silently: a hole in a file is told with its index."""
    points = np.zeros((5, 3))
    points[:, 0] = range(5)
    messages = []
    for bad in (math.nan, math.inf, -math.inf):
        points[3, 1] = bad
        messages.append(complaint(points))
    clear = [m.startswith("cloud.npz: points: 1 value out of range") and "[3, 1]" in m and "\n" not in m
             for m in messages]
    return Outcome("; ".join(messages[:2]), all(clear))


@case(24, "normals of zero length, and of length 2", "one error with the first; made unit, with their number")
def normals_that_are_not_unit() -> Outcome:
    """Zero has no direction to scale; what has one is scaled, also where its square would under- or overflow."""
    points, normals = np.eye(3), np.tile((0.0, 0.0, 1.0), (3, 1))
    zero, long = normals.copy(), normals.copy()
    zero[1] = 0
    long[0], long[2] = (0, 0, 2), (1e-200, 0, 1e-200)
    message, scene = complaint(points, zero), loaded(points, long)
    assert scene.normals is not None
    off = float(np.abs(np.linalg.norm(scene.normals, axis=1) - 1).max())
    return Outcome(f"{message}; {'; '.join(scene.notes)}, off by {off:.1e}",
                   "no normal of zero length" in message and "[1]" in message and off <= 4e-16
                   and scene.notes == ("2 normals were scaled to length 1",))
