"""A metamorphic law of rays: from both ends, and from between, a ray meets a surface in the same places."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaart.core.chosen import chosen
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere, Torus
from tests.core.cloud_scenes import sphere, torus, unit
from tests.extreme.law_scenes import SEEDS, TIGHT, Array

#: Wendland's weight ends by itself, so that no neighbourhood cuts f off and a root is one in whichever cell or ball.
CONTINUOUS = Settings(weight="wendland", tolerance=TIGHT, max_iterations=60)
#: Roots closer to each other than this, in h, are left out: they are one from the end that grazes past the other.
APART = 0.1
WAYS = st.sampled_from((("tangent", "iterate"), ("tangent", "secant"), ("tangent", "newton"), ("tangent", "safe"),
                        ("polynomial", "secant"), ("polynomial", "safe"), ("projection", "safe")))


@cache
def scene_of(name: str) -> tuple[Scene, Array, float]:
    """A scene of one solid, the solid's middle, and a length that reaches from there beyond it."""
    if name == "ball of cells":
        return Scene(name, model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), 20)), np.full(3, 10.0), 6.0
    if name == "ring of cells":
        ring = Torus((0.5, 0.5, 0.5), (0.0, 0.0, 1.0), 0.27, 0.13)
        return Scene(name, model=Model((ring,), 24)), np.full(3, 12.0), 10.0
    points, normals = sphere(400) if name == "ball of points" else torus(1500)
    return Scene(name, points=points, normals=normals), np.zeros(3), 1.5


def through(name: str, seed: int, share: float) -> tuple[Array, Array, float]:
    """Rays through a scene's middle parts, as two ends (30, 3) each and their distance; share: of the solid's size."""
    _, middle, reach = scene_of(name)
    rng = np.random.default_rng(seed)
    ways, places = unit(rng.normal(size=(30, 3))), middle + share * reach * rng.uniform(-1, 1, (30, 3))
    return places - 3 * reach * ways, places + 3 * reach * ways, 6 * reach


def first(scene: Scene, chosen_ones: Settings, origins: Array, directions: Array) -> Array:
    """t of the first hits (R,), NaN for none."""
    return render(scene, chosen_ones, rays=(origins, directions)).t


@settings(max_examples=8)
@given(SEEDS, WAYS)
@pytest.mark.parametrize("name", ["ball of cells", "ball of points"])
def test_a_convex_surface_is_entered_where_a_reversed_ray_leaves_it(name: str, seed: int,
                                                                    way: tuple[str, str]) -> None:
    scene = scene_of(name)[0]
    one, other, far = through(name, seed, 0.2)
    ways, tried = (other - one) / far, CONTINUOUS.replace(method=way[0], search=way[1])
    enter, leave = first(scene, tried, one, ways), far - first(scene, tried, other, -ways)
    between = one + ((enter + leave) / 2)[:, None] * ways
    ahead, behind = first(scene, tried, between, ways), first(scene, tried, between, -ways)
    assert (leave - enter > 0.5 * scene_of(name)[2]).all()
    half, within = (leave - enter) / 2, arrived(scene, tried, far)
    assert np.abs(ahead - half).max() <= within and np.abs(behind - half).max() <= within


def arrived(scene: Scene, tried: Settings, far: float) -> float:
    """How far apart searches from two sides may end: the tolerance before and behind, and the rounding of places."""
    return 2 * TIGHT * chosen(scene, tried).h + 8 * float(np.spacing(far))


def roots(scene: Scene, tried: Settings, origins: Array, directions: Array, gap: float) -> list[list[float]]:
    """All t at which rays meet a surface, each search begun a gap behind the hit before."""
    found: list[list[float]] = [[] for _ in origins]
    t, going = np.zeros(len(origins)), np.arange(len(origins))
    while len(going):
        hit = first(scene, tried, origins[going] + t[going, None] * directions[going], directions[going])
        met = ~np.isnan(hit)
        for ray, more in zip(going[met], hit[met], strict=True):
            found[ray].append(float(t[ray] + more))
            t[ray] += more + gap
        going = going[met]
    return found


@settings(max_examples=6)
@given(SEEDS, st.sampled_from(("tangent", "polynomial")))
@pytest.mark.parametrize("name", ["ring of cells", "ring of points"])
def test_all_hits_of_a_ray_are_those_of_the_reversed_ray(name: str, seed: int, method: str) -> None:
    scene = scene_of(name)[0]
    tried = CONTINUOUS.replace(method=method, search="safe")
    one, other, far = through(name, seed, 0.4)
    ways, h = (other - one) / far, chosen(scene, tried).h
    there = roots(scene, tried, one, ways, 0.01 * h)
    back = [[far - t for t in reversed(ts)] for ts in roots(scene, tried, other, -ways, 0.01 * h)]
    clear = [k for k in range(30) if min(np.diff(there[k] or [0, far]).min(), np.diff(back[k] or [0, far]).min())
             > APART * h]
    assert len(clear) >= 27 and max(len(there[k]) for k in clear) >= 4
    for k in clear:
        assert len(there[k]) == len(back[k]) and len(there[k]) % 2 == 0
        assert np.abs(np.subtract(there[k], back[k])).max(initial=0.0) <= arrived(scene, tried, far)
