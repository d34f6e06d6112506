"""Checks of what files claim and hold, the same for every format."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core import memory
from jaart.core.errors import FileError
from jaart.core.scene import Array, frozen

#: Solvers overshoot: levels so little outside [0, 1] are clipped, and that is said.
OVERSHOOT = 1e-3

#: Solvers leave films of no meaning far from the surface: levels so close to 0 or 1 are 0 or 1, and that is said.
RESIDUE = 1e-6

#: Packed lattices are refused above FREE bytes when they unpack to so many times their size.
RATIO, FREE = 200, 1 << 28


def check_ratio(path: Path, claimed: int, stored: int) -> None:
    """Raise FileError when a file would unpack to far more bytes than any lattice does."""
    if claimed > FREE and claimed > RATIO * stored:
        raise FileError(path, f"claims {memory.words(claimed)} in {memory.words(stored)}; expected at most "
                              f"{RATIO} times its size (a lattice that packs so well must be stored unpacked)")


def check_memory(path: Path, cells: int, place: str) -> None:
    """Raise FileError when the levels of so many cells would not fit into memory."""
    if 8 * cells > memory.limit():
        raise FileError(path, f"claims {cells} cells, {memory.words(8 * cells)} of memory; expected at most "
                              f"{memory.words(memory.limit())}", place)


def check_frame(path: Path, frame: int | None, frames: int) -> int:
    """The frame asked for, the first when None. Raises FileError when the file has no such frame."""
    frame = 0 if frame is None else frame
    if not 0 <= frame < frames:
        raise FileError(path, f"holds {frames} frame{'s' if frames > 1 else ''}; expected 0 to {frames - 1}",
                        f"frame {frame}")
    return frame


def fill_levels(path: Path, place: str, values: NDArray[Any]) -> tuple[Array, tuple[str, ...]]:
    """Fill levels (nx, ny, nz) as read-only float64 in [0, 1], and notes on what was changed.

    Levels less than OVERSHOOT outside are clipped, those within RESIDUE of 0 or 1 become 0 or 1: else each
    film that a solver leaves would be an interface. Raises FileError for values that are not finite
    or too far outside, with count and first index.
    """
    values = values.astype(np.float64)
    _refuse(path, place, values, ~np.isfinite(values), "not finite")
    _refuse(path, place, values, (values < -OVERSHOOT) | (values > 1 + OVERSHOOT), "outside [0, 1]")
    notes = []
    excess = np.maximum(-values, values - 1)
    if (outside := excess > 0).any():
        one = outside.sum() == 1
        notes.append(f"{outside.sum()} level{'' if one else 's'} up to {excess.max():.2g} outside [0, 1] "
                     f"{'was' if one else 'were'} clipped")
    if (film := (excess < 0) & (excess >= -RESIDUE)).any():
        notes.append(f"{film.sum()} {'level' if film.sum() == 1 else 'levels'} within {RESIDUE:g} of 0 or 1 "
                     f"{'counts' if film.sum() == 1 else 'count'} as empty or full")
    return frozen(np.where(excess >= -RESIDUE, np.rint(np.clip(values, 0, 1)), values)), tuple(notes)


def _refuse(path: Path, place: str, values: Array, bad: NDArray[np.bool_], what: str) -> None:
    if bad.any():
        index = tuple(int(i) for i in np.unravel_index(int(bad.argmax()), bad.shape))
        count = int(bad.sum())
        raise FileError(path, f"{count} value{'s' if count > 1 else ''} {what}, the first is {values[index]:g} "
                              f"at {list(index)}; expected fill levels from 0 to 1", place)
