"""Filling models by corner votes: against the literal algorithms, analytic volumes, the standard scene's count."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from jaart.core import memory
from jaart.core.errors import SettingsError
from jaart.core.io import load
from jaart.core.model import fill
from jaart.core.scene import Model
from jaart.core.settings import Settings
from jaart.core.shapes import Box, Cylinder, Ellipsoid, Solid, Sphere, Torus
from jaart.core.surfels import make_surfels

STANDARD = Model((Sphere((0.7, 0.7, 0.7), 0.25), Box((0.3, 0.5, 0.4), (0.2, 0.4, 0.3))), 16)
OVERLAP = Model((Box((0.5, 0.5, 0.5), (0.51, 0.33, 0.42)), Box((0.6, 0.6, 0.5), (0.5, 0.4, 0.3)),
                 Sphere((0.4, 0.4, 0.4), 0.21)), 6)
#: All corners of a cell are in one of two boxes, a gap runs through the middle of it.
GAP = Model((Box((0.3, 0.5, 0.5), (0.34, 0.9, 0.9)), Box((0.7, 0.5, 0.5), (0.36, 0.9, 0.9))), 5)
#: The hole of the small torus lies within a cell whose corners the torus holds.
BEYOND = Model((Torus((0.5, 0.5, 0.5), (1, 2, 3), 0.15, 0.1), Cylinder((0.3, 0.7, 0.4), "y", 0.2, 0.4),
                Ellipsoid((0.7, 0.4, 0.3), (0.25, 0.1, 0.15))), 5)
RING = Model((Torus((0.5, 0.5, 0.5), "z", 0.3, 0.28),), 5)


def vote(solids: list[Solid], point: np.ndarray, step: float) -> float:
    """Algorithm 4 with a union: the share of the 8 corners that some solid holds."""
    corners = np.array([point + step * np.array(c) for c in itertools.product((0, 1), repeat=3)])
    return float(np.mean(np.logical_or.reduce([s.contains(corners) for s in solids])))


def literal(model: Model, raster: int, subdivision: int) -> np.ndarray:
    """Algorithm 3 cell by cell."""
    solids = [s.scaled(raster) for s in model.solids]
    levels = np.zeros((raster,) * 3)
    for cell in np.ndindex(levels.shape):
        if vote(solids, np.array(cell), 1.0) > 0:
            parts = itertools.product(np.arange(subdivision) / subdivision, repeat=3)
            levels[cell] = sum(vote(solids, cell + np.array(p), 1 / subdivision) for p in parts) / subdivision**3
    return levels


@pytest.mark.parametrize("model", [STANDARD, OVERLAP, GAP, BEYOND, RING])
@pytest.mark.parametrize("subdivision", [1, 3])
def test_the_literal_algorithms(model: Model, subdivision: int) -> None:
    levels = fill(model, 5, "corners", subdivision)
    assert np.allclose(levels, literal(model, 5, subdivision), rtol=0, atol=1e-15)


def test_a_gap_between_full_corners_is_seen() -> None:
    levels = fill(GAP, 5, "corners", 20)
    # The gap is a quarter of the cell; its faces lie on the sub-lattice, where each votes half a sub-cell in.
    assert levels[2, 2, 2] == pytest.approx(0.75 + 2 * 0.5 / 20, abs=1e-12)


def test_the_standard_scene_has_458_surfels() -> None:
    model = load("standard").model
    assert model == STANDARD
    surfels = make_surfels(fill(STANDARD, 16, "corners", 20), Settings())
    assert (len(surfels), surfels.without_normal) == (458, 0)


@pytest.mark.parametrize("raster, subdivision", [(3, 1), (7, 20), (16, 7)])
def test_levels_are_exact_in_full_and_empty_cells(raster: int, subdivision: int) -> None:
    levels = fill(Model((Box((0.5, 0.5, 0.5), (3, 3, 3)),), raster), raster, "corners", subdivision)
    assert levels.shape == (raster,) * 3 and (levels == 1).all()
    assert (fill(Model((Sphere((9, 9, 9), 1),), raster), raster, "corners", subdivision) == 0).all()


def test_a_half_space_fills_in_proportion() -> None:
    levels = fill(Model((Box((0.5, 0.5, 0.0), (3, 3, 1.15)),), 2), 2, "corners", 20)
    assert np.allclose(levels[:, :, 0], 1, atol=1e-15)
    assert np.allclose(levels[:, :, 1], 0.15, atol=0.5 / 20)


def test_volumes_converge_to_the_analytic_ones() -> None:
    exact = 4 / 3 * math.pi * 0.25**3 + 0.2 * 0.4 * 0.3
    errors = [abs(fill(STANDARD, n, "corners", 20).sum() / n**3 - exact) / exact for n in (8, 16, 32, 64)]
    # Corners on the boxes' faces vote half a sub-cell out, so the error falls like the edge of a cell.
    assert all(coarse > 1.8 * fine for coarse, fine in itertools.pairwise(errors))
    assert errors[3] < 0.003


@pytest.mark.parametrize("piece", [1, 1 << 13, 1 << 17])
def test_cells_beside_an_aligned_face_do_not_depend_on_the_pieces(piece: int, monkeypatch: pytest.MonkeyPatch) -> None:
    box = Model((Box((0.5, 0.5, 0.5), (0.5, 0.5, 0.5)),), 8)
    monkeypatch.setattr("jaart.core.fill_corners.PIECE", piece)
    assert np.allclose(fill(box, 8, "corners", 5), literal(box, 8, 5), rtol=0, atol=1e-15)


def test_overlaps_count_once() -> None:
    twice = Model((*STANDARD.solids, *STANDARD.solids), 16)
    assert np.array_equal(fill(twice, 16, "corners", 4), fill(STANDARD, 16, "corners", 4))


def test_a_solid_between_the_corners_is_missed() -> None:
    assert (fill(Model((Sphere((0.125, 0.125, 0.125), 0.1),), 4), 4, "corners", 20) == 0).all()


def test_a_lattice_beyond_memory_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "limit", lambda: 4 << 30)
    with pytest.raises(SettingsError, match="raster = 2048: needs 128 GiB of memory, more than the 4 GiB"):
        fill(STANDARD, 2048, "corners", 20)


def test_unknown_fillings() -> None:
    with pytest.raises(SettingsError, match="filling = 'best': expected accurate or corners"):
        fill(STANDARD, 4, "best", 2)
