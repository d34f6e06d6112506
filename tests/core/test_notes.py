"""What a person is told of a scene: only what is true, and nothing where all is well."""

from __future__ import annotations

import math

import numpy as np
import pytest

from jaart.core import cloud, prepare
from jaart.core.errors import SettingsError
from jaart.core.io import load
from jaart.core.notes import notes, of_hits
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings, preset
from jaart.core.shapes import Box, Cylinder, Ellipsoid, Solid, Sphere, Torus

RASTER = 24
MIDDLE = (0.5, 0.5, 0.5)
#: Solids whose first length is so small, in cells, and the h at which it is the least, in it.
SMALL: dict[str, tuple[Solid, float]] = {
    "radius": (Sphere(MIDDLE, 3 / RASTER), 3 / math.sqrt(1.5)),
    "tube": (Cylinder(MIDDLE, "z", 2 / RASTER, 16 / RASTER), 2.0),
    "height": (Cylinder(MIDDLE, "z", 8 / RASTER, 3 / RASTER), 3 / math.sqrt(2)),
    "thickness": (Box(MIDDLE, (16 / RASTER, 16 / RASTER, 3 / RASTER)), 3 / math.sqrt(2)),
    "disc": (Ellipsoid(MIDDLE, (9 / RASTER, 9 / RASTER, 2 / RASTER)), 4 / math.sqrt(2)),
    "needle": (Ellipsoid(MIDDLE, (2 / RASTER, 2 / RASTER, 10 / RASTER)), 2.0),
    "egg": (Ellipsoid(MIDDLE, (2.9 / RASTER, 2.9 / RASTER, 3 / RASTER)), 3 / math.sqrt(1.5)),
    "ring": (Torus(MIDDLE, "z", 8 / RASTER, 2 / RASTER), 2.0),
}


def of_solids(*solids: Solid) -> Scene:
    return Scene("solids", model=Model(solids, RASTER))


def sphere(count: int = 200, at: float = 0.0) -> Scene:
    return Scene("sphere", points=fibonacci(count) + at, normals=fibonacci(count))


@pytest.mark.parametrize("scene", [load("standard"), load("bumpy"), sphere()], ids=["standard", "bumpy", "sphere"])
@pytest.mark.parametrize("settings", [Settings(), preset("best"), Settings(search="safe", tolerance=1e-9)],
                         ids=["default", "best", "safe"])
def test_nothing_is_said_where_all_is_well(scene: Scene, settings: Settings) -> None:
    if scene.kind == "cloud":
        settings = settings.replace(patch=0.0)
    assert notes(scene, settings) == ()


def left(solid: Solid, h: float) -> float:
    """How far from its middle a ray down on it meets it, as a share of half its length; 0 where it misses it."""
    x, y = (20.05, 12.3) if isinstance(solid, Torus) else (12.3, 12.4)
    settings = Settings(h=h, search="safe", tolerance=1e-6)
    hits = render(of_solids(solid), settings, rays=(np.array([[x, y, 30.0]]), np.array([[0.0, 0.0, -1.0]])))
    half = float(solid.bounds[1][2] - solid.bounds[0][2]) * RASTER / 2
    return max(float(hits.point[0, 2] - 12) / half, 0.0) if hits.hit[0] else 0.0


@pytest.mark.parametrize("name", SMALL)
def test_a_solid_is_said_to_collapse_where_it_does(name: str) -> None:
    """Law and lattice agree: 5 hundredths beyond the limit a ray on its middle meets nothing but the middle."""
    solid, gone = SMALL[name]
    (said,) = notes(of_solids(solid), Settings(h=1.05 * gone))
    assert said.startswith(f"{type(solid).__name__.lower()} 1 has a ") and f"at h = {1.05 * gone:.4g} " in said
    assert notes(of_solids(solid), Settings(h=0.95 * gone)) == ()
    if name not in ("tube", "needle"):  # these are seen from the side
        assert left(solid, 1.05 * gone) < 0.15 and left(solid, 0.8 * gone) > 0.4


@pytest.mark.parametrize("axis", ["tube", "needle"])
def test_what_is_long_is_gone_from_the_side(axis: str) -> None:
    solid, gone = SMALL[axis]
    ray = (np.array([[30.0, 12.2, 12.3]]), np.array([[-1.0, 0.0, 0.0]]))
    settings = Settings(search="safe", tolerance=1e-6)
    assert not render(of_solids(solid), settings.replace(h=1.05 * gone), rays=ray).hit.any()
    assert render(of_solids(solid), settings.replace(h=0.8 * gone), rays=ray).hit.all()


