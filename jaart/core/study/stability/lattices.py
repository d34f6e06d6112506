"""Rows 53 to 57, 60, 62 and 63: thin, empty, full, stretched and uneven lattices."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from jaart.core import prepare
from jaart.core.filters import filtered
from jaart.core.io import load
from jaart.core.notes import notes
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, counted, error_of, largest
from jaart.core.study.stability.scenes import shot

#: Levels of a basin along the axis in which it is filled: the surface is at 5.3 cells.
COLUMN = np.array([1, 1, 1, 1, 1, 0.3, 0, 0, 0, 0])


@case(53, "basins in lattices of 1×10×10, 1×1×10 and, along each axis, their kin",
      "no slope along an axis with one cell: the surface is met at 5.3 cells, its normal is the axis")
def lattices_one_cell_wide() -> Outcome:
    """Differences are one-sided at a border, and there is none to take across a single cell."""
    worst, met = 0.0, 0
    for axis in range(3):
        for across in ((1, 10), (10, 1), (1, 1)):
            levels = np.moveaxis(np.broadcast_to(COLUMN, (*across, 10)), 2, axis)
            down = -np.eye(3)[axis]
            hits = shot(Scene("thin", levels=levels), Settings(placement="exact"),
                        np.array(levels.shape) / 2 * (down == 0) - 20 * down, down)
            met += int(hits.hit.sum())
            worst = largest(worst, abs(hits.t[0] - 14.7), np.abs(hits.normal[0] + down))
    return Outcome(f"{met} of 9 met, error up to {worst:.1e}", met == 9 and worst <= 1e-14)


@case(54, "a single cell that is partly full, and a layer one cell thick",
      "background, and a note that counts the cells without a normal")
def cells_without_a_normal() -> Outcome:
    """Central differences vanish there by symmetry; such cells are left out, whatever the gradient."""
    alone, layer = np.zeros((7, 7, 7)), np.zeros((7, 7, 7))
    alone[3, 3, 3] = layer[:, :, 3] = 0.5
    said, fine = [], True
    for levels, cells in ((alone, "1 interface cell,"), (layer, "49 interface cells,")):
        for gradient in ("central", "youngs", "smooth"):
            hits, texts = _seen(levels, Settings(gradient=gradient))
            fine &= len(texts) == 1 and cells in texts[0] and hits.counts() == {"background": len(hits)}
        said.append(texts[0])
    return Outcome("; ".join(said), fine)


@case(55, "an empty lattice", "background, and the note that there are 0 surfels")
def empty_lattice() -> Outcome:
    """A frame of a series may be empty, so that it is no error."""
    hits, texts = _seen(np.zeros((6, 7, 8)), Settings())
    return Outcome(f"{counted(hits.counts())}, note: {'; '.join(texts)}",
                   hits.counts() == {"background": len(hits)} and len(texts) == 1 and "0 surfels" in texts[0])


@case(56, "a full lattice of 6×7×8", "border open, outside is unknown: background and a note; border closed, outside "
      "is empty: six faces, met where they are")
def full_lattice() -> Outcome:
    """A face is where the exact plane of a full cell touches it: on the lattice's own faces."""
    levels = np.ones((6, 7, 8))
    hits, texts = _seen(levels, Settings(border="open"))
    ways, size = np.concatenate((np.eye(3), -np.eye(3))), np.array(levels.shape)
    block = shot(Scene("full", levels=levels), Settings(border="closed", placement="exact"), size / 2 - 20 * ways, ways)
    error = np.abs(block.t - (20 - np.abs(ways) @ size / 2)).max()
    return Outcome(f"open: {counted(hits.counts())}, note: {'; '.join(texts)}; closed: {block.hit.sum()} of 6 met, "
                   f"error up to {error:.1e}", bool(hits.counts() == {"background": len(hits)} and len(texts) == 1
                                        and block.hit.all() and error <= 1e-14))


@case(57, "full cells beside empty ones, across a face and across a corner",
      "the surfel lies on the plane that cuts volume 1: on the face, at the corner")
def full_cells_beside_empty_ones() -> Outcome:
    """The plane touches the cell from outside: |v| = (|n_x| + |n_y| + |n_z|)/2."""
    half, block = np.zeros((5, 5, 6)), np.zeros((5, 5, 5))
    half[:, :, :3] = 1
    block[:3, :3, :3] = 1
    face = prepare.surfels(Scene("half", levels=half), Settings(placement="exact"))
    corner = prepare.surfels(Scene("block", levels=block), Settings(placement="exact"))
    tip = np.flatnonzero((corner.cells == 2).all(axis=1))
    errors = np.abs(face.points[:, 2] - 3).max(), np.abs(corner.points[tip] - 3).max()
    return Outcome(f"25 faces: error {errors[0]:.1e}, the corner: error {errors[1]:.1e}",
                   len(face) == 25 and len(tip) == 1 and largest(errors) <= 5e-16)


