"""Reads scenes from files: one module for each format, chosen by the file's suffix."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from typing import NamedTuple

from jaart.core.errors import FileError
from jaart.core.io import npz, scene_graph, vti
from jaart.core.io.values import check_frame
from jaart.core.resources import resource
from jaart.core.samples import bumpy_sphere
from jaart.core.scene import Scene
from jaart.core.telling import doing

Reader = Callable[[Path, int | None], Scene]

#: The reader of each kind of file, by suffix.
READERS: Mapping[str, Reader] = {".npz": npz.read, ".vti": vti.read, ".xml": scene_graph.read}


class BuiltIn(NamedTuple):
    """A scene that comes with Jaart: its file in resources/ and the frame shown when nobody says, or how it is made."""

    file: str = ""
    frame: int | None = None
    make: Callable[[], Scene] | None = None


#: Built-in scenes by name.
BUILT_IN: Mapping[str, BuiltIn] = {
    "splash": BuiltIn("splash.npz", 2), "standard": BuiltIn("standard.xml"), "bumpy": BuiltIn(make=bumpy_sphere)}


def load(source: str | PathLike[str], frame: int | None = None) -> Scene:
    """The scene in a file, or the built-in scene of that name.

    source: path, or a name of BUILT_IN; frame: which of a series, counted from 0, the first (of a
    built-in series: the best) when None. Raises FileError that names the file, the place in it and what was
    expected.
    """
    if isinstance(source, str) and source in BUILT_IN:
        return _built_in(source, frame)
    path = Path(source)
    _check_file(path)
    try:
        reader = READERS[path.suffix.lower()]
    except KeyError:
        raise FileError(path, f"unknown kind of file {path.suffix!r}; expected {', '.join(READERS)}") from None
    try:
        with doing(f"reading {path.name}"):
            return reader(path, frame)
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from None
    except MemoryError:
        raise FileError(path, "does not fit into memory") from None


def _built_in(name: str, frame: int | None) -> Scene:
    built_in = BUILT_IN[name]
    if built_in.make is None:
        scene = load(resource(built_in.file), built_in.frame if frame is None else frame)
    else:
        check_frame(Path(name), frame, 1)
        scene = built_in.make()
    return dataclasses.replace(scene, source=name)


def _check_file(path: Path) -> None:
    """Only regular files are opened: a device or a pipe could be read for ever."""
    try:
        if path.is_file():
            return
        kind = "is a folder" if path.is_dir() else "is not a regular file" if path.exists() else ""
    except (OSError, ValueError) as error:
        raise FileError(path, f"is no usable file name: {getattr(error, 'strerror', None) or error}") from None
    if kind:
        raise FileError(path, f"{kind}; expected a file of kind {', '.join(READERS)}")
    raise FileError(path, f"no such file, and no built-in scene of that name; built-in are {', '.join(BUILT_IN)}")
