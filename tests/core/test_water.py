"""Rays through water: against ball lenses worked out by hand, energy, self hits, and through real lattices."""

from __future__ import annotations

import math

import numpy as np
import pytest
from exact_rays import exact_hits

from jaart.core import water as water_module
from jaart.core.environment import Environment
from jaart.core.optics import dots, split, unit
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.secondary import beside, first_hits, tracer
from jaart.core.shapes import Sphere
from jaart.core.water import ABSORPTION, water
from tests.core.water_scenes import BALL, PLAIN, WIDE, Array, White, exact

IOR = 1.33


class Compass(Environment):
    """Light that tells its direction."""

    def colour(self, origin: Array, direction: Array) -> Array:
        return direction + 1.0


def parallel(count: int) -> Hits:
    """Rays along x at heights over the whole ball, and beside it."""
    y = np.linspace(-2.2, 2.2, count)
    origin = np.column_stack([np.full(count, -9.0), y, 0 * y])
    return exact_hits([BALL], origin, np.tile([1.0, 0.0, 0.0], (count, 1)))


def ball_scene(raster: int = 24) -> Scene:
    return Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), raster))


@pytest.mark.parametrize("depth", [0, 1, 3, 12])
@pytest.mark.parametrize("ior", [1.0, IOR, 2.4])
def test_no_light_is_lost_or_made(depth: int, ior: float) -> None:
    seen = water(parallel(801), PLAIN.replace(depth=depth, ior=ior), White(*WIDE), exact())
    assert np.abs(seen.colour - 1).max() < 1e-12
    assert (seen.rays > 0) == (depth > 0)


def test_a_ball_lens_worked_out_by_hand() -> None:
    height = 1.1
    hits = exact_hits([BALL], np.array([[-9.0, height, 0.0]]), np.array([[1.0, 0.0, 0.0]]))
    seen = water(hits, PLAIN.replace(depth=1), Compass(*WIDE), exact())
    outside, inside = math.asin(height / 2), math.asin(height / 2 / IOR)
    share = float(split(np.array([[math.sin(outside), 0, -math.cos(outside)]]), np.array([[0.0, 0, 1]]),
                        1 / IOR).reflectance[0])

    def way(turn: float) -> Array:
        return np.array([math.cos(turn), -math.sin(turn), 0.0])

    mirrored, through = way(2 * outside - math.pi), way(2 * (outside - inside))
    again = way(outside - inside + math.pi - 2 * inside)  # mirrored within, where depth 1 ends
    told = share * mirrored + (1 - share) * ((1 - share) * through + share * again)
    assert seen.colour[0] == pytest.approx(told + 1, abs=1e-11)
    assert (seen.rays, seen.deep, seen.faint, seen.lost) == (2, 2, 0, 0)


def test_a_whispering_gallery_ends_and_is_counted() -> None:
    start = np.array([[0.0, 1.9, 0.0]])  # beyond the critical angle at every bounce
    hits = exact_hits([BALL], start, np.array([[1.0, 0.0, 0.0]]))
    for depth in (0, 5, 64):
        seen = water(hits, PLAIN.replace(depth=depth), White(*WIDE), exact())
        assert (seen.rays, seen.deep, seen.faint) == (depth, 1, 0)
        assert seen.colour[0] == pytest.approx(1, abs=1e-12)


def test_faint_rays_are_counted_and_bring_their_light() -> None:
    seen = water(parallel(101), PLAIN.replace(depth=64), White(*WIDE), exact())
    assert seen.faint > 50 and seen.deep == 0 and np.abs(seen.colour - 1).max() < 1e-12


def test_water_takes_light_by_the_length_of_the_way() -> None:
    hits = exact_hits([BALL], np.array([[-9.0, 0, 0], [-9, 1, 0], [-9, 3, 0]]), np.tile([1.0, 0, 0], (3, 1)))
    around = White(np.full(3, -5.0), np.full(3, 5.0))
    seen = water(hits, PLAIN.replace(ior=1.0), around, exact())
    ways = np.array([4.0, 2 * math.sqrt(3), 0])
    assert seen.colour == pytest.approx(np.exp(-np.outer(ways / 10, ABSORPTION)), abs=1e-11)


def test_an_open_border_is_passed_unbent() -> None:
    levels = np.zeros((8, 8, 8))
    levels[:, :, :4] = 1
    levels[:, :, 4] = 0.5
    scene, settings = Scene("basin", levels=levels), PLAIN.replace(depth=6)
    origin, target = np.array([[-6.0, 4, 6]]), np.array([4.0, 4, 0])
    direction = unit(target - origin)
    hits = render(scene, settings, rays=(origin, direction))
    assert not hits.hit.any()
    around = Environment.of(scene, settings)
    seen = water(hits, settings, around, tracer(scene, settings))
    way = float(np.linalg.norm(target - origin)) * 4 / 10  # 4 of the 10 cells in x lie in the lattice
    assert seen.colour == pytest.approx(around.floor(target[None, :2]) * np.exp(-way / 8 * ABSORPTION), rel=1e-9)
    assert seen.lost == 0


def test_a_calm_basin_bends_rays_by_snell() -> None:
    levels = np.zeros((24, 24, 12))
    levels[:, :, :6] = 1
    levels[:, :, 6] = 0.5
    scene, settings = Scene("basin", levels=levels), PLAIN.replace(tolerance=1e-9, depth=6)
    direction = unit(np.array([[0.5, 0.3, -1.0]]))
    hits = render(scene, settings, rays=(np.array([[9.0, 9, 11]]), direction))
    height = hits.point[0, 2]
    assert height == pytest.approx(6.5, abs=0.02) and hits.normal[0] == pytest.approx([0, 0, 1], abs=1e-6)
    around = Environment.of(scene, settings)
    both = split(direction, hits.normal, 1 / IOR)
    down = both.refracted[0]
    foot, way = hits.point[0] - down * height / down[2], -height / down[2]
    mirrored = around.colour(hits.point, both.reflected)[0]
    share = both.reflectance[0]
    told = share * mirrored + (1 - share) * around.floor(foot[None, :2])[0] * np.exp(-way / 24 * ABSORPTION)
    seen = water(hits, settings, around, tracer(scene, settings))
    assert seen.colour[0] == pytest.approx(told, abs=1e-6)
    assert (seen.rays, seen.deep, seen.lost) == (2, 0, 0)