@case(60, "cells of 1×1×4", "normals and points are those of space: a plane is met where it is")
def cells_four_times_as_long() -> Outcome:
    """A linear field has the exact slope; divided by the spacing it gives the normal, here off by 0 instead of 31°."""
    slope = np.array([1, 2, 4]) / 64
    cells = np.moveaxis(np.indices((8, 8, 8)), 0, -1) + 0.5
    field = Scene("field", levels=0.5 + (cells - 4) @ slope, spacing=(1.0, 1.0, 4.0))
    normal = -slope / (1, 1, 4) / np.linalg.norm(slope / (1, 1, 4))
    off = float(np.abs(prepare.surfels(field, Settings()).normal - normal).max())
    naive = np.degrees(np.arccos(-slope @ normal / np.linalg.norm(slope)))
    level = Scene("level", levels=np.broadcast_to(COLUMN, (9, 9, 10)), spacing=(0.5, 0.5, 2.0))
    hits = shot(level, Settings(placement="exact"), (1.1, 1.2, 20.0), (0.0, 0.0, -1.0))
    error = abs(float(hits.t[0]) - 14.7)
    return Outcome(f"normals to {off:.1e} (undivided: {naive:.0f}° off), plane to {error:.1e}",
                   bool(off <= 5e-16 and naive > 20 and error <= 1e-14))


@case(62, "a volume of 3×4×5 in C and in Fortran order, as .npz and as .vti", "the same levels, bit for bit, all four")
def uneven_volumes_in_any_order() -> Outcome:
    """A .vti has no order to choose: there x runs fastest. It is read from its cells, and from its points."""
    levels = np.arange(60).reshape(3, 4, 5) / 64
    with TemporaryDirectory() as name:
        folder = Path(name)
        np.savez(folder / "c.npz", levels=np.ascontiguousarray(levels))
        np.savez(folder / "fortran.npz", levels=np.asfortranarray(levels))
        (folder / "cells.vti").write_text(_vti(levels, "CellData", (3, 4, 5)))
        (folder / "points.vti").write_text(_vti(levels, "PointData", (2, 3, 4)))
        same = [file.name for file in sorted(folder.iterdir()) if np.array_equal(_read(file), levels)]
    return Outcome(f"the same: {', '.join(same)}", len(same) == 4)


@case(63, "levels at the thresholds of the filter, above all and below all of them",
      "a level of 0.1 and a neighbour above 0.25 are kept, all else is emptied; all of a full lattice is kept, "
      "nothing of a faint one")
def filter_at_its_thresholds() -> Outcome:
    """The row sets the thresholds to 0 and 1. They are those of [T Algorithm 2] and no settings, so it is levels
    that are put at both ends; the cells kept are worked out by hand.
    """
    row = np.array([[[0.0, 0.1, 0.26, 0.1, 0.0, 0.25, 0.1, np.nextafter(0.1, 0), 0.3, 0.099]]])
    kept = filtered(row, Settings(filter="thesis"))
    by_hand = np.array([[[0.0, 0.1, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]]])
    full, faint = (filtered(np.full((4, 5, 6), level), Settings(filter="thesis")) for level in (1.0, 0.0999))
    unknown = error_of(lambda: Settings().replace(threshold=0))
    return Outcome(f"{np.count_nonzero(kept)} of 8 kept at the thresholds, {np.count_nonzero(full)} of 120 full, "
                   f"{np.count_nonzero(faint)} of 120 faint", bool((kept == by_hand).all() and (full == 1).all()
                                                                  and not faint.any() and "threshold" in unknown))


def _seen(levels: Array, settings: Settings) -> tuple[Hits, tuple[str, ...]]:
    """A small picture of a lattice, and what is said of it."""
    scene = Scene("lattice", levels=levels)
    return render(scene, settings, size=(16, 16)), notes(scene, settings)


def _read(file: Path) -> Any:
    return load(file).levels


def _vti(levels: Array, kind: str, last: tuple[int, int, int]) -> str:
    """A VTI file in plain text; last: the highest index of a point along each axis."""
    extent = " ".join(f"0 {n}" for n in last)
    numbers = " ".join(repr(float(level)) for level in levels.ravel(order="F"))
    return (f'<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian"><ImageData WholeExtent="{extent}" '
            f'Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{extent}"><{kind}><DataArray type="Float64" Name="levels" '
            f'format="ascii">{numbers}</DataArray></{kind}></Piece></ImageData></VTKFile>')