def test_what_is_said_of_a_sphere() -> None:
    assert notes(of_solids(Sphere(MIDDLE, 3 / RASTER)), Settings(h=2.5)) == (
        "sphere 1 has a radius of 3: at h = 2.5 spheres below 3.062 (1.225 h) collapse, and little is left of them",)


@pytest.mark.parametrize("settings", [
    Settings(h=2.5, method="polynomial", degree=2), Settings(h=2.5, search="minimise"),
    Settings(h=2.5, weight="wendland"), Settings(h=2.5, neighbourhood="cell_knn"), Settings(h=2.5, radius=4.0),
    Settings(method="fill_level")])
def test_no_solid_is_said_to_collapse_where_the_law_does_not_hold(settings: Settings) -> None:
    assert notes(of_solids(Sphere(MIDDLE, 3 / RASTER)), settings) == ()


def test_a_parabola_keeps_the_sphere_of_which_it_is_not_said() -> None:
    scene = of_solids(Sphere(MIDDLE, 3 / RASTER))
    settings = Settings(h=2.5, method="polynomial", degree=2, search="safe")
    assert render(scene, settings, size=(32, 32)).hit.sum() > 10


def test_a_solid_that_others_hold_up_or_the_lattice_cuts_off_is_left_out() -> None:
    ball = Sphere(MIDDLE, 3 / RASTER)
    assert notes(of_solids(ball, Box((0.5, 0.5, 0.3), (0.4, 0.4, 0.2))), Settings(h=2.5)) == ()
    assert notes(of_solids(Sphere((0.5, 0.5, 0.99), 3 / RASTER), Box(MIDDLE, (0.3,) * 3)), Settings(h=2.5)) == ()


def test_many_solids_that_collapse_are_counted() -> None:
    balls = [Sphere((x, y, 0.5), 0.04) for x in (0.1, 0.5, 0.9) for y in (0.1, 0.9)]
    assert notes(of_solids(*balls), Settings(h=0.7)) == ()
    said = notes(of_solids(*balls), Settings())
    assert len(said) == 4 and said[2].startswith("sphere 3 has") and said[3] == "so it is with 3 more of the solids"


def test_an_h_larger_than_everything() -> None:
    said = ("h = 1000 is larger than all the points together, {}: no surface can be expected, or a flat one through "
            "their middle")
    assert notes(sphere(2000), Settings(h=1000)) == (said.format(1.999),)
    assert notes(load("standard"), Settings(h=1000))[0] == said.format(13)
    assert notes(sphere(2000), Settings(h=1.9)) == ()


def test_more_neighbours_than_points() -> None:
    cube = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1.0)])
    scene = Scene("corners", points=cube, normals=np.tile((0, 0, 1.0), (4, 1)))
    settings = Settings(h=0.5)
    assert notes(scene, settings) == ("ball_k = 6: there are only 3 other points",)
    assert notes(scene, settings.replace(ball_k=3)) == ()
    assert notes(scene, settings.replace(ball_k=3, neighbourhood="knn")) == ("k = 12: there are only 4 points",)
    assert notes(scene, settings.replace(ball_k=3, neighbourhood="knn", k=4)) == ()
    two = Scene("two", points=cube[:2], normals=np.tile((0, 0, 1.0), (2, 1)))
    assert notes(two, settings) == ("ball_k = 6: there is only 1 other point",)
    surfels = len(prepare.surfels(load("standard"), Settings()))
    assert notes(load("standard"), Settings(neighbourhood="knn", k=surfels)) == ()
    assert notes(load("standard"), Settings(neighbourhood="knn", k=surfels + 1)) == (
        f"k = {surfels + 1}: there are only {surfels} surfels",)


def test_a_single_point_has_a_disc_as_large_as_h() -> None:
    scene = Scene("one", points=np.zeros((1, 3)), normals=np.array([(0, 0, 1.0)]))
    assert notes(scene, Settings(h=0.5)) == ("there is a single point: its ball has the radius h",)
    x = np.array([0.0, 0.45, 0.55, 0.95, 1.05])
    eyes, down = np.stack((x, 0 * x, 0 * x + 3), axis=1), np.tile((0, 0, -1.0), (5, 1))
    for h in (0.5, 1.0, 0.5):
        hits = render(scene, Settings(h=h, radius=4.0), rays=(eyes, down))
        assert hits.hit.tolist() == (x < h).tolist() and (hits.t[hits.hit] == 3).all()


