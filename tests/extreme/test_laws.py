"""Metamorphic laws: what a change of a scene must do to its hits, for any settings and random scenes.

A scene scaled by 2^k, moved by what coordinates hold exactly, with duplicates, or traced by more threads gives the
same bits. Mirrored, turned by right angles or with its points in another order it differs by the order of sums alone.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaart.core.io.cloud_values import cloud as read_cloud
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from tests.extreme import law_scenes as law
from tests.extreme.law_scenes import LOOSE, SEEDS, TIGHT, Array, Setup, cloud_settings, hits, lattice_settings

TOLERANCES = st.sampled_from((LOOSE, TIGHT))
BARE = st.booleans()
#: The 48 ways to map the axes onto each other: which becomes which, and which are turned round.
IMAGES = st.tuples(st.permutations((0, 1, 2)), st.tuples(*[st.sampled_from((1.0, -1.0))] * 3))
Image = tuple[tuple[int, ...], tuple[float, ...]]


def moved(setup: Setup, to: Any) -> Setup:
    """A cloud and its rays with a mapping of places applied."""
    return Setup(Scene("moved", points=to(setup.scene.points), normals=setup.scene.normals),
                 (to(setup.rays[0]), setup.rays[1]))


@settings(max_examples=25)
@given(SEEDS, BARE, TOLERANCES.flatmap(cloud_settings), st.integers(-300, 300))
def test_a_cloud_scaled_by_a_power_of_two_gives_the_same_bits(seed: int, bare: bool, chosen: Settings, k: int) -> None:
    setup = law.cloud(seed, bare)
    one, other = hits(setup, chosen), hits(moved(setup, lambda x: np.ldexp(x, k)), chosen)
    unscaled = replace(other, t=np.ldexp(other.t, -k), off_centre=np.ldexp(other.off_centre, -k))
    law.same_bits(one, unscaled, *(name for name in law.COLUMNS if name != "energy"), "cells")
    assert np.array_equal(one.point, np.ldexp(other.point, -k), equal_nan=True)


@settings(max_examples=12)
@given(SEEDS, TOLERANCES.flatmap(lattice_settings), st.integers(-1000, 1000), st.sampled_from(((1, 1, 1), (1, 2, 0.7))))
def test_a_lattice_of_scaled_spacing_gives_the_same_bits(seed: int, chosen: Settings, k: int,
                                                         spacing: tuple[float, float, float]) -> None:
    setup = law.lattice(seed, spacing)
    x, y, z = np.ldexp(spacing, k).tolist()
    other = Setup(Scene("scaled", levels=setup.scene.levels, spacing=(x, y, z)), setup.rays)
    law.same_bits(hits(setup, chosen), hits(other, chosen), *law.COLUMNS, "point", "cells")


@settings(max_examples=15)
@given(SEEDS, BARE, TOLERANCES.flatmap(cloud_settings), st.tuples(*[st.integers(-2**20, 2**20)] * 3))
def test_a_cloud_moved_without_rounding_gives_the_same_bits(seed: int, bare: bool, chosen: Settings,
                                                            by: tuple[int, int, int]) -> None:
    """By whole numbers, multiples of the coarse grid on which the frame's origin lies."""
    setup = law.cloud(seed, bare)
    one, other = hits(setup, chosen), hits(moved(setup, lambda x: x + by), chosen)
    law.same_bits(one, other, *law.COLUMNS, "cells")
    assert np.nanmax(np.abs(one.point + by - other.point), initial=0.0) <= np.spacing(2.0**20)


@settings(max_examples=15)
@given(SEEDS, BARE, cloud_settings(TIGHT), st.integers(0, 9), st.tuples(*[st.floats(-1, 1)] * 3))
def test_a_cloud_moved_anywhere_differs_by_ulps_of_the_way(seed: int, bare: bool, chosen: Settings, power: int,
                                                           way: tuple[float, float, float]) -> None:
    """Points and rays lose what the larger coordinates cannot hold, half an ulp each; nothing more is lost."""
    setup, by = law.cloud(seed, bare), 10.0**power * np.array(way)
    one, other = hits(setup, chosen), hits(moved(setup, lambda x: x + by), chosen)
    law.same_but_for_rounding(one, other, setup, blur=float(np.spacing(np.abs(by).max() + 3)))


@settings(max_examples=12)
@given(SEEDS, TOLERANCES.flatmap(lattice_settings), st.tuples(*[st.integers(-2, 2)] * 3))
def test_a_lattice_moved_by_cells_gives_the_same_bits(seed: int, chosen: Settings, by: tuple[int, int, int]) -> None:
    setup = law.lattice(seed)
    rolled = Scene("rolled", levels=np.roll(setup.scene.levels, by, (0, 1, 2)))  # type: ignore[arg-type]
    law.same_bits(hits(setup, chosen), hits(Setup(rolled, (setup.rays[0] + by, setup.rays[1])), chosen))


@settings(max_examples=10)
@given(SEEDS, TOLERANCES.flatmap(lattice_settings), st.tuples(*[st.tuples(st.integers(0, 6), st.integers(0, 6))] * 3))
def test_a_lattice_with_more_empty_cells_gives_the_same_bits(seed: int, chosen: Settings, by: Any) -> None:
    setup, before = law.lattice(seed), [first for first, _ in by]
    padded = Scene("padded", levels=np.pad(setup.scene.levels, by))  # type: ignore[arg-type]
    law.same_bits(hits(setup, chosen), hits(Setup(padded, (setup.rays[0] + before, setup.rays[1])), chosen))


