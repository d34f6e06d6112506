"""The .npz reader: good files, and each kind of bad one."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core import memory
from jaart.core.errors import FileError
from jaart.core.io import load
from jaart.core.scene import Scene

LEVELS = np.random.default_rng(1).uniform(0.01, 0.99, (3, 4, 5))


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
def test_levels_keep_their_axes(tmp_path: Path, order: str, kind: str) -> None:
    values = np.array(LEVELS, dtype=kind, order=order)
    scene = load(saved(tmp_path, levels=values))
    assert scene.levels is not None
    assert np.array_equal(scene.levels, values)
    assert scene.levels.flags.c_contiguous and not scene.levels.flags.writeable
    assert (scene.kind, scene.frame, scene.frames, scene.time, scene.notes) == ("lattice", 0, 1, None, ())


@pytest.mark.parametrize("order", ["C", "F"])
def test_each_frame_of_a_series(tmp_path: Path, order: str) -> None:
    fill = np.array(np.random.default_rng(2).uniform(0.1, 0.9, (4, 2, 3, 5)), order=order)
    path = saved(tmp_path, fill=fill, time_s=[0, 0.1, 0.2, 0.4], cell_size_m=0.25)
    for frame in range(4):
        scene = load(path, frame)
        assert scene.levels is not None and np.array_equal(scene.levels, fill[frame])
        assert (scene.frame, scene.frames, scene.time) == (frame, 4, [0, 0.1, 0.2, 0.4][frame])
        assert scene.spacing == (0.25, 0.25, 0.25)
    assert load(path).frame == 0


@pytest.mark.parametrize("frame", [-1, 4, 10**9])
def test_no_such_frame(tmp_path: Path, frame: int) -> None:
    assert "expected 0 to 3" in problem(saved(tmp_path, fill=np.full((4, 2, 2, 2), 0.5)), frame)


def test_whole_numbers_and_truths_are_levels(tmp_path: Path) -> None:
    corner = np.zeros((2, 2, 2), dtype=bool)
    corner[0, 1, 0] = True
    for values in (corner, corner.astype(np.uint8), corner.astype(np.int64)):
        scene = load(saved(tmp_path, levels=values))
        assert scene.levels is not None and np.array_equal(scene.levels, corner)


def test_obstacles_count_as_air(tmp_path: Path) -> None:
    solid = LEVELS > 0.5
    scene = load(saved(tmp_path, levels=LEVELS, solid=solid))
    assert scene.levels is not None
    assert np.array_equal(scene.levels, np.where(solid, 0, LEVELS))
    assert not scene.levels.flags.writeable
    assert scene.notes == (f"{solid.sum()} obstacle cells count as air",)
    assert "array 'solid'" in problem(saved(tmp_path, levels=LEVELS, solid=solid[1:]))


def test_overshoot_is_clipped_and_said(tmp_path: Path) -> None:
    values = LEVELS.copy()
    values[0, 0, 0], values[1, 1, 1] = -1e-4, 1 + 9e-4
    scene = load(saved(tmp_path, levels=values))
    assert scene.levels is not None
    assert scene.levels[0, 0, 0] == 0 and scene.levels[1, 1, 1] == 1
    assert scene.notes == ("2 levels up to 0.0009 outside [0, 1] were clipped",)


def test_films_of_a_solver_are_no_interface(tmp_path: Path) -> None:
    values = LEVELS.copy()
    values[0, 0, :4] = 1e-9, 1 - 1e-7, 2e-6, 1 - 2e-6
    scene = load(saved(tmp_path, levels=values))
    assert scene.levels is not None
    assert scene.levels[0, 0, :4].tolist() == [0, 1, 2e-6, 1 - 2e-6]
    assert scene.notes == ("2 levels within 1e-06 of 0 or 1 count as empty or full",)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_values_that_are_not_finite(tmp_path: Path, value: float) -> None:
    values = LEVELS.copy()
    values[2, 1, 3] = values[2, 3, 4] = value
    text = problem(saved(tmp_path, levels=values))
    assert "array 'levels': 2 values not finite" in text and "[2, 1, 3]" in text


@pytest.mark.parametrize("value", [-0.1, 1.1, 255, -1.001e-3])
def test_values_out_of_range(tmp_path: Path, value: float) -> None:
    values = LEVELS.copy()
    values[2, 1, 3] = value
    text = problem(saved(tmp_path, levels=values))
    assert "1 value outside [0, 1]" in text and f"{value:g} at [2, 1, 3]" in text


@pytest.mark.parametrize("arrays", [
    {"levels": LEVELS[0]}, {"levels": LEVELS[None]}, {"levels": 0.5}, {"levels": np.zeros((3, 0, 2))},
    {"levels": LEVELS.astype(str)}, {"levels": LEVELS + 0j}, {"levels": np.zeros((2, 2, 2), "M8[s]")},
    {"levels": np.zeros((2, 2, 2), [("a", "f4")])}, {"fill": LEVELS}, {"fill": np.zeros((0, 2, 2, 2))},
    {"levels": LEVELS, "cell_size_m": 0.0}, {"levels": LEVELS, "cell_size_m": np.nan},
    {"levels": LEVELS, "cell_size_m": [1.0, 2.0]}, {"levels": LEVELS, "time_s": [1.0, 2.0]},
    {"levels": LEVELS, "time_s": np.inf}, {"levels": LEVELS, "cell_size_m": "wide"},
])
def test_arrays_of_the_wrong_kind_are_named(tmp_path: Path, arrays: dict[str, object]) -> None:
    text = problem(saved(tmp_path, **arrays))
    assert f"array {list(arrays)[-1]!r}" in text and "expected" in text


def test_nothing_to_read(tmp_path: Path) -> None:
    assert "holds a, b; expected an array levels" in problem(saved(tmp_path, a=1, b=2))
    assert "holds nothing" in problem(saved(tmp_path))


def test_pickles_are_never_run(tmp_path: Path) -> None:
    witness = tmp_path / "witness"

    class Bomb:
        def __reduce__(self) -> tuple[object, tuple[str, str]]:
            return open, (str(witness), "w")

    path = tmp_path / "x.npz"
    np.savez(path, levels=np.array([[[Bomb()]]], dtype=object))
    assert "expected plain numbers" in problem(path)
    assert not witness.exists()


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 0.999])
def test_truncated_files(tmp_path: Path, share: float) -> None:
    path = saved(tmp_path, levels=LEVELS)
    content = path.read_bytes()
    path.write_bytes(content[:int(share * len(content))])
    assert "is no whole .npz" in problem(path)


def test_an_array_with_too_few_values(tmp_path: Path) -> None:
    buffer = io.BytesIO()
    np.save(buffer, LEVELS)
    path = tmp_path / "x.npz"
    with zipfile.ZipFile(path, "w") as zipped:
        zipped.writestr("levels.npy", buffer.getvalue()[:-8])
    assert "claims shape (3, 4, 5)" in problem(path)


def test_a_huge_claim_takes_no_memory(tmp_path: Path) -> None:
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        buffer, {"descr": "<f8", "fortran_order": False, "shape": (10**5, 10**5, 10**5)})
    path = tmp_path / "x.npz"
    with zipfile.ZipFile(path, "w") as zipped:
        zipped.writestr("levels.npy", buffer.getvalue())
    assert "claims shape (100000, 100000, 100000), which needs 7.11 PiB of memory, but has 0 of" in problem(path)


def test_a_bomb_is_not_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as zipped, zipped.open("levels.npy", "w") as stream:
        for _ in range(300):
            stream.write(bytes(1 << 20))
    assert "expected at most 200 times its size" in problem(path)


def test_levels_beyond_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "limit", lambda: 8 * LEVELS.size - 1)
    assert "claims 60 cells" in problem(saved(tmp_path, levels=LEVELS))


def _valid() -> bytes:
    buffer = io.BytesIO()
    np.savez_compressed(buffer, fill=LEVELS[None].astype(np.float32), time_s=[0.5], cell_size_m=2.0)
    return buffer.getvalue()


VALID = _valid()


@given(st.lists(st.tuples(st.integers(0, len(VALID) - 1), st.integers(0, 255)), min_size=1, max_size=4),
       st.integers(0, len(VALID)))
def test_damage_gives_a_scene_or_an_error(tmp_path_factory: pytest.TempPathFactory,
                                          changes: list[tuple[int, int]], end: int) -> None:
    content = bytearray(VALID)
    for at, value in changes:
        content[at] = value
    path = tmp_path_factory.getbasetemp() / "damaged.npz"
    path.write_bytes(content if end % 2 else content[:end])
    try:
        assert isinstance(load(path), Scene)
    except FileError as error:
        assert str(path) in str(error)


@given(st.lists(st.tuples(st.integers(0, 127), st.integers(32, 126)), min_size=1, max_size=3))
def test_damaged_array_headers(tmp_path_factory: pytest.TempPathFactory, changes: list[tuple[int, int]]) -> None:
    buffer = io.BytesIO()
    np.save(buffer, LEVELS)
    content = bytearray(buffer.getvalue())
    for at, value in changes:
        content[at] = value
    path = tmp_path_factory.getbasetemp() / "header.npz"
    with zipfile.ZipFile(path, "w") as zipped:
        zipped.writestr("levels.npy", bytes(content))
    try:
        assert isinstance(load(path), Scene)
    except FileError as error:
        assert str(path) in str(error)


def test_real_splashes(data) -> None:
    scene = load(data("fluid/drop64_isoadvector.npz"), 6)
    assert scene.levels is not None and scene.levels.shape == (64, 64, 64)
    assert (scene.frames, scene.time, scene.spacing[0]) == (7, 0.0035, 0.0003125)
    built_in = load("splash")
    assert built_in.levels is not None and np.array_equal(built_in.levels, scene.levels)


def test_a_real_overshoot_and_obstacle(data) -> None:
    scene = load(data("fluid/dambreak32_mules.npz"), 5)
    assert any(note.startswith("256 obstacle cells") for note in scene.notes)
