"""Pictures: the light models against numbers worked out by hand, false colours and their scales."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from jaart.core import colours, phong, shade
from jaart.core.camera import Camera
from jaart.core.colours import BACKGROUND, COLOURS, NO_VALUE, TABLE, coloured
from jaart.core.errors import SettingsError
from jaart.core.maps import MAPS, limits, scale
from jaart.core.records import STATUS, STATUS_NAMES, Hits, Quality
from jaart.core.settings import Settings

Array = NDArray[np.float64]


def make_hits(normals: list[tuple[float, float, float]], size: tuple[int, int] | None = None,
              **columns: object) -> Hits:
    """Rays that look down from (0, 0, 10) and hit (0, 0, 0); a normal of zeros makes a background ray."""
    n = len(normals)
    normal = np.array(normals, dtype=float)
    hit = np.asarray(normal.any(axis=1))
    normal[~hit] = np.nan
    t = np.where(hit, 10.0, np.nan)
    origin, direction = np.tile([0.0, 0.0, 10.0], (n, 1)), np.tile([0.0, 0.0, -1.0], (n, 1))
    ones = hit.astype(np.int32)
    status = np.where(hit, STATUS["converged"], STATUS["background"]).astype(np.uint8)
    hits = Hits(origin=origin, direction=direction, t=t, point=origin + t[:, None] * direction, normal=normal,
                energy=t * 0, off_centre=t * 0.01, iterations=ones, evaluations=ones, neighbours=ones, cells=ones,
                lowered=0 * ones, gap=np.full(len(ones), np.nan), status=status, starts=ones,
                eigenvectors=0 * ones, gradients=0 * ones, settings=Settings(), size=size)
    return dataclasses.replace(hits, **columns)  # type: ignore[arg-type]


def tilted(degrees: float) -> tuple[float, float, float]:
    """A normal turned away from the viewer about y."""
    return math.sin(math.radians(degrees)), 0.0, math.cos(math.radians(degrees))


def linear(colour: NDArray[np.uint8]) -> Array:
    """Linear light of sRGB bytes."""
    c = colour / 255
    light: Array = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    return light


def test_diffuse_is_blue_by_the_cosine() -> None:
    picture = shade.shade(make_hits([(0, 0, 1), tilted(60), (0, 0, -1), (0, 0, 0)]),
                          settings=Settings(shading="diffuse"))
    assert picture[0, :3].tolist() == [[0, 0, 255], [0, 0, 128], [0, 0, 255]]
    assert tuple(picture[0, 3]) == BACKGROUND["light"]


def test_phong_headlight_adds_up_its_three_parts() -> None:
    angle = 20.0
    parts = {"ambient": 0.0, "diffuse": 0.0, "specular": 0.0}
    hits = make_hits([tilted(angle)])

    def light(**values: float) -> Array:
        return linear(shade.shade(hits, settings=Settings(**{**parts, **values}, shininess=5))[0, 0])  # type: ignore[arg-type]

    cosine, mirrored = math.cos(math.radians(angle)), math.cos(math.radians(2 * angle))
    assert light() == pytest.approx(0, abs=1e-3)
    assert light(ambient=0.5) == pytest.approx(0.5 * phong.WATER, abs=5e-3)
    assert light(diffuse=0.5) == pytest.approx(0.5 * cosine * phong.WATER, abs=5e-3)
    assert light(specular=0.5) == pytest.approx(np.full(3, 0.5 * mirrored ** 5), abs=5e-3)


def test_normals_are_turned_to_the_viewer() -> None:
    for about in (Settings(), Settings(light=(5, 2, 9)), Settings(shading="diffuse", light=(5, 2, 9))):
        there, back = tilted(30), tuple(-c for c in tilted(30))
        picture = shade.shade(make_hits([there, back]), settings=about)  # type: ignore[list-item]
        assert (picture[0, 0] == picture[0, 1]).all()


def test_a_light_that_stands_aside() -> None:
    settings = Settings(light=(10, 0, 0), ambient=0, diffuse=1, specular=0)
    picture = shade.shade(make_hits([tilted(30), tilted(-30), (0, 0, 1)]), settings=settings)[0]
    assert linear(picture[0]) == pytest.approx(0.5 * phong.WATER, abs=5e-3)
    assert picture[1:].tolist() == [[0, 0, 0]] * 2
    mirror = settings.replace(light=(7, 0, 7), diffuse=0, specular=1, shininess=1000)
    bright = shade.shade(make_hits([tilted(22.5), tilted(30)]), settings=mirror)[0]
    assert bright[0].tolist() == [255] * 3 and bright[1].max() < 20


def test_the_default_light_clips_nothing_and_leaves_nothing_black() -> None:
    picture = shade.shade(make_hits([tilted(a) for a in np.linspace(0, 90, 91)]))[0]
    assert picture.max() < 255
    assert (picture[:, 2] > 60).all()
    assert (np.diff(picture.sum(axis=1, dtype=int)) <= 0).all()
    assert len(np.unique(picture, axis=0)) > 80


def test_another_light_needs_no_new_hits() -> None:
    hits = make_hits([tilted(10)])
    assert (shade.shade(hits, settings=hits.settings) == shade.shade(hits)).all()
    assert (shade.shade(hits, settings=hits.settings.replace(ambient=1.0)) != shade.shade(hits)).any()


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("map", MAPS)
def test_every_map_has_a_picture_of_the_right_size(map: str, theme: str) -> None:
    hits = make_hits([(0, 0, 1), (0, 0, 0), tilted(40), tilted(80), (0, 0, 0), (0, 0, 1)], size=(3, 2))
    picture = shade.shade(hits, map, None, theme)
    assert picture.shape == (2, 3, 3) and picture.dtype == np.uint8
    assert tuple(picture[0, 1]) == BACKGROUND[theme] == tuple(picture[1, 1])
    assert tuple(picture[0, 0]) != BACKGROUND[theme]
    assert len(MAPS[map].values(hits, None)) == 6


@pytest.mark.parametrize("map", MAPS)
def test_no_rays_and_no_hits_are_pictures_too(map: str) -> None:
    assert shade.shade(make_hits([(0, 0, 0)]), map).shape == (1, 1, 3)
    assert shade.shade(dataclasses.replace(make_hits([(0, 0, 0)]), **{
        f.name: getattr(make_hits([(0, 0, 0)]), f.name)[:0] for f in dataclasses.fields(Hits)
        if isinstance(getattr(make_hits([(0, 0, 0)]), f.name), np.ndarray)}), map).shape == (1, 0, 3)


def test_states_have_their_own_colours() -> None:
    status = np.arange(len(STATUS_NAMES), dtype=np.uint8)
    picture = shade.shade(make_hits([(0, 0, 1)] * len(status), status=status), "status", theme="dark")[0]
    expected = {**COLOURS, "background": BACKGROUND["dark"]}
    assert [tuple(c) for c in picture] == [expected[name] for name in STATUS_NAMES]
    assert len({tuple(c) for c in picture}) == len(STATUS_NAMES) == len(COLOURS)


def test_a_false_hit_has_no_error_but_is_seen() -> None:
    nan = math.nan
    q = Quality(0, 0, 0, 2, 1, 0, 0, distance=np.array([0.1, nan, nan]), angle=np.array([3.0, nan, nan]))
    hits = make_hits([(0, 0, 1), (0, 0, 1), (0, 0, 0)])
    for name in ("distance_error", "normal_error"):
        picture = shade.shade(hits, name, q)[0]
        assert tuple(picture[1]) == NO_VALUE
        assert tuple(picture[0]) not in (NO_VALUE, BACKGROUND["light"])
        assert tuple(picture[2]) == BACKGROUND["light"]


def test_rays_that_took_no_step_have_no_iterations() -> None:
    hits = make_hits([(0, 0, 1), (0, 0, 0), (0, 0, 0)], iterations=np.array([3, 0, 20], np.int32),
                     evaluations=np.array([3, 0, 25], np.int32))
    assert MAPS["iterations"].values(hits, None)[[0, 2]].tolist() == [3, 20]
    assert np.isnan(MAPS["evaluations"].values(hits, None)).tolist() == [False, True, False]


def test_unknown_names_are_refused() -> None:
    hits = make_hits([(0, 0, 1)])
    with pytest.raises(SettingsError, match="no map is called 'heat'; there are shaded, iterations"):
        shade.shade(hits, "heat")
    with pytest.raises(SettingsError, match="no map is called"):
        scale("heat", hits)
    with pytest.raises(SettingsError, match="no theme is called 'pink'; there are light, dark"):
        shade.shade(hits, theme="pink")


def test_scales_are_round_and_robust() -> None:
    values = np.concatenate([np.linspace(0, 0.27, 99), [50.0]])
    assert limits(values) == (0, 0.3)
    assert limits(np.array([3.0, 4.0, 9.0]), whole=True) == (0, 9)
    assert limits(np.array([101.0, 107.0]), zero=False) == pytest.approx((101, 107))
    assert limits(np.array([-7.1, -1.2]), zero=False) == pytest.approx((-8, -1))
    assert limits(np.array([math.nan])) == (0, 1)
    assert limits(np.array([5.0, 5.0]), zero=False) == (5, 6)
    assert limits(np.zeros(4)) == limits(np.full(4, 1e-15)) == (0, 1)
    assert scale("shaded", make_hits([(0, 0, 1)])) == (0, 1)
    assert scale("status", make_hits([(0, 0, 1)])) == (0, len(STATUS_NAMES) - 1)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=30), st.booleans())
def test_limits_hold_the_values(numbers: list[float], whole: bool) -> None:
    values = np.array(numbers)
    low, high = limits(values, zero=False, whole=whole)
    assert low < high
    slack = 2e-9 * (high - low)
    assert low <= values.min() + slack
    assert (values <= high + slack).mean() > 0.9


def test_the_table_rises_from_dark_to_bright() -> None:
    brightness = linear(TABLE) @ [0.2126, 0.7152, 0.0722]
    assert TABLE.shape == (256, 3) and not TABLE.flags.writeable
    assert (np.diff(brightness) > -2e-3).all() and brightness[-1] > 0.75 > 0.05 > brightness[0]
    first, last = TABLE[0].tolist(), TABLE[255].tolist()
    assert coloured(np.array([-1.0, 0.0, 1.0, 2.0]), 0, 1).tolist() == [first, first, last, last]
    assert coloured(np.array([5.0]), 5, 5).tolist() == [TABLE[0].tolist()]


def test_shading_a_cameras_picture_keeps_its_rows() -> None:
    size = (4, 3)
    origin, direction = Camera(eye=(0, -10, 0), target=(0, 0, 0)).rays(size)
    normal = np.zeros((12, 3))
    normal[5] = (0, -1, 0)
    hits = make_hits([tuple(n) for n in normal], size, origin=origin, direction=direction)
    lit = (shade.shade(hits) != BACKGROUND["light"]).any(axis=2)
    assert np.argwhere(lit).tolist() == [[1, 1]]
    assert colours.BACKGROUND is shade.BACKGROUND