@settings(max_examples=20)
@given(SEEDS, cloud_settings(TIGHT), IMAGES)
def test_an_image_of_a_cloud_has_the_images_of_its_hits(seed: int, chosen: Settings, image: Image) -> None:
    """But for the sums' order, in which the points of other cells of the grid come first."""
    setup, (axes, signs) = law.cloud(seed), image

    def turned(x: Array) -> Array:
        return np.array(x[:, axes] * signs)

    scene = setup.scene
    assert scene.points is not None and scene.normals is not None
    other = Setup(Scene("image", points=turned(scene.points), normals=turned(scene.normals)),
                  (turned(setup.rays[0]), turned(setup.rays[1])))
    one = hits(setup, chosen)
    law.same_but_for_rounding(replace(one, normal=turned(one.normal), direction=other.rays[1]), hits(other, chosen),
                              setup)


def lattice_image(setup: Setup, image: Image) -> Setup:
    """The lattice with its axes mapped, and its rays."""
    axes, signs = image
    levels, (origins, directions) = setup.scene.levels, setup.rays
    assert levels is not None
    flipped = [slice(None, None, int(sign)) for sign in signs]
    size = np.array([levels.shape[axis] for axis in axes])
    origins = np.where(np.array(signs) < 0, size - origins[:, axes], origins[:, axes])
    return Setup(Scene("image", levels=levels.transpose(axes)[tuple(flipped)]), (origins, directions[:, axes] * signs))


@settings(max_examples=15)
@given(SEEDS, lattice_settings(TIGHT), IMAGES)
def test_an_image_of_a_lattice_has_the_images_of_its_hits(seed: int, chosen: Settings, image: Image) -> None:
    setup = law.lattice(seed)
    other, one = lattice_image(setup, image), hits(setup, chosen)
    normal = one.normal[:, image[0]] * image[1]
    law.same_but_for_rounding(replace(one, normal=normal, direction=other.rays[1]), hits(other, chosen), setup)


@settings(max_examples=20)
@given(SEEDS, BARE, cloud_settings(TIGHT), SEEDS)
def test_points_in_another_order_change_the_order_of_sums_alone(seed: int, bare: bool, chosen: Settings,
                                                                shuffle: int) -> None:
    setup = law.cloud(seed, bare)
    points, normals = setup.scene.points, setup.scene.normals
    assert points is not None
    order = np.random.default_rng(shuffle).permutation(len(points))
    other = Scene("shuffled", points=points[order], normals=None if normals is None else normals[order])
    law.same_but_for_rounding(hits(setup, chosen), hits(Setup(other, setup.rays), chosen), setup)


@settings(max_examples=10)
@given(SEEDS, BARE, TOLERANCES.flatmap(cloud_settings), st.lists(st.integers(0, 249), min_size=1, max_size=300))
def test_duplicates_are_merged_and_change_no_bit(seed: int, bare: bool, chosen: Settings, again: list[int]) -> None:
    setup = law.cloud(seed, bare)
    points, normals = setup.scene.points, setup.scene.normals
    assert points is not None
    twice = np.append(np.arange(len(points)), again)
    with_duplicates = read_cloud("twice", points[twice], None if normals is None else normals[twice])
    assert with_duplicates.merged == len(again)
    assert f"{len(again)} exact duplicate" in with_duplicates.notes[-1]
    once = Setup(read_cloud("once", points, normals), setup.rays)
    law.same_bits(hits(once, chosen), hits(Setup(with_duplicates, setup.rays), chosen), *law.COLUMNS, "point", "cells")


@settings(max_examples=6)
@given(SEEDS, BARE, TOLERANCES.flatmap(cloud_settings))
def test_any_number_of_threads_gives_the_same_bits_in_a_cloud(seed: int, bare: bool, chosen: Settings) -> None:
    """What balls need is gathered by whichever thread asks first: each picture begins with nothing gathered."""
    same_for_all_threads(lambda: law.cloud(seed, bare).scene, chosen)


@settings(max_examples=6)
@given(SEEDS, TOLERANCES.flatmap(lattice_settings))
def test_any_number_of_threads_gives_the_same_bits_in_a_lattice(seed: int, chosen: Settings) -> None:
    same_for_all_threads(lambda: law.lattice(seed).scene, chosen)


@pytest.mark.parametrize("method", ["isosurface", "fill_level"])
def test_any_number_of_threads_gives_the_same_bits_on_a_mesh(method: str) -> None:
    same_for_all_threads(lambda: law.lattice(4).scene, Settings(method=method))


def same_for_all_threads(scene: Any, chosen: Settings) -> None:
    """Pictures of 24 x 24 rays in tiles of 50, so that there is work for every thread."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("jaart.core.tiles.TILE", 50)
        found: list[Hits] = [render(scene(), chosen, size=(24, 24), threads=threads) for threads in (1, 2, 3, 4)]
    for other in found[1:]:
        law.same_bits(found[0], other, *law.COLUMNS, "point", "cells")