@pytest.mark.parametrize("tolerance", [0.125, 1e-3, 1e-9])
def test_a_traced_ball_is_left_on_its_far_side(tolerance: float) -> None:
    scene, settings = ball_scene(), PLAIN.replace(tolerance=tolerance)
    hits = render(scene, settings, size=(120, 120))
    at = np.flatnonzero(hits.hit & (dots(hits.normal, hits.direction) < -0.2))
    point, normal = hits.point[at], hits.normal[at]
    both, rays = split(hits.direction[at], normal, 1 / IOR), tracer(scene, settings)
    air, wet = np.zeros(len(at), bool), np.ones(len(at), bool)
    t, _ = first_hits(rays, beside(point, normal, air, rays.offset), both.reflected, air)
    assert len(at) > 1000 and np.isnan(t).all()
    t, leaving = first_hits(rays, beside(point, normal, wet, rays.offset), both.refracted, wet)
    radius = np.linalg.norm(point - 12, axis=1).mean()
    chord = -2 * dots(both.refracted, unit(point - 12)) * radius
    assert (np.abs(t - chord) < 0.6).mean() > 0.99 and np.median(np.abs(t - chord)) < 0.15
    assert (dots(leaving, both.refracted)[np.isfinite(t)] > 0).all()


def test_a_traced_whispering_gallery_ends() -> None:
    scene, settings = ball_scene(), PLAIN.replace(depth=30)
    hits = render(scene, settings, rays=(np.array([[12.0, 12, 18.9]]), np.array([[1.0, 0, 0]])))
    assert hits.hit.all() and dots(hits.normal, hits.direction)[0] > 0
    seen = water(hits, settings, White(*WIDE), tracer(scene, settings))
    assert seen.rays >= 3 and seen.colour[0] == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("inside", [False, True])
def test_the_sheet_that_a_ray_leaves_is_no_hit(inside: bool) -> None:
    """Seen from the start, the surface lies a little on the wrong side of it."""
    seen_from_there = Sphere((0, 0, 0), 2.0 - 0.01 if inside else 2.0 + 0.01)
    normal = unit(np.random.default_rng(8).normal(size=(500, 3)))
    direction = unit(np.random.default_rng(9).normal(size=(500, 3)))
    steep = np.abs(dots(normal, direction)) > 0.1
    normal = normal[steep]
    direction = direction[steep] * np.copysign(1.0, dots(normal, direction[steep]) * (-1 if inside else 1))[:, None]
    flags = np.full(len(normal), inside)
    start = beside(2 * normal, normal, flags, 1e-3)
    t, _ = first_hits(exact(seen_from_there, near=0.3), start, direction, flags)
    if inside:
        assert np.abs(np.linalg.norm(start + t[:, None] * direction, axis=1) - 1.99).max() < 1e-12
        assert (t > 0.2).all()
    else:
        assert np.isnan(t).all()
    believed, _ = first_hits(exact(seen_from_there, near=0.0), start, direction, flags)
    assert (believed < 0.15).all()


def test_pieces_and_threads_do_not_show(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = ball_scene()
    hits = render(scene, PLAIN, size=(64, 64))
    around = Environment.of(scene, PLAIN)

    def colour(threads: int) -> Array:
        return water(hits, PLAIN, around, tracer(scene, PLAIN, threads)).colour

    whole = colour(1)
    monkeypatch.setattr(water_module, "PIECE", 1000)
    assert np.array_equal(whole, colour(1)) and np.array_equal(whole, colour(3))
    assert np.isfinite(whole).all() and whole.min() >= 0 and len(np.unique(whole, axis=0)) > 3000


def test_rays_that_found_no_surface_are_lost_and_counted() -> None:
    around = Environment(np.zeros(3), np.full(3, 8.0), np.pad(np.ones((8, 8, 4)), ((0, 0), (0, 0), (0, 4))))
    nothing = exact_hits([Sphere((50, 50, 50), 1)], np.array([[4.0, 4, 12], [4, 4, 2]]),
                         np.array([[0.0, 0, -1], [0, 0, 1]]))
    seen = water(nothing, PLAIN, around, exact())
    assert seen.lost == 2 and seen.rays == 0
    for pixel, (begin, way) in enumerate(((12, -1.0), (2, 1.0))):
        length = 4 if way < 0 else 2
        told = around.colour(np.array([[4.0, 4, begin]]), np.array([[0, 0, way]]))[0] * np.exp(-length / 8 * ABSORPTION)
        assert seen.colour[pixel] == pytest.approx(told, abs=1e-4)


def test_water_behind_a_ray_takes_nothing() -> None:
    around = Environment(np.zeros(3), np.full(3, 8.0), np.ones((8, 8, 8)))
    origin = np.array([[4.0, 4, -1], [-3, 4, 4], [4, 20, 4]])
    direction = unit(np.array([[0.0, 0, -1], [-1, 0, 0.5], [1, 0, 0]]))
    seen = water(exact_hits([Sphere((50, 50, 50), 1)], origin, direction), PLAIN, around, exact())
    assert np.allclose(seen.colour, around.colour(origin, direction), rtol=1e-14) and seen.lost == 0
