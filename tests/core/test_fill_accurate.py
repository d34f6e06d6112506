"""Accurate fill levels: against analytic volumes, fine grids of lines and points, and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaart.core import fill_accurate
from jaart.core.fill_accurate import accurate, covered
from jaart.core.model import fill
from jaart.core.quadrature import integrate
from jaart.core.scene import Model
from jaart.core.shapes import Box, Cylinder, Ellipsoid, Solid, Sphere, Torus

C = (0.5, 0.52, 0.47)
BALLS = (Sphere((0.4, 0.5, 0.5), 0.2), Sphere((0.6, 0.5, 0.5), 0.25))
MIXED = (Sphere((0.35, 0.5, 0.5), 0.2), Cylinder(C, (1, 2, 3), 0.15, 0.5), Box(C, (0.3, 0.37, 0.22)))


def lens(d: float, a: float, b: float) -> float:
    """Volume that two balls a distance d apart share."""
    return math.pi * (a + b - d) ** 2 * (d * d + 2 * d * (a + b) - 3 * (a - b) ** 2) / (12 * d)


def levels(solids: tuple[Solid, ...], raster: int) -> np.ndarray:
    return fill(Model(solids, raster), raster, "accurate", 20)


@pytest.mark.parametrize("solids, volume", [
    ((Sphere(C, 0.3),), 4 / 3 * math.pi * 0.3**3),
    ((Sphere(C, 0.013),), 4 / 3 * math.pi * 0.013**3),
    ((Box(C, (0.3, 0.37, 0.22)),), 0.3 * 0.37 * 0.22),
    ((Ellipsoid(C, (0.4, 0.25, 0.1)),), 4 / 3 * math.pi * 0.01),
    ((Ellipsoid(C, (0.4, 0.25, 0.02)),), 4 / 3 * math.pi * 0.002),
    ((Cylinder(C, "z", 0.21, 0.5),), math.pi * 0.21**2 * 0.5),
    ((Cylinder(C, (1, 2, 3), 0.21, 0.5),), math.pi * 0.21**2 * 0.5),
    ((Torus(C, "z", 0.3, 0.1),), 2 * math.pi**2 * 0.3 * 0.1**2),
    (BALLS, 4 / 3 * math.pi * (0.2**3 + 0.25**3) - lens(0.2, 0.2, 0.25)),
    ((Sphere(C, 0.3), Sphere(C, 0.3), Sphere(C, 0.2)), 4 / 3 * math.pi * 0.3**3),
], ids=["ball", "speck", "box", "ellipsoid", "plate", "cylinder", "tilted", "torus", "union", "twice"])
def test_volumes(solids: tuple[Solid, ...], volume: float) -> None:
    found = levels(solids, 16)
    assert found.min() >= 0 and found.max() <= 1
    assert found.sum() / 16**3 == pytest.approx(volume, rel=1e-7)


def test_boxes_are_exact() -> None:
    box = Box((0.45, 0.5, 0.55), (0.61, 0.43, 0.37))
    low, high = box.scaled(9).bounds
    edge = np.arange(9)
    share = [np.clip(np.minimum(edge + 1, high[k]) - np.maximum(edge, low[k]), 0, 1) for k in range(3)]
    exact = share[0][:, None, None] * share[1][:, None] * share[2]
    assert np.abs(levels((box,), 9) - exact).max() < 1e-15 * 4
    assert np.abs(levels((box, box), 9) - exact).max() < 1e-15 * 4


@pytest.mark.parametrize("raster", [3, 5, 10, 16, 20, 64])
def test_faces_of_the_lattice_leave_no_trace(raster: int) -> None:
    """What is full or empty but for rounding is so exactly: else it would become a surfel."""
    cut = max(1, raster // 5)
    size = (raster - 2 * cut) / raster
    found = levels((Box((0.5, 0.5, 0.5), (size, size, size)),), raster)
    assert set(np.unique(found)) <= {0.0, 1.0}
    assert found.sum() == (raster - 2 * cut) ** 3
    assert (levels((Box((0.5, 0.5, 0.5), (3, 3, 3)), Sphere((0.5, 0.5, 0.5), 0.3)), raster) == 1).all()
    assert (levels((Sphere((9, 9, 9), 1), Torus((-3, 0, 0), "x", 1, 0.5)), raster) == 0).all()


@pytest.mark.parametrize("solids", [(Sphere(C, 0.3),), (Torus(C, (1, 2, 3), 0.3, 0.1),), BALLS, MIXED[:2]],
                         ids=["ball", "torus", "union", "mixed"])
def test_every_cell_against_a_fine_grid_of_lines(solids: tuple[Solid, ...]) -> None:
    """Midpoints of 96² lines along z: their error is below 1e-4 where no face is parallel to them."""
    raster, fine = 6, 96
    found = levels(solids, raster)
    ticks = (np.arange(raster * fine) + 0.5) / fine
    scaled = [solid.scaled(raster) for solid in solids]
    inner = np.flatnonzero((found > 0.02) & (found < 0.98))[::15]
    for i, j, k in np.stack(np.unravel_index(inner, found.shape), axis=1):
        x, y = np.meshgrid(ticks[i * fine:(i + 1) * fine], ticks[j * fine:(j + 1) * fine])
        lines = np.stack([x.ravel(), y.ravel(), np.full(x.size, float(k))], axis=1)
        assert found[i, j, k] == pytest.approx(covered(scaled, lines, 2).mean(), abs=1e-4)


def test_points_agree() -> None:
    """The lengths themselves against what the solids hold."""
    raster, fine = 4, 32
    found = levels(MIXED, raster)
    ticks = (np.arange(raster * fine) + 0.5) / fine / raster
    held = np.logical_or.reduce([s.holds(ticks[:, None, None], ticks[:, None], ticks) for s in MIXED])
    counted = held.reshape(raster, fine, raster, fine, raster, fine).mean(axis=(1, 3, 5))
    assert np.abs(found - counted).max() < 1e-2  # a face between two layers of points


@pytest.mark.parametrize("solids", [(Sphere(C, 0.3),), (Ellipsoid(C, (0.4, 0.2, 0.1)),), BALLS, MIXED],
                         ids=["ball", "ellipsoid", "union", "mixed"])
def test_levels_do_not_depend_on_the_lines_axis(solids: tuple[Solid, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    """Along each axis kinks, silhouettes and edges lie elsewhere in the integrals."""
    found = [levels(solids, 5)]
    for axis in range(3):
        monkeypatch.setattr(fill_accurate, "_steepest", lambda _, cells, axis=axis: np.full(len(cells), axis))
        found.append(levels(solids, 5))
    assert np.ptp(found, axis=0).max() < 1e-6


def test_cells_entered_between_their_corners_are_found() -> None:
    speck = levels((Sphere((0.125, 0.125, 0.125), 0.1),), 4)
    assert speck[0, 0, 0] == pytest.approx(4 / 3 * math.pi * 0.4**3, rel=1e-7) and (speck > 0).sum() == 1
    height = 1e-3  # how far a cap pokes through a face, in cells
    radius = 1.3
    poking = levels((Sphere((0.375, 0.375, 0.5 + (height - radius) / 4), radius / 4),), 4)
    assert poking[1, 1, 2] == pytest.approx(math.pi * height**2 * (radius - height / 3), abs=2e-8)


def test_a_cell_with_every_corner_inside_a_torus_may_have_a_hole() -> None:
    torus = Torus((0.5, 0.5, 0.5), "z", 0.45, 0.4)
    found = levels((torus,), 1)[0, 0, 0]
    x = (np.arange(200) + 0.5) / 200
    lines = np.stack([*(v.ravel() for v in np.meshgrid(x, x)), np.zeros(200**2)], axis=1)
    assert found == pytest.approx(covered([torus], lines, 2).mean(), abs=2e-5)


place = st.tuples(*[st.floats(0.1, 0.9)] * 3)
some = st.one_of(st.builds(Sphere, place, st.floats(0.01, 0.5)),
                 st.builds(Ellipsoid, place, st.tuples(*[st.floats(0.02, 0.5)] * 3)),
                 st.builds(Box, place, st.tuples(*[st.floats(0.02, 0.7)] * 3)),
                 st.builds(Cylinder, place, st.sampled_from("xyz"), st.floats(0.02, 0.3), st.floats(0.02, 0.6)))


@settings(max_examples=15)
@given(some, some)
def test_a_finer_lattice_fills_the_same(first: Solid, second: Solid) -> None:
    coarse, fine = levels((first, second), 3), levels((first, second), 6)
    mean = fine.reshape(3, 2, 3, 2, 3, 2).mean(axis=(1, 3, 5))
    assert np.abs(coarse - mean).max() < 2e-6


def test_integrals_with_kinks_jumps_and_roots() -> None:
    owner, low, high = np.arange(4), np.zeros(4), np.ones(4)

    def values(which: np.ndarray, x: np.ndarray) -> np.ndarray:
        return np.choose(which, [x**11, np.abs(x - 0.3), (x > math.sqrt(0.5)) * 1.0, np.sqrt(np.abs(x - 0.1))])

    found = integrate(values, owner, low, high, 5, 1e-10)
    exact = [1 / 12, (0.3**2 + 0.7**2) / 2, 1 - math.sqrt(0.5), 2 / 3 * (0.1**1.5 + 0.9**1.5), 0]
    assert np.abs(found - exact).max() < 5e-9


def test_no_solids() -> None:
    assert (accurate([], 3) == 0).all()