def test_normals_that_are_not_defined_are_said() -> None:
    line = Scene("line", points=np.linspace(-1, 1, 30)[:, None] * (1, 2, 3))
    assert any("30 normals are undefined" in note for note in notes(line, Settings(search="safe")))


def test_a_tolerance_below_what_coordinates_can_tell() -> None:
    far, settings = sphere(at=1e9), Settings(h=0.4, tolerance=1e-9)
    assert notes(far, settings) == ("coordinates up to 1e+09 are exact to 1.2e-07, and hits no more than that: the "
                                    "tolerance is 1e-09 h, a length of 4e-10",)
    assert notes(far, settings.replace(tolerance=1e-6)) == ()
    assert notes(far, Settings(h=0.4, tolerance=0.0, search="centres")) == ()
    assert notes(far, settings.replace(radius=0.2))[-1].endswith("the tolerance is 1e-09 radii, a length of 2e-10")
    assert "the tolerance is 0" in notes(sphere(), Settings(tolerance=0.0))[0]


def test_settings_that_make_no_sense_are_refused_as_by_rays() -> None:
    with pytest.raises(SettingsError, match="too small for coordinates"):
        notes(sphere(), Settings(h=1e-160))


def test_rays_that_meet_no_normal_are_counted() -> None:
    line, ways = Scene("line", points=np.linspace(-1, 1, 30)[:, None] * (1, 2, 3)), fibonacci(12)
    found = render(line, Settings(h=0.5), rays=(0.05 * ways[::-1] - 3 * ways, ways))
    assert of_hits(line, found) == ("no normal is defined for 12 of the 12 rays that came near: points along a line or "
                                    "in one place have no surface",)
    away = render(line, Settings(h=0.5), rays=(ways + 50, ways))
    assert away.counts() == {"background": 12} and of_hits(line, away) == ()


@pytest.mark.parametrize(("settings", "origin"), [
    (Settings(radius=0.001), "0.001 (as set)"), (Settings(h=0.0002), "0.0008 (4 h)"),
    (Settings(radius="0.1s"), " (0.1 of the spacing, as set)")], ids=["radius", "h", "spacings"])
def test_a_radius_below_the_spacing_is_named_where_normals_are_undefined(settings: Settings, origin: str) -> None:
    bumpy = load("bumpy")
    (said,) = of_hits(bumpy, render(bumpy, settings.replace(normal="covariance"), size=(24, 24)))
    assert f"{origin} holds too few points for a surface, as they lie {cloud.spacing(bumpy):.4g} apart" in said
    assert ": radius = " in said


def test_normals_that_cancel_out_are_told_from_points_without_a_surface() -> None:
    square = np.stack((*(a.ravel() for a in np.mgrid[-3:4, -3:4]), np.zeros(49)), axis=1).astype(float)
    pair = Scene("pair", points=np.concatenate((square + (0, 0, 1), square - (0, 0, 1))),
                 normals=np.repeat([[0, 0, 1.0], [0, 0, -1.0]], 49, axis=0))
    flat = np.stack((np.cos(np.arange(6)), np.sin(np.arange(6)), np.zeros(6)), axis=1)
    settings = Settings(h=2.0, search="safe", max_nearest="none", max_off_centre="none")
    found = render(pair, settings, rays=(0.1 * flat, flat))
    assert found.counts() == {"undefined_normal": 6}
    assert of_hits(pair, found)[0].endswith("6 of the 6 rays that came near: normals that cancel each other out have "
                                            "no average")


def test_bad_rays_are_counted_and_nothing_is_said_of_good_ones() -> None:
    eyes, ways = np.tile((0.1, 0.2, 9.0), (4, 1)), np.tile((0, 0, -1.0), (4, 1))
    assert of_hits(sphere(), render(sphere(), rays=(eyes, ways))) == ()
    ways[2] = 0
    (said,) = of_hits(sphere(), render(sphere(), rays=(eyes, ways)))
    assert said.startswith("1 of 4 rays is no ray (bad_ray), the first is number 2, counted from 0; expected finite")
