"""Checks and repairs of clouds, the same for every format."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import FileError
from jaart.core.scene import LARGEST, Array, Scene

#: Normals are made unit ones; it is said of those that were farther from it.
ROUGHLY_UNIT = 1e-4
#: It is said when coordinates are stored in steps above this share of the cloud's size.
COARSE = 1e-5


def cloud(source: str, points: NDArray[Any], normals: NDArray[Any] | None = None,
          notes: tuple[str, ...] = ()) -> Scene:
    """A scene of points (N, 3) and perhaps normals (N, 3) as a file or a person gives them.

    Exact duplicates are merged into the first of them, which keeps its normal; normals are made unit
    vectors. notes: what was said before; what is changed here is added. Raises FileError for no points,
    values that are not finite or too large, and normals of zero length.
    """
    places = np.asarray(points, dtype=np.float64)
    if not len(places):
        raise FileError(source, "holds no points; expected at least one", "points")
    _refuse(source, "points", places, ~(np.abs(places) <= LARGEST), f"finite coordinates up to {LARGEST:g}")
    notes += _step_note(places, np.asarray(points).dtype)
    directions = None
    if normals is not None:
        directions, changed = _unit(source, np.asarray(normals, dtype=np.float64), len(places))
        notes += changed
    kept = first_of_each(places)
    merged = len(places) - len(kept)
    if merged:
        notes += (f"{merged} exact duplicate{'s' if merged > 1 else ''} of points merged",)
        places, directions = places[kept], None if directions is None else directions[kept]
    return Scene(source, points=places, normals=directions, merged=merged, notes=notes)


def first_of_each(points: Array) -> NDArray[np.intp]:
    """Indices, rising, of the points (N, 3) that equal no earlier one."""
    order = np.lexsort(points.T)
    new = np.ones(len(points), dtype=bool)
    new[1:] = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    return np.sort(order[new])


def _step_note(points: Array, dtype: np.dtype[Any]) -> tuple[str, ...]:
    """What to say when the numbers are too coarse for the cloud's distance from the origin."""
    size = np.linalg.norm(np.ptp(points, axis=0))
    if dtype.kind != "f" or size == 0:
        return ()
    step = float(np.spacing(np.abs(points).max().astype(dtype)))
    if step <= COARSE * size:
        return ()
    return (f"coordinates far from the origin: {dtype.name} stores them in steps of {step:.2g}, "
            f"{step / size:.2g} of the cloud's size",)


def _unit(source: str, normals: Array, count: int) -> tuple[Array, tuple[str, ...]]:
    """Unit normals, and a note of how many were none. Scaling first keeps tiny ones from underflow."""
    if len(normals) != count:
        raise FileError(source, f"has {len(normals)} for {count} points; expected one each", "normals")
    _refuse(source, "normals", normals, ~np.isfinite(normals), "finite components")
    largest = np.abs(normals).max(axis=1)
    _refuse(source, "normals", normals, largest == 0, "no normal of zero length")
    scaled = normals / largest[:, None]
    length = np.sqrt((scaled * scaled).sum(axis=1))
    with np.errstate(over="ignore"):
        off = int((np.abs(length * largest - 1) > ROUGHLY_UNIT).sum())
    said = f"{off} {'normal was' if off == 1 else 'normals were'} scaled to length 1"
    return scaled / length[:, None], (said,) if off else ()


def _refuse(source: str, place: str, values: Array, bad: NDArray[np.bool_], expected: str) -> None:
    """Raise FileError that counts the bad values or rows and shows the first."""
    if bad.any():
        index = tuple(int(i) for i in np.unravel_index(int(bad.argmax()), bad.shape))
        shown = f"{values[index]:g}" if len(index) == values.ndim else f"({', '.join(f'{v:g}' for v in values[index])})"
        count = int(bad.sum())
        raise FileError(source, f"{count} value{'s' if count > 1 else ''} out of range, the first is {shown} "
                                f"at {list(index)}; expected {expected}", place)
