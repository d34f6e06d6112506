"""Rays of numbers that nobody means: each ends by name, and those that do have a meaning are traced as meant.

A direction has a meaning when it is finite and not zero, however long or short: it is scaled to length 1, the least
denormal number and 1e308 too. An origin has one while coordinates near it still tell places in the scene apart.
"""

from __future__ import annotations

import math
import warnings
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings

from jaart.core.errors import RayError
from jaart.core.records import STATUS
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.trace import trace
from tests.core.cloud_scenes import bumpy
from tests.extreme.law_scenes import SEEDS, Array, same_bits

ODD = (math.nan, math.inf, -math.inf, 0.0, -0.0, 5e-324, -5e-324, 1e-310, 1e-300, -1e-300, 1e300, -1e300,
       1.7976931348623157e308, 1.0, -1.0, 8.0, 8.3, 9.2)
SEARCHES = ("iterate", "secant", "newton", "minimise", "march", "safe", "centres")
POINTWISE = (*({"search": name} for name in SEARCHES), {"method": "polynomial", "search": "secant"},
             {"method": "polynomial", "search": "safe"}, {"method": "projection"}, {"method": "mahalanobis"},
             {"method": "off_centre"}, {"method": "angle"}, {"method": "cylinder", "h": 1.2})
MESHES = ({"method": "isosurface"}, {"method": "fill_level"}, {"traversal": "uniform"})
CASES = [*((name, how) for name in ("lattice", "model", "cloud", "bare cloud") for how in POINTWISE),
         *((name, how) for name in ("lattice", "model") for how in MESHES)]
every_case = pytest.mark.parametrize(("name", "how"), CASES, ids=lambda one: one if isinstance(one, str)
                                     else "-".join(str(v) for v in one.values()))
#: A ray at the middle of every scene, between the cells' edges.
ORIGIN, DIRECTION = (8.3, 8.2, 40.0), (0.0, 0.0, -1.0)


@cache
def scene_of(name: str) -> Scene:
    """A ball of about 4 about (8, 8, 8)."""
    if name == "model":
        return Scene(name, model=Model((Sphere((0.5, 0.5, 0.5), 0.25),), 16))
    if name == "lattice":
        far = np.linalg.norm(np.moveaxis(np.indices((16, 16, 16)) - 7.5, 0, -1), axis=-1)
        return Scene(name, levels=np.clip(4.5 - far, 0, 1))
    points, normals = bumpy(400)
    return Scene(name, points=4 * points + 8, normals=None if name == "bare cloud" else normals)


def has_meaning(origin: Array, direction: Array) -> bool:
    """Whether a ray of ODD numbers means something; all of ODD that are finite are near the scene or 1e300 away."""
    return bool(np.isfinite(origin).all() and np.abs(origin).max() < 1e15 and np.isfinite(direction).all()
                and direction.any())


def of_common_length(direction: Array) -> Array:
    """The direction with its largest part at 1 or -1, each part rounded once."""
    parts = [Fraction(float(part)) for part in direction]
    return np.array([float(part / max(abs(p) for p in parts)) for part in parts])


@every_case
@settings(max_examples=3)
@given(SEEDS)
def test_each_ray_of_a_batch_ends_by_name(name: str, how: dict[str, str], seed: int) -> None:
    numbers = np.random.default_rng(seed).choice(ODD, (40, 6))
    scene, tried = scene_of(name), Settings(**how)  # type: ignore[arg-type]
    odd = np.array([*numbers, *((*ORIGIN, *way) for way in np.reshape(numbers, (-1, 3))),
                    *((*place, *DIRECTION) for place in np.reshape(numbers, (-1, 3))), (*ORIGIN, *DIRECTION)])
    origins, directions = odd[:, :3], odd[:, 3:]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = render(scene, tried, rays=(origins, directions))
    good = np.array([has_meaning(o, d) for o, d in zip(origins, directions, strict=True)])
    assert np.array_equal(found.status == STATUS["bad_ray"], ~good)
    assert np.isnan(found.t[~found.hit]).all() and np.isnan(found.point[~found.hit]).all()
    for column in (found.t, found.point, found.normal):
        assert np.isfinite(column[found.hit]).all()
    ordinary = np.array([of_common_length(d) if fine else d for d, fine in zip(directions, good, strict=True)])
    alone = render(scene, tried, rays=(origins, ordinary))
    same_bits(found, alone)
    assert found.hit[-1] or tried.method == "angle"  # whose sheet has holes between so few points


BAD = [((math.nan, 0, 0), DIRECTION, "ray origin [nan, 0.0, 0.0]: expected three finite numbers"),
       ((0, math.inf, 0), DIRECTION, "ray origin [0.0, inf, 0.0]: expected three finite numbers"),
       (ORIGIN, (0, -math.inf, 1), "ray direction [0.0, -inf, 1.0]: expected three finite numbers"),
       (ORIGIN, (math.nan, 1, 1), "ray direction [nan, 1.0, 1.0]: expected three finite numbers"),
       (ORIGIN, (0, -0.0, 0), "ray direction has zero length"),
       ((0, 0, 1e300), DIRECTION, "ray origin [0.0, 0.0, 1e+300]: too far from the scene to have any precision"),
       ((0, -1e300, 0), DIRECTION, "ray origin [0.0, -1e+300, 0.0]: too far from the scene to have any precision")]
FOLLOWED = [("lattice", {}), ("model", {"search": "safe"}), ("model", {"method": "isosurface"}),
            ("lattice", {"method": "fill_level"}), ("lattice", {"method": "cylinder", "h": 1.2}), ("cloud", {}),
            ("bare cloud", {"search": "march"}), ("cloud", {"method": "cylinder", "h": 1.2})]
followed = pytest.mark.parametrize(("name", "how"), FOLLOWED)


@followed
@pytest.mark.parametrize(("origin", "direction", "said"), BAD)
def test_a_ray_without_meaning_cannot_be_followed(name: str, how: dict[str, str], origin: tuple[float, ...],
                                                  direction: tuple[float, ...], said: str) -> None:
    with pytest.raises(RayError) as error:
        trace(scene_of(name), Settings(**how), origin, direction)  # type: ignore[arg-type]
    assert str(error.value).startswith(said) and "\n" not in str(error.value)


@followed
@pytest.mark.parametrize("length", [5e-324, 1e-310, 1e-300, 1e300, 1.7976931348623157e308])
def test_a_direction_of_any_length_is_followed_alike(name: str, how: dict[str, str], length: float) -> None:
    scene, tried = scene_of(name), Settings(**how)  # type: ignore[arg-type]
    usual, odd = trace(scene, tried, ORIGIN, DIRECTION), trace(scene, tried, ORIGIN, (0.0, 0.0, -length))
    assert odd.hit and (odd.t, odd.status, odd.steps) == (usual.t, usual.status, usual.steps)
    assert np.array_equal(odd.direction, DIRECTION)
