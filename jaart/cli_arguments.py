"""What is typed on the command line, turned into sizes, pixels, settings, cameras and rays."""

from __future__ import annotations

import difflib
import os
import re
import zipfile
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from jaart.core.errors import FileError, RayError

if TYPE_CHECKING:
    from jaart.core.camera import Camera
    from jaart.core.io.npy import Archive
    from jaart.core.records import Array
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings

#: Options that take several K=V after one flag.
_ASSIGNED = ("--camera", "--set")
_ASSIGNMENT = re.compile(r"[A-Za-z_]\w*=")


#: Origin and direction (3,) of a ray.
Ray = tuple[Any, Any]


def usage(option: str, problem: str) -> typer.BadParameter:
    """The error of an option that was typed wrong; it ends with exit status 2."""
    return typer.BadParameter(problem, param_hint=option)


def complete(arguments: Sequence[str], commands: Collection[str]) -> list[str]:
    """Arguments as the parser takes them: "gui" where no command is named, one K=V after each flag."""
    words = list(arguments)
    if not words:
        return ["gui"]
    first = words[0]
    if first in commands or first.startswith("-"):
        return spread(words)
    from jaart.core.io import BUILT_IN

    close = difflib.get_close_matches(first, commands, n=1)
    if close and first not in BUILT_IN and not os.path.exists(first):
        raise typer.BadParameter(f"no command or file is called {first!r}; did you mean {close[0]}?")
    return spread(["gui", *words])


def spread(words: Sequence[str]) -> list[str]:
    """The same words with the flag repeated before each K=V that follows it."""
    result: list[str] = []
    flag = ""
    for i, word in enumerate(words):
        if word == "--":
            return result + list(words[i:])
        if flag and words[i - 1] != flag and _ASSIGNMENT.match(word):
            result.append(flag)
        elif word.startswith("-") or (flag and words[i - 1] != flag):
            name = word.partition("=")[0]
            flag = name if name in _ASSIGNED else ""
        result.append(word)
    return result


def size(text: str) -> tuple[int, int]:
    """(width, height) of "WxH"; that the picture is possible is checked when it is rendered."""
    match = re.fullmatch(r"(-?\d{1,9})x(-?\d{1,9})", text)
    if match is None:
        raise usage("--size", f"{text!r}: expected WxH, such as 512x512")
    return int(match[1]), int(match[2])


def pixel(text: str, option: str) -> tuple[int, int]:
    """(x, y) of "X,Y"."""
    match = re.fullmatch(r"(-?\d{1,9}),(-?\d{1,9})", text)
    if match is None:
        raise usage(option, f"{text!r}: expected X,Y, two whole numbers")
    return int(match[1]), int(match[2])


def check_pixel(at: tuple[int, int], size: tuple[int, int]) -> None:
    """Raise RayError when a pixel is not in a picture of that size."""
    from jaart.core.camera import check_size

    check_size(size)
    if not (0 <= at[0] < size[0] and 0 <= at[1] < size[1]):
        raise RayError(f"pixel {at[0]},{at[1]}: expected one of the picture, 0,0 to {size[0] - 1},{size[1] - 1}")


def vector(text: str, option: str) -> tuple[float, float, float]:
    """(x, y, z) of "x,y,z"; that the numbers make a ray is checked when it is traced."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise usage(option, f"{text!r}: expected x,y,z, three numbers") from None
    return x, y, z


def settings(preset_name: str, assignments: Sequence[str]) -> Settings:
    """The settings of a preset with single values on top; what a scene makes of them, `suit` says."""
    from jaart.core.settings import parse, preset

    return parse(assignments, preset(preset_name))


def suit(scene: Scene, chosen: Settings, assignments: Sequence[str],
         implied: Sequence[str] = ()) -> tuple[Settings, tuple[str, ...]]:
    """The settings as a scene can take them, and notes of what was left out of the preset.

    assignments: what was typed after --set; implied: names of settings that other options gave. Raises
    SettingsError, by name, for a typed value that has no meaning in the scene or beside the others.
    """
    from jaart.core.meaning import check, check_names
    from jaart.core.suited import suited

    names = [text.partition("=")[0].strip() for text in assignments]
    fitting, notes = suited(scene, chosen, [*names, *implied])
    check_names(names, scene, fitting)
    check(scene, fitting)
    return fitting, notes


def camera(assignments: Sequence[str], scene: Scene, chosen: Settings, size: tuple[int, int] = (1, 1)) -> Camera:
    """A camera with the whole scene in view, and what was typed on top."""
    from jaart.core.camera import Camera, check_distance, parse
    from jaart.core.chosen import chosen as values_of
    from jaart.core.extents import bounds

    corners = bounds(scene, chosen)
    view = parse(assignments, Camera.fit(corners, size=size))
    cloud = scene.kind == "cloud"
    check_distance(view, corners[0] / 2 + corners[1] / 2 if cloud else (0, 0, 0),
                   values_of(scene, chosen).h if cloud else 1.0)
    return view


def pixel_ray(view: Camera, size: tuple[int, int], at: tuple[int, int]) -> Ray:
    """Origin and direction of the ray through a pixel, the bits that a picture's ray has."""
    import numpy as np

    origins, directions = view.rays(size, np.array([at[0] + at[1] * size[0]]))
    return origins[0], directions[0]


def rays(path: Path) -> tuple[Array, Array]:
    """Origins and directions (R, 3) of an .npz. Raises FileError that names the array."""
    from jaart.core.io.npy import DAMAGE, Archive

    try:
        with zipfile.ZipFile(path) as zipped:
            archive = Archive(path, zipped)
            return _vectors(archive, "origins", "origin"), _vectors(archive, "directions", "direction")
    except DAMAGE as error:
        raise FileError(path, f"is no whole .npz file: {error}") from None
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror or error}") from None


def _vectors(archive: Archive, name: str, as_written: str) -> Array:
    """An array (R, 3) under its name, or under the one that --hits writes it with."""
    if name not in archive and as_written in archive:
        name = as_written
    if name not in archive:
        raise archive.error(name, "is missing; expected origins and directions (R, 3)")
    shape = archive.header(name).shape
    if len(shape) != 2 or shape[1] != 3:
        raise archive.error(name, f"has shape {shape}; expected (R, 3)")
    return archive.read(name).astype("float64")


def output(path: Path, option: str, *suffixes: str) -> None:
    """Refuse, before any work, a file of another kind or one that could not be written."""
    if path.suffix.lower() not in suffixes:
        raise usage(option, f"{str(path)!r}: expected a name that ends in {' or '.join(suffixes)}")
    if path.is_dir():
        raise FileError(path, "is a folder; expected a file")
    if not path.parent.is_dir():
        raise FileError(path, f"cannot be written: there is no folder {str(path.parent)!r}")
    if not os.access(path.parent, os.W_OK):
        raise FileError(path, f"cannot be written: no permission in the folder {str(path.parent)!r}")


def which_ray(at: str | None, origin: str | None, direction: str | None) -> tuple[tuple[int, int] | None, Ray | None]:
    """The pixel, or origin and direction: whichever was typed."""
    if at is not None and origin is None and direction is None:
        return pixel(at, "--pixel"), None
    if at is None and origin is not None and direction is not None:
        return None, (vector(origin, "--origin"), vector(direction, "--direction"))
    raise usage("--pixel", "expected either --pixel X,Y or both --origin and --direction x,y,z")
