"""Clouds in .npz files: what is read, what is repaired and said, and each kind of bad one."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.errors import FileError
from jaart.core.io import load
from jaart.core.io.cloud_values import first_of_each
from jaart.core.scene import Scene

RNG = np.random.default_rng(3)
POINTS = RNG.uniform(-1, 1, (20, 3))
NORMALS = RNG.normal(size=(20, 3))
NORMALS /= np.linalg.norm(NORMALS, axis=1)[:, None]


def saved(folder: Path, **arrays: object) -> Path:
    path = folder / "x.npz"
    np.savez_compressed(path, **arrays)
    return path


def problem(path: Path, frame: int | None = None) -> str:
    with pytest.raises(FileError) as caught:
        load(path, frame)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("kind", ["<f8", ">f8", "<f4"])
def test_points_and_normals(tmp_path: Path, order: str, kind: str) -> None:
    points = np.array(POINTS, dtype=kind, order=order)
    scene = load(saved(tmp_path, points=points, normals=np.array(NORMALS, dtype=kind, order=order)))
    assert (scene.kind, scene.levels, scene.model, scene.notes) == ("cloud", None, None, ())
    assert scene.points is not None and scene.normals is not None
    assert np.array_equal(scene.points, points) and scene.points.dtype == np.float64
    assert not scene.points.flags.writeable and not scene.normals.flags.writeable
    assert np.abs(scene.normals - NORMALS).max() < (1e-7 if kind == "<f4" else 1e-15)
    assert np.abs(np.linalg.norm(scene.normals, axis=1) - 1).max() < 4e-16


def test_points_alone_and_whole_numbers(tmp_path: Path) -> None:
    scene = load(saved(tmp_path, points=np.arange(12).reshape(4, 3)))
    assert scene.normals is None
    assert scene.points is not None and scene.points.tolist() == np.arange(12.0).reshape(4, 3).tolist()
    assert len(load(saved(tmp_path, points=[[1.0, 2, 3]])).points) == 1


def test_other_arrays_are_left_out_and_named(tmp_path: Path) -> None:
    assert load(saved(tmp_path, points=POINTS, scan=np.zeros(20))).notes == ("array scan left out",)
    words = np.array(["a", "b"])
    assert load(saved(tmp_path, points=POINTS, scan=[1], names=words)).notes == ("arrays scan, names left out",)


def test_exact_duplicates_are_merged_into_the_first(tmp_path: Path) -> None:
    points = np.array([[1.0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 1, 0], [1, 0, 0], [-0.0, 1, 0]])
    normals = np.eye(3)[[0, 1, 2, 2, 0, 1, 2]]
    scene = load(saved(tmp_path, points=points, normals=normals))
    assert scene.points is not None and scene.normals is not None
    assert scene.points.tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert scene.normals.tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert scene.merged == 4 and scene.notes == ("4 exact duplicates of points merged",)


@given(st.lists(st.tuples(*[st.integers(0, 2)] * 3), min_size=1, max_size=40))
def test_the_first_of_each_as_a_dictionary_finds_them(places: list[tuple[int, int, int]]) -> None:
    firsts = [places.index(place) for place in dict.fromkeys(places)]
    assert first_of_each(np.array(places, dtype=float)).tolist() == firsts


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e101])
def test_coordinates_that_are_not_finite(tmp_path: Path, value: float) -> None:
    points = POINTS.copy()
    points[7, 1] = points[9, 2] = value
    text = problem(saved(tmp_path, points=points))
    assert "points: 2 values out of range" in text and f"{value:g} at [7, 1]" in text and "finite" in text


def test_normals_of_other_lengths_are_scaled_and_counted(tmp_path: Path) -> None:
    normals = NORMALS.copy()
    normals[3] *= 7
    normals[5] *= 1e-200
    normals[6] *= 1e200
    normals[8] *= 1 + 1e-5
    scene = load(saved(tmp_path, points=POINTS, normals=normals))
    assert scene.normals is not None and np.abs(scene.normals - NORMALS).max() < 1e-15
    assert scene.notes == ("3 normals were scaled to length 1",)


def test_normals_of_no_direction(tmp_path: Path) -> None:
    for value, words in ((0.0, "no normal of zero length"), (np.nan, "finite components")):
        normals = NORMALS.copy()
        normals[4] = value
        text = problem(saved(tmp_path, points=POINTS, normals=normals))
        assert "normals: " in text and "[4" in text and words in text


@pytest.mark.parametrize(("arrays", "words"), [
    ({"points": np.empty((0, 3))}, "holds no points"),
    ({"points": POINTS[:, :2]}, "has shape (20, 2); expected (N, 3)"),
    ({"points": POINTS[0]}, "has shape (3,); expected (N, 3)"),
    ({"points": POINTS[None]}, "expected (N, 3)"),
    ({"points": POINTS.astype(str)}, "expected plain numbers"),
    ({"points": POINTS, "normals": NORMALS[1:]}, "has 19 for 20 points"),
    ({"points": POINTS, "normals": NORMALS[:, 0]}, "has shape (20,); expected (N, 3)"),
    ({"points": [[0.0, 0, 0], [1e-101, 0, 0]]}, "expected a cloud larger than 1e-100"),
])
def test_arrays_of_the_wrong_kind_are_named(tmp_path: Path, arrays: dict[str, object], words: str) -> None:
    text = problem(saved(tmp_path, **arrays))
    assert list(arrays)[-1] in text and words in text


def test_a_cloud_is_no_series(tmp_path: Path) -> None:
    assert "frame 1: holds 1 frame" in problem(saved(tmp_path, points=POINTS), 1)


def test_coordinates_too_far_out_for_their_type_are_said(tmp_path: Path) -> None:
    far = POINTS + 6e6
    assert load(saved(tmp_path, points=far)).notes == ()
    notes = load(saved(tmp_path, points=far.astype(np.float32))).notes
    assert "float32 stores them in steps of 0.5" in notes[0]
    assert "float64 stores them in steps of 0.00012" in load(saved(tmp_path, points=POINTS + 1e12)).notes[0]


def with_nan(values: np.ndarray) -> np.ndarray:
    changed = values.copy()
    changed[2, 1] = np.nan
    return changed


def test_what_a_scene_may_hold() -> None:
    levels = np.full((2, 2, 2), 0.5)
    for held in ({}, {"levels": levels, "points": POINTS}, {"levels": levels, "normals": NORMALS}):
        with pytest.raises(FileError):
            Scene("x", **held)
    for points in (POINTS[:0], POINTS[0], with_nan(POINTS)):
        with pytest.raises(FileError, match="points"):
            Scene("x", points=points)
    for normals in (NORMALS[1:], 2 * NORMALS, with_nan(NORMALS)):
        with pytest.raises(FileError, match="normals"):
            Scene("x", points=POINTS, normals=normals)


def _valid() -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, points=POINTS.astype(np.float32), normals=NORMALS)
    return buffer.getvalue()


VALID = _valid()


@given(st.lists(st.tuples(st.integers(0, len(VALID) - 1), st.integers(0, 255)), min_size=1, max_size=4),
       st.integers(0, len(VALID)))
def test_damage_gives_a_scene_or_an_error(tmp_path_factory: pytest.TempPathFactory,
                                          changes: list[tuple[int, int]], end: int) -> None:
    content = bytearray(VALID)
    for at, value in changes:
        content[at] = value
    path = tmp_path_factory.getbasetemp() / "damaged-cloud.npz"
    path.write_bytes(content if end % 2 else content[:end])
    try:
        assert isinstance(load(path), Scene)
    except FileError as error:
        assert str(path) in str(error)


@pytest.mark.parametrize(("name", "count", "note"), [
    ("dragon_full", 435_545, "2100 exact duplicates of points merged"),
    ("bunny_rangescans", 362_272, "arrays scan, scan_names left out"),
    ("kinect_table_241407", 241_407, "arrays pixel, image_size left out")])
def test_measured_clouds(data, name: str, count: int, note: str) -> None:
    scene = load(data(f"clouds/{name}.npz"))
    assert scene.points is not None and len(scene.points) == count
    assert scene.notes == (note,)
