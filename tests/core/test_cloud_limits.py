"""Clouds that are hardly any, points without normals, measured ones, and what rays through them take."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.errors import SettingsError
from jaart.core.io import load
from jaart.core.records import STATUS_NAMES
from jaart.core.render import render
from jaart.core.samples import bumpy_sphere, fibonacci
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from tests.core.cloud_scenes import CloudOracle, Rays, cloud, fresh, rays, tracer_of, unit

RNG = np.random.default_rng(2)
LINE = np.linspace(-1, 1, 30)[:, None]
DEGENERATE = {
    "one": np.zeros((1, 3)),
    "two": np.array([[0, 0, 0], [1, 0, 0.0]]),
    "three": np.eye(3),
    "on an axis": LINE * [1, 0, 0],
    "on a line": LINE * [1, 2, 3],
    "in a plane": RNG.uniform(-1, 1, (200, 3)) * [1, 1, 0],
    "nine times each": np.repeat(RNG.uniform(-1, 1, (30, 3)), 9, axis=0),
    "in one place": np.ones((20, 3)),
}
METHODS = ({"method": "tangent"}, {"method": "polynomial", "degree": 2}, {"method": "polynomial", "degree": 4},
           {"method": "projection"}, {"method": "off_centre"}, {"method": "mahalanobis"}, {"method": "angle"})
SEARCHES = ("iterate", "secant", "newton", "march", "safe", "minimise", "centres")


def through(points: np.ndarray) -> Rays:
    """Rays at points, past them, and from points on."""
    rng = np.random.default_rng(3)
    targets = np.concatenate((points[rng.integers(0, len(points), 15)], rng.uniform(-1, 1, (10, 3))))
    eyes = 3 * unit(rng.normal(size=targets.shape))
    return (np.concatenate((eyes, targets[:5])),
            unit(np.concatenate((targets - eyes, rng.normal(size=(5, 3))))))


@pytest.mark.parametrize("bare", [False, True], ids=["surfels", "bare"])
@pytest.mark.parametrize("name", DEGENERATE)
def test_clouds_that_are_hardly_any(name: str, bare: bool) -> None:
    """Each ray has a named end and no hit without numbers, or the settings are refused in words."""
    points = DEGENERATE[name]
    scene = Scene(name, points=points, normals=None if bare else np.tile([0, 0, 1.0], (len(points), 1)))
    rendered = 0
    for method, search, near, normal, h in itertools.product(METHODS, SEARCHES, ("ball", "knn"), ("auto", "covariance"),
                                                             ("auto", 0.3)):
        settings = Settings(search=search, neighbourhood=near, normal=normal, h=h, **method)
        try:
            hits = render(scene, settings, rays=through(points), threads=1)
        except SettingsError as error:
            assert str(error).startswith(("search = ", "h: ")) and "expected" in str(error)
            continue
        rendered += 1
        assert (hits.status < len(STATUS_NAMES)).all() and not (hits.status == STATUS_NAMES.index("bad_ray")).any()
        for column in (hits.t, hits.point, hits.normal, hits.off_centre):
            assert np.isfinite(column[hits.hit]).all()
        if search != "centres" and hits.hit.any():  # of a centre's plane only the centre is near its points
            barycentre = hits.off_centre[hits.hit]
            assert barycentre.max() <= prepare.prepared(scene, settings).values.off_centre
    assert rendered >= 40


def test_h_is_asked_for_where_there_is_no_spacing() -> None:
    for name in ("one", "in one place"):
        with pytest.raises(SettingsError, match=r"no two points apart.*expected h as a number"):
            render(Scene(name, points=DEGENERATE[name]), Settings(), rays=rays(3))


def test_an_even_plane_is_hit_exactly_and_nothing_beyond_its_rim() -> None:
    scene, h = cloud("sheets", 800), 0.2
    x = np.linspace(-1.5, 1.5, 31)
    eyes = np.stack((x, 0.3 + 0 * x, 4 + 0 * x), axis=1)
    for search in ("iterate", "secant", "newton", "safe", "march", "minimise"):
        hits = render(scene, Settings(h=h, search=search), rays=(eyes, np.tile([0, 0, -1.0], (31, 1))))
        assert hits.hit[np.abs(x) < 1.05].all() and not hits.hit[np.abs(x) > 1.0 + h].any(), search
        assert np.abs(hits.t[hits.hit] - 3).max() < (1e-12 if search != "minimise" else 0.1 * h), search
        assert np.abs(hits.normal[hits.hit] - [0, 0, 1]).max() < 1e-12


@pytest.mark.parametrize("settings", [Settings(search="safe"), Settings(search="march", step=0.3),
                                      Settings(method="mahalanobis"), Settings(normal="surfel")],
                         ids=["safe", "march", "mahalanobis", "surfel"])
def test_bare_points_get_normals_that_point_outwards(settings: Settings) -> None:
    scene = fresh("bumpy", 1500, bare=True)
    found = prepare.prepared(scene, settings).surfels.normal
    assert ((found * bumpy_sphere(1500).exact.exact_normal(scene.points)).sum(axis=1) > 0.8).all()
    hits = render(scene, settings, rays=rays(200))
    exact = scene_hits(rays(200))
    assert (hits.hit == np.isfinite(exact)).mean() > 0.97 and hits.hit.sum() > 100
    if settings.method == "tangent":  # an energy has no side
        assert ((hits.normal * hits.direction).sum(axis=1)[hits.hit] < 0.2).all()


def scene_hits(along: Rays) -> np.ndarray:
    """Where rays meet the bumpy sphere itself."""
    t: np.ndarray = bumpy_sphere(10).exact.hit(*along)[0]
    return t


@pytest.mark.parametrize(("settings", "name"), [
    (Settings(search="safe", orient="none"), "search"), (Settings(search="march", orient="none"), "search"),
    (Settings(method="mahalanobis", orient="none"), "method"), (Settings(normal="surfel", orient="none"), "normal"),
])
def test_what_needs_normals_is_refused_by_name_where_nobody_orients(settings: Settings, name: str) -> None:
    with pytest.raises(SettingsError, match=f"^{name} = .*orient = none"):
        render(cloud("bumpy", 300, bare=True), settings, rays=rays(3))
    assert render(cloud("bumpy", 300), settings, rays=rays(30)).hit.any()  # with normals of its own


def test_another_orientation_counts_at_once() -> None:
    """What was gathered with other normals is not used."""
    scene = fresh("sphere", 600, bare=True)
    outwards = render(scene, Settings(search="safe"), rays=rays(50))
    inwards = render(scene, Settings(search="safe", orient=(0, 0, 0)), rays=rays(50))
    assert outwards.hit.sum() > 30 and np.array_equal(outwards.hit, inwards.hit)
    assert np.abs(outwards.normal + inwards.normal)[outwards.hit].max() < 1e-12


@pytest.mark.parametrize("near", ["ball", "knn"])
@pytest.mark.parametrize("weight", ["gaussian", "hat", "squared_hat", "wendland"])
@pytest.mark.parametrize("degree", range(5))
def test_every_degree_and_weight_satisfies_the_oracles_equation(degree: int, weight: str, near: str) -> None:
    settings = Settings(method="polynomial", degree=degree, weight=weight, neighbourhood=near, k=24, search="secant",
                        tolerance=1e-9, max_iterations=60, h="3s" if weight.endswith("hat") else "auto")
    scene = cloud("bumpy", 500)
    hits, oracle = render(scene, settings, rays=rays(30)), CloudOracle.of(scene, settings)
    assert hits.hit.sum() > 12
    for x in hits.point[hits.hit][:5].tolist():
        f = oracle.f((0, 0, 0), x)
        assert f is not None and abs(f) < 1e-6 * oracle.values.h


def test_a_point_far_from_all_others_costs_no_more_than_another() -> None:
    """Its ball holds the whole cloud, which the grid of the others has countless cells around."""
    far = np.concatenate((fibonacci(500), [[1e6, 1e6, 1e6]]))
    settings, along = Settings(h=0.15), rays(60)
    alone, beside = (render(Scene("far", points=p), settings, rays=along) for p in (far[:-1], far))
    assert alone.hit.sum() > 30 and np.array_equal(alone.hit, beside.hit)
    assert np.abs(alone.t - beside.t)[alone.hit].max() < 0.01


def test_rays_that_mean_nothing_end_as_such() -> None:
    scene, d = cloud("sphere", 300), np.tile([1.0, 0, 0], (4, 1))
    o = np.array([[np.nan, 0, 0], [-np.inf, 0, 0], [-1e16, 0, 0], [-3.0, 0, 0]])
    d[3] = 0
    with np.errstate(invalid="ignore"):
        hits = render(scene, Settings(), rays=(o, d))
    assert {STATUS_NAMES[s] for s in hits.status} == {"bad_ray"}


def test_how_many_evaluations_and_fits_a_hit_takes() -> None:
    """[A §6]: 5.6 evaluations a hit, and 1.98 with kept centres alone."""
    scene, along = bumpy_sphere(2000), rays(20_000, seed=3)
    settings = Settings(method="polynomial", degree=3, ball_k=24, tolerance=1e-3)
    hits, tracer = render(scene, settings, rays=along), tracer_of(scene, settings)
    assert hits.hit.sum() > 15_000
    assert tracer.fits == tracer.gathered < 2000
    assert (hits.evaluations.sum() + tracer.fits) / hits.hit.sum() < 2
    exact = scene_hits(along)
    assert (hits.hit == np.isfinite(exact)).mean() > 0.995 and np.nanmedian(np.abs(hits.t - exact)) < 3e-4


@pytest.mark.parametrize("file", ["clouds/kinect_table_241407.npz", "clouds/dragon_full.npz"])
def test_measured_clouds_render_without_a_hit_far_from_their_points(file: str, data) -> None:
    from scipy.spatial import cKDTree

    scene, settings = load(data(file)), Settings(method="polynomial")
    hits = render(scene, settings, size=(96, 96))
    h = prepare.prepared(scene, settings).values.h
    assert hits.hit.sum() > 500 and tracer_of(scene, settings).gathered < len(scene.points) / 10
    distance = cKDTree(scene.points).query(hits.point[hits.hit])[0] / h
    assert distance.max() < 3 and (distance < 2).mean() > 0.98  # in a hole's rim the barycentre alone is near
    assert hits.off_centre[hits.hit].max() <= h and not np.isnan(hits.normal[hits.hit]).any()
