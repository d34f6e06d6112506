"""Reads .npz: lattices `levels` (nx, ny, nz), series of them `fill` (t, nx, ny, nz), clouds `points` (N, 3)."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from jaart.core.errors import FileError
from jaart.core.io import cloud_npz
from jaart.core.io.npy import DAMAGE, Archive
from jaart.core.io.values import check_frame, fill_levels
from jaart.core.scene import Array, Scene


def read(path: Path, frame: int | None = None) -> Scene:
    """The lattice or the cloud in an .npz.

    Optional beside a lattice: time_s (t), seconds; cell_size_m, metres; solid (nx, ny, nz), which cells are an
    obstacle; beside points: normals (N, 3). frame: which of a series, the first when None. Raises FileError.
    """
    try:
        with zipfile.ZipFile(path) as zipped:
            archive = Archive(path, zipped)
            name = _main_array(archive)
            return cloud_npz.scene(archive, frame) if name == "points" else _lattice(archive, name, frame)
    except DAMAGE as error:
        raise FileError(path, f"is no whole .npz file: {error}") from None


def _lattice(archive: Archive, name: str, frame: int | None) -> Scene:
    series = name == "fill"
    shape = archive.header(name).shape
    wanted = "(t, nx, ny, nz)" if series else "(nx, ny, nz)"
    if len(shape) != (4 if series else 3) or 0 in shape:
        raise archive.error(name, f"has shape {shape}; expected {wanted}, none of them 0")
    frames = shape[0] if series else 1
    frame = check_frame(archive.path, frame, frames)
    place = f"array 'fill', frame {frame}" if series else "array 'levels'"
    levels, clipped = fill_levels(archive.path, place, archive.read(name, frame if series else None))
    levels, obstacles = _without_obstacles(archive, levels)
    size = _cell_size(archive)
    return Scene(str(archive.path), levels=levels, spacing=(size, size, size), frame=frame, frames=frames,
                 time=_time(archive, frame, frames), notes=clipped + obstacles)


def _main_array(archive: Archive) -> str:
    for name in ("levels", "fill", "points"):
        if name in archive:
            return name
    held = ", ".join(archive.members) or "nothing"
    raise FileError(archive.path, f"holds {held}; expected an array levels (nx, ny, nz), fill (t, nx, ny, nz) "
                                  "or points (N, 3)")


def _without_obstacles(archive: Archive, levels: Array) -> tuple[Array, tuple[str, ...]]:
    """The levels with obstacle cells emptied, and a note that says so."""
    if "solid" not in archive:
        return levels, ()
    shape = archive.header("solid").shape
    if shape != levels.shape:
        raise archive.error("solid", f"has shape {shape}; expected that of the lattice, {levels.shape}")
    solid = archive.read("solid").astype(bool)
    if not solid.any():
        return levels, ()
    emptied = np.where(solid, 0.0, levels)
    emptied.flags.writeable = False
    return emptied, (f"{solid.sum()} obstacle cells count as air",)


def _cell_size(archive: Archive) -> float:
    if "cell_size_m" not in archive:
        return 1.0
    values = _floats(archive, "cell_size_m", 1)
    if not 0 < values[0] < np.inf:
        raise archive.error("cell_size_m", f"is {values[0]:g}; expected metres above 0")
    return float(values[0])


def _time(archive: Archive, frame: int, frames: int) -> float | None:
    if "time_s" not in archive:
        return None
    values = _floats(archive, "time_s", frames)
    if not np.isfinite(values[frame]):
        raise archive.error("time_s", f"is {values[frame]:g} at [{frame}]; expected seconds")
    return float(values[frame])


def _floats(archive: Archive, name: str, count: int) -> Array:
    header = archive.header(name)
    if len(header.shape) > 1 or header.nbytes != count * header.dtype.itemsize:
        raise archive.error(name, f"has shape {header.shape}; expected {count} number{'s' if count > 1 else ''}")
    return archive.read(name).reshape(-1).astype(np.float64)
