"""Reads clouds from .npz: `points` (N, 3) with or without `normals` (N, 3)."""

from __future__ import annotations

from jaart.core.io.cloud_values import cloud
from jaart.core.io.npy import Archive
from jaart.core.io.values import check_frame
from jaart.core.scene import Scene

#: What is read of an archive.
NAMES = ("points", "normals")


def scene(archive: Archive, frame: int | None) -> Scene:
    """The cloud in an archive; other arrays are left out with a note. Raises FileError."""
    check_frame(archive.path, frame, 1)
    for name in NAMES:
        if name in archive and ((shape := archive.header(name).shape)[1:] != (3,)):
            raise archive.error(name, f"has shape {shape}; expected (N, 3)")
    normals = archive.read("normals") if "normals" in archive else None
    ignored = [name for name in archive.members if name not in NAMES]
    notes = (f"array{'s' if len(ignored) > 1 else ''} {', '.join(ignored)} left out",) if ignored else ()
    return cloud(str(archive.path), archive.read("points"), normals, notes)
