"""What a person is told of a lattice: cells that gave no surfel, no surfels at all, solids too small for it."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.notes import notes
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Box, Sphere

BALL = Sphere((0.5, 0.5, 0.5), 0.25)


def said(levels: np.ndarray, **values: object) -> tuple[str, ...]:
    return notes(Scene("lattice", levels=levels), Settings(**values))


def of_solids(*solids: Sphere | Box, **values: object) -> list[str]:
    scene = Scene("solids", model=Model(solids, 16))
    return [text for text in notes(scene, Settings(**values)) if "thinner than a cell" in text]


def test_cells_without_a_normal_are_counted_where_they_are_many() -> None:
    levels = np.zeros((9, 9, 9))
    levels[0], levels[1] = 1.0, 0.5
    levels[4, 2, 2] = 0.5
    assert said(levels) == ()
    levels = np.zeros((9, 4, 4))
    levels[0], levels[1] = 1.0, 0.5
    assert said(levels) == ()
    levels[4, 2, 2] = 0.5
    assert said(levels) == ("1 interface cell without a normal left out: the level does not change across them",)
    levels[7, 2, 2] = 0.3
    assert said(levels)[0].startswith("2 interface cells without a normal")


@pytest.mark.parametrize("h", [0.8, 3.0])
@pytest.mark.parametrize(("level", "why"), [(0.0, "no cell has a level between 0 and 1"),
                                           (1.0, "no full cell lies beside an empty one"),
                                           (0.5, "8 interface cells, but the level changes at none")])
def test_no_surface_is_said_once(level: float, why: str, h: float) -> None:
    note, = said(np.full((2, 2, 2), level), h=h)
    assert note.startswith("0 surfels, so there is no surface") and why in note


def test_solids_that_a_cell_may_hold_are_counted() -> None:
    small, plate = Sphere((0.2, 0.2, 0.2), 0.15 / 16), Box((0.7, 0.7, 0.7), (0.4, 0.4, 0.05))
    assert of_solids(BALL) == []
    note, = of_solids(BALL, small)
    assert note.startswith("1 of 2 solids is thinner than a cell, 0.3: it has meaningful normals only")
    note, = of_solids(BALL, small, plate)
    assert note.startswith("2 of 3 solids are thinner than a cell, 0.3: they have")
    assert of_solids(plate, raster=20) == []
