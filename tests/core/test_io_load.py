"""What holds for files of every kind: which are opened, and how they are written."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from jaart.core.errors import FileError
from jaart.core.io import BUILT_IN, load
from jaart.core.io.atomic import replacing
from jaart.core.resources import resource


def problem(source: str | Path, frame: int | None = None) -> str:
    with pytest.raises(FileError) as caught:
        load(source, frame)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("name", BUILT_IN)
def test_built_in_scenes_open_by_name(name: str) -> None:
    scene = load(name)
    assert scene.source == name
    assert scene.kind == {"splash": "lattice", "standard": "model", "bumpy": "cloud"}[name]


def test_frames_of_the_built_in_series() -> None:
    assert [load("splash", frame).time for frame in range(3)] == [0.0015, 0.002, 0.0035]
    assert load("splash").frame == 2
    assert "frame 3: holds 3 frames" in problem("splash", 3)
    assert "frame 1: holds 1 frame;" in problem("standard", 1)
    assert "frame 1: holds 1 frame;" in problem("bumpy", 1)


def test_a_name_that_is_neither_file_nor_built_in(tmp_path: Path) -> None:
    assert problem("splsh") == ("splsh: no such file, and no built-in scene of that name; built-in are splash, "
                                "standard, bumpy")
    assert "no such file" in problem(tmp_path / "none.npz")


def test_only_regular_files_are_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.npz")
    folder = tmp_path / "folder.npz"
    folder.mkdir()
    assert "is not a regular file" in problem(tmp_path / "pipe.npz")
    assert "is not a regular file" in problem("/dev/zero")
    assert "is a folder" in problem(folder)


@pytest.mark.parametrize("name", ["", "a\0b.npz", "x" * 5000 + ".npz"])
def test_unusable_names(name: str) -> None:
    assert problem(name)


def test_unknown_kinds(tmp_path: Path) -> None:
    (tmp_path / "x.stl").touch()
    assert "unknown kind of file '.stl'; expected .npz, .vti, .xml" in problem(tmp_path / "x.stl")


def test_suffixes_in_capitals(tmp_path: Path) -> None:
    np.savez(tmp_path / "x.npz", levels=np.full((2, 2, 2), 0.5))
    (tmp_path / "x.npz").rename(tmp_path / "X.NPZ")
    assert load(tmp_path / "X.NPZ").kind == "lattice"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_files_without_permission(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    path.touch(mode=0o000)
    assert "cannot be read" in problem(path)


def test_missing_resources() -> None:
    with pytest.raises(FileError, match=r"nothing\.xml"):
        resource("nothing.xml")


def test_a_file_is_replaced_whole(tmp_path: Path) -> None:
    target = tmp_path / "x.csv"
    target.write_text("old")
    target.chmod(0o640)
    with replacing(target) as temporary:
        assert temporary.parent == tmp_path and temporary.suffix == ".csv"
        temporary.write_text("new")
        assert target.read_text() == "old"
    assert target.read_text() == "new"
    assert target.stat().st_mode & 0o777 == 0o640
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("failure", [ValueError, KeyboardInterrupt])
def test_a_failure_leaves_the_old_file(tmp_path: Path, failure: type[BaseException]) -> None:
    target = tmp_path / "x.csv"
    target.write_text("old")
    with pytest.raises(failure), replacing(target) as temporary:
        temporary.write_text("half")
        raise failure
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_new_files_have_the_usual_permissions(tmp_path: Path) -> None:
    with replacing(tmp_path / "a") as temporary:
        temporary.write_text("new")
    (tmp_path / "b").touch()
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "b").stat().st_mode


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "x.csv").mkdir()
    for target in (tmp_path / "none" / "x.csv", tmp_path / "x.csv"):
        with pytest.raises(FileError, match="cannot be written"), replacing(target) as temporary:
            temporary.write_text("new")
    assert [p.name for p in tmp_path.iterdir()] == ["x.csv"]
