"""Cameras: pixel centres, up, projection, the whole scene in view, errors in words."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from jaart.core.camera import Camera, check_distance, parse
from jaart.core.errors import RayError

FRONT = Camera(eye=(0, -10, 0), target=(0, 0, 0), fov=90)
number = st.floats(-100, 100)
vector = st.tuples(number, number, number)


def test_rays_go_through_pixel_centres_row_by_row_from_the_top() -> None:
    origins, directions = FRONT.rays((2, 2))
    expected = np.array([(-1, 2, 1), (1, 2, 1), (-1, 2, -1), (1, 2, -1)]) / math.sqrt(6)
    assert origins == pytest.approx(np.tile([0.0, -10, 0], (4, 1)))
    assert directions == pytest.approx(expected)


@pytest.mark.parametrize("size", [(400, 100), (100, 400)])
def test_fov_spans_the_longer_side_and_pixels_are_square(size: tuple[int, int]) -> None:
    _, d = FRONT.rays(size)
    slope = (d[:, [0, 2]] / d[:, 1:2]).reshape(size[1], size[0], 2)
    longer = 0 if size[0] > size[1] else 1
    assert np.abs(slope[..., longer]).max() == pytest.approx(1 - 1 / 400)
    assert np.diff(slope[0, :, 0]) == pytest.approx(2 / 400)
    assert np.diff(slope[:, 0, 1]) == pytest.approx(-2 / 400)


def test_ortho_rays_are_parallel_and_start_a_pixel_apart() -> None:
    origins, directions = FRONT.replace(ortho=8.0).rays((4, 2))
    assert directions == pytest.approx(np.tile([0.0, 1, 0], (8, 1)))
    assert origins[:4] == pytest.approx(np.array([(-3, -10, 1), (-1, -10, 1), (1, -10, 1), (3, -10, 1)]))


def test_the_middle_pixel_looks_at_the_target() -> None:
    camera = Camera(eye=(3, 4, 5), target=(-1, 2, 0.5))
    _, d = camera.rays((3, 3), np.array([4]))
    assert d[0] == pytest.approx(np.array([-4, -2, -4.5]) / math.hypot(4, 2, 4.5))


@settings(max_examples=40, deadline=None)
@given(vector, vector, st.integers(1, 40), st.integers(1, 40), st.floats(1, 170))
def test_directions_have_length_one_and_single_pixels_are_the_pictures(
        eye: tuple[float, float, float], target: tuple[float, float, float], w: int, h: int, fov: float) -> None:
    assume(math.dist(eye, target) > 1e-3)
    camera = Camera(eye=eye, target=target, fov=fov)
    _, directions = camera.rays((w, h))
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1, abs=1e-15)
    some = np.array([0, w * h // 2, w * h - 1])
    assert (camera.rays((w, h), some)[1] == directions[some]).all()


@settings(max_examples=40, deadline=None)
@given(vector, vector)
def test_frame_is_right_handed_and_orthonormal(eye: tuple[float, float, float],
                                               target: tuple[float, float, float]) -> None:
    assume(math.dist(eye, target) > 1e-3)
    axes = np.array(Camera(eye=eye, target=target).frame())
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.cross(axes[0], axes[1]) == pytest.approx(-axes[2], abs=1e-12)


def test_up_is_z_or_y_where_the_view_runs_along_z() -> None:
    assert FRONT.frame()[1] == pytest.approx([0, 0, 1])
    assert Camera(eye=(0, 0, 9), target=(0, 0, 0)).frame()[1] == pytest.approx([0, 1, 0])
    assert Camera(eye=(0, -9, 0), target=(0, 0, 0), up=(5, 0, 0)).frame()[1] == pytest.approx([1, 0, 0])


@pytest.mark.parametrize("extent", [(16, 16, 16), (64, 4, 4), (2, 2, 90)])
@pytest.mark.parametrize("direction", [(0.45, -1, 0.55), (1, 0, 0), (0, 0, 1), (-1, -1, -1)])
@pytest.mark.parametrize("fov", [10.0, 30.0, 100.0])
@pytest.mark.parametrize("size", [(1, 1), (400, 100), (90, 120)])
def test_fit_sees_all_corners(extent: tuple[float, float, float], direction: tuple[float, float, float],
                              fov: float, size: tuple[int, int]) -> None:
    camera = Camera.fit(extent, direction, fov, size)
    right, up, forward = camera.frame()
    edge = math.tan(math.radians(fov) / 2) / max(size)
    for corner in itertools.product(*((0, n) for n in extent)):
        away = np.subtract(corner, camera.eye)
        assert away @ forward > 0
        assert abs(away @ right) <= edge * size[0] * (away @ forward)
        assert abs(away @ up) <= edge * size[1] * (away @ forward)
    assert camera.target == pytest.approx(np.array(extent) / 2)


@pytest.mark.parametrize(("values", "says"), [
    ({"target": (0, -10, 0)}, "same point"), ({"up": (0, 1, 0)}, "up runs along the view"),
    ({"up": (0, 0, 0)}, "up has zero length"),
    ({"fov": 0.0}, "fov = 0"), ({"fov": 180.0}, "fov = 180"), ({"fov": math.nan}, "fov = nan"),
    ({"ortho": 0.0}, "ortho = 0"), ({"ortho": math.inf}, "ortho = inf"), ({"eye": (0, 0)}, "three numbers"),
    ({"eye": (0, 0, math.nan)}, "finite"),
])
def test_a_camera_that_sees_nothing_is_refused(values: dict[str, object], says: str) -> None:
    with pytest.raises(RayError) as error:
        FRONT.replace(**values)
    assert says in str(error.value)


@pytest.mark.parametrize("size", [1e-300, 1e-30, 1e200, 1.7e308])
def test_any_finite_view_has_a_frame(size: float) -> None:
    camera = Camera(eye=(0, -size, 0), target=(0, size, 0), up=(0, 0, size))
    assert np.array(camera.frame()).tolist() == [[1, 0, 0], [0, 0, 1], [0, 1, 0]]


def test_eyes_and_views_beyond_precision_are_refused() -> None:
    near = FRONT.replace(eye=(0, -9.9e14, 0))
    check_distance(near, (0, 0, 0), 1.0)
    check_distance(near.replace(eye=(0, -1e20, 0)), (0, 0, 0), 1e6)
    for camera, name in ((near.replace(eye=(0, -1e15, 0)), "eye = 0,-1e"), (near.replace(ortho=1e15), "ortho = 1e")):
        with pytest.raises(RayError, match=f"camera {name}.*rays from so far have no precision"):
            check_distance(camera, (0, 0, 0), 1.0)
    with pytest.raises(RayError, match=r"expected less than 1e\+09 from the scene"):
        check_distance(near, (0, 0, 0), 1e-6)


def test_parse() -> None:
    camera = parse(["eye=1,2,3", "target=4,5,6", "up=0,1,0", "fov=22", "ortho=9"], FRONT)
    assert camera == Camera(eye=(1, 2, 3), target=(4, 5, 6), up=(0, 1, 0), fov=22, ortho=9)
    assert parse([], FRONT) == FRONT


@pytest.mark.parametrize("text", ["eye", "eye=1,2", "eye=1,2,x", "zoom=3", "fov=wide", "fov=inf", "ortho=-1", "=3"])
def test_parse_refuses(text: str) -> None:
    with pytest.raises(RayError):
        parse([text], FRONT)
