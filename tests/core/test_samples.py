"""The bumpy sphere: points on it, normals of it and rays to it agree."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.samples import COUNT, BumpySphere, bumpy_sphere, fibonacci, standard_bumps, unit

BUMPS = standard_bumps()
RNG = np.random.default_rng(4)


def sampled_first_hit(origin: np.ndarray, direction: np.ndarray, steps: np.ndarray) -> float:
    """The first of many places along a ray on the other side of the surface than its origin; NaN when none is."""
    height = BUMPS.height(origin + steps[:, None] * direction)
    crossed = np.flatnonzero(np.sign(height) != np.sign(height[0]))
    return float(steps[crossed[0]]) if len(crossed) else np.nan


def test_the_sample_lies_on_the_surface() -> None:
    scene = bumpy_sphere()
    assert scene.kind == "cloud" and scene.normals is None and scene.source == "bumpy"
    assert scene.points is not None and scene.points.shape == (COUNT, 3)
    assert np.abs(BUMPS.height(scene.points)).max() < 4e-15
    radius = np.linalg.norm(scene.points, axis=1)
    assert BUMPS.inner < radius.min() < 0.99 and 1.1 < radius.max() < BUMPS.outer


def test_normals_are_those_of_the_height() -> None:
    u = unit(RNG.normal(size=(200, 3)))
    x, step = BUMPS.points_along(u), 1e-6
    gradient = np.stack([BUMPS.height(x + step * e) - BUMPS.height(x - step * e) for e in np.eye(3)], axis=1)
    assert np.abs(unit(gradient) - BUMPS.exact_normal(3 * u)).max() < 1e-9
    assert np.abs(np.linalg.norm(BUMPS.exact_normal(u), axis=1) - 1).max() < 1e-15


def test_the_bound_on_the_second_derivative_holds() -> None:
    x = RNG.uniform(BUMPS.inner, BUMPS.outer, (2000, 1)) * unit(RNG.normal(size=(2000, 3)))
    d, step = unit(RNG.normal(size=(2000, 3))), 1e-4
    bend = (BUMPS.height(x + step * d) - 2 * BUMPS.height(x) + BUMPS.height(x - step * d)) / step**2
    assert np.abs(bend).max() > 1
    assert np.abs(bend).max() < BUMPS._bend


@pytest.mark.parametrize("origin", [(3.0, -4.0, 2.0), (0.0, 0.0, 5.0), (0.1, 0.2, -0.1), (0.9, 0.0, 0.1)])
def test_rays_meet_the_surface_first_where_dense_samples_do(origin: tuple[float, ...]) -> None:
    origins = np.tile(origin, (100, 1))
    aim = RNG.normal(size=(100, 3)) * 0.7
    directions = unit(aim - origins)
    t, normal = BUMPS.hit(origins, 2 * directions)
    steps = np.linspace(0, 8, 4001)
    sampled = np.array([sampled_first_hit(o, d, steps) for o, d in zip(origins, directions, strict=True)])
    met = np.isfinite(t)
    assert met.sum() > 20
    assert not np.isfinite(sampled[~met]).any()
    missed_by_samples = met & ~np.isfinite(sampled)  # a ray may graze between two samples
    both = met & ~missed_by_samples
    assert missed_by_samples.sum() <= 2
    assert ((sampled - 2 * t)[both] >= -1e-12).all()
    assert np.quantile((sampled - 2 * t)[both], 0.9) <= 0.002
    x = origins[met] + 2 * t[met, None] * directions[met]
    assert np.abs(BUMPS.height(x)).max() < 4e-15
    assert np.abs(normal[met] - BUMPS.exact_normal(x)).max() < 1e-14
    assert np.isnan(normal[~met]).all()


def test_a_far_origin_costs_its_own_digits_only() -> None:
    d = unit(-RNG.normal(size=(50, 3)))
    near, _ = BUMPS.hit(-3 * d, d)
    far, _ = BUMPS.hit(-3e6 * d, d)
    assert np.isfinite(near).all()
    assert np.abs((far - 3e6) - (near - 3)).max() < 4e-9


def test_rays_that_lead_away_miss() -> None:
    d = unit(RNG.normal(size=(20, 3)))
    assert np.isnan(BUMPS.hit(2 * d, d)[0]).all()


def test_rays_from_the_surface_leave_it() -> None:
    x = BUMPS.points_along(fibonacci(500))
    normal = BUMPS.exact_normal(x)
    t, inner = BUMPS.hit(x, -normal)
    assert t.min() > 0.5
    assert ((inner * normal).sum(axis=1) < 0).mean() > 0.95
    outwards = BUMPS.hit(x, normal)[0]
    assert np.isnan(outwards).all()  # its valleys are wide
    back = BUMPS.hit(x + 0.5 * normal, -normal)[0]
    assert np.abs(back - 0.5).max() < 1e-13


def test_rays_that_graze_come_to_an_end() -> None:
    x = BUMPS.points_along(fibonacci(300))
    tangent = unit(np.cross(BUMPS.exact_normal(x), RNG.normal(size=(300, 3))))
    t, _ = BUMPS.hit(x - 2 * tangent, tangent)
    assert (t[np.isfinite(t)] < 2 + 1e-6).mean() > 0.5
    assert np.abs(BUMPS.height((x + (t - 2)[:, None] * tangent)[np.isfinite(t)])).max() < 1e-13


def test_without_bumps_it_is_a_sphere() -> None:
    smooth = BumpySphere(np.eye(3)[:1], np.zeros(1), np.ones(1), radius=2.0)
    origins, directions = RNG.normal(size=(200, 3)) * 3, unit(RNG.normal(size=(200, 3)))
    t, normal = smooth.hit(origins, directions)
    along, apart = (origins * directions).sum(axis=1), np.linalg.norm(origins, axis=1)
    with np.errstate(invalid="ignore"):
        half = np.sqrt(along**2 - (apart - 2) * (apart + 2))
    exact = np.where(apart > 2, -along - half, -along + half)
    exact[~(exact > 0)] = np.nan
    assert np.array_equal(np.isnan(t), np.isnan(exact)) and 20 < np.isfinite(t).sum() < 180
    met = np.isfinite(t)
    assert np.abs(t - exact)[met].max() < 1e-13
    assert np.abs(normal - (origins + exact[:, None] * directions) / 2)[met].max() < 1e-13


def test_directions_are_spread_evenly() -> None:
    u = fibonacci(1000)
    assert np.abs(np.linalg.norm(u, axis=1) - 1).max() < 4e-16
    assert np.linalg.norm(u.mean(axis=0)) < 1e-3
    nearest = np.sort(np.linalg.norm(u[:, None] - u, axis=2), axis=1)[:, 1]
    assert nearest.min() > 0.8 * nearest.max()
