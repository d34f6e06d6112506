"""Rows 58, 59 and 61: fill levels that are none, levels next to 0 and 1, and lattices too large for any memory."""

from __future__ import annotations

import io
import zipfile
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from jaart.core import plic
from jaart.core.io import load
from jaart.core.samples import fibonacci
from jaart.core.scene import Array
from jaart.core.study.stability.case import Outcome, case, error_of

#: Far more cells along each edge than any memory holds.
HUGE = 10**5
#: Components of normals beside which nothing is left of the sum of their squares.
TINY = (0.0, 1e-300, 1e-160, 1e-17, 1e-8)


@case(58, "fill levels NaN, infinite, -0.1 and 1.1 in a file; and 1 + 5e-4, as solvers overshoot",
      "an error that names the file's array and the cell; what is up to 1e-3 outside is clipped, with a count")
def levels_that_are_none() -> Outcome:
    """A level of 1.1 is no rounding, so it is refused as NaN is."""
    said = [error_of(partial(_of_file, value)) for value in (np.nan, np.inf, -0.1, 1.1)]
    named = [all(word in text for word in ("array 'levels'", "1 value", "[1, 2, 3]")) for text in said]
    levels, notes = _of_file(1 + 5e-4)
    clipped = bool(levels[1, 2, 3] == 1.0) and "1 level up to 0.0005 outside [0, 1] was clipped" in notes
    return Outcome(f"{said[0].partition(': ')[2]}; {sum(named)} of 4 so; 1.0005: {'; '.join(notes)}",
                   all(named) and clipped)


@case(59, "levels of 5e-324, 1e-300, 1e-16, 1e-8 and 0.3, and as far below 1, for normals with components down to 0",
      "plane and volume to 1e-16, there and back")
def levels_next_to_empty_and_full() -> Outcome:
    """Every ratio is at most about 1, so that none is 0/0 where the textbook's 1/(6 m1 m2 m3) is.

    A file's levels within 1e-6 of 0 and 1 count as empty and full; these are for solids and for those who ask.
    """
    normals, below = np.concatenate((fibonacci(200), _graded())), np.array([5e-324, 1e-300, 1e-16, 1e-8, 0.3])
    level, normal = np.tile((*below, *(1 - below)), len(normals)), np.repeat(normals, 2 * len(below), axis=0)
    with np.errstate(under="ignore"):
        distance = plic.distance(level, normal)
        error = float(np.abs(plic.volume(distance, normal) - level).max())
    within = np.abs(distance) <= np.abs(normal).sum(axis=1) / 2 * (1 + 4e-16)
    return Outcome(f"{len(level)} planes, error up to {error:.1e}", bool(within.all() and error <= 2.3e-16))


@case(61, f"a lattice of {HUGE}³ cells, as .npz, .npy and .vti",
      "refused at once, with the memory that it would need")
def lattices_beyond_any_memory() -> Outcome:
    """A bare .npy is no kind of file that is read, and is refused as such."""
    with TemporaryDirectory() as name:
        folder, header = Path(name), io.BytesIO()
        np.lib.format.write_array_header_1_0(
            header, {"descr": "<f8", "fortran_order": False, "shape": (HUGE, HUGE, HUGE)})
        with zipfile.ZipFile(folder / "huge.npz", "w") as zipped:
            zipped.writestr("levels.npy", header.getvalue())
        (folder / "huge.npy").write_bytes(header.getvalue())
        (folder / "huge.vti").write_text(_vti())
        said = {kind: error_of(partial(load, folder / f"huge.{kind}")).partition("huge.")[2]
                for kind in ("npz", "npy", "vti")}
    return Outcome("; ".join(said.values()), all("7.11 PiB" in said[kind] for kind in ("npz", "vti"))
                   and "unknown kind of file" in said["npy"])


def _of_file(value: float) -> tuple[Array, tuple[str, ...]]:
    """The levels that are read of a file with one value among good ones, and what is said of them."""
    levels = np.full((3, 4, 5), 0.5)
    levels[1, 2, 3] = value
    with TemporaryDirectory() as name:
        np.savez(Path(name) / "levels.npz", levels=levels)
        scene = load(Path(name) / "levels.npz")
    assert scene.levels is not None
    return scene.levels, scene.notes


def _graded() -> Array:
    """Unit normals along an axis, and in a face, but for tiny components."""
    made = [(1.0, a, b) for a in TINY for b in TINY] + [(0.6, 0.8, a) for a in TINY] + [(0.8, a, -0.6) for a in TINY]
    return np.array(made)


def _vti() -> str:
    extent = f"0 {HUGE} 0 {HUGE} 0 {HUGE}"
    return (f'<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian"><ImageData WholeExtent="{extent}" '
            f'Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{extent}"><CellData><DataArray type="Float64" '
            'Name="levels" format="ascii">1 0 1</DataArray></CellData></Piece></ImageData></VTKFile>')
