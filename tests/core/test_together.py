"""Rays that search side by side end as each does alone: the same bits, and the same work."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import jaart
from jaart.core import meaning, places, prepare, warm
from jaart.core.assemble import goes_together, plan_of
from jaart.core.camera import Camera
from jaart.core.cell_table import cell_table
from jaart.core.chosen import chosen
from jaart.core.kernels import ray, together
from jaart.core.kernels import records as r
from jaart.core.kernels.packet import ABREAST, LANES
from jaart.core.kernels.pinhole import EDGE
from jaart.core.plan import plan
from jaart.core.records import STATUS_NAMES
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings, preset
from jaart.core.surfels import Surfels
from jaart.core.tiles import columns_for
from jaart.core.trace import trace
from jaart.core.tracers import NO_BEGINS, LatticeTracer
from tests.core.test_packet import BALLS, CAMERAS

PLAIN = Settings(search="iterate", normal="surfel", neighbourhood="cell_ball")
#: Each ends some rays in a way of its own.
ENDS: dict[str, tuple[dict[str, Any], set[int]]] = {
    "plain": ({}, {r.CONVERGED}),
    "no bound": ({"max_off_centre": "none"}, {r.CONVERGED}),
    "a strict bound": ({"max_off_centre": 0.02}, {r.CONVERGED, r.BOUNDED}),
    "few steps": ({"max_iterations": 2, "tolerance": 1e-9}, {r.CAP}),
    "to the floor": ({"tolerance": 1e-300, "max_iterations": 60}, {r.FLOOR}),
    "a short way": ({"radius": 0.6}, {r.LEFT_TRUST}),
    "few surfels": ({"radius": 0.3}, {r.FEW_NEIGHBOURS}),
    "narrow weights": ({"h": 0.05, "radius": 2.0}, {r.LEFT_TRUST}),
    "the nearest": ({"neighbourhood": "cell_knn", "k": 9}, {r.CONVERGED}),
}


def ended(settings: Settings, scene: Scene, origins: np.ndarray, directions: np.ndarray) -> tuple[r.Out, r.Out]:
    """The columns of rays that search side by side, and of the same rays by the driver of rays alone."""
    tracer = prepare.prepared(scene, settings).tracer
    assert isinstance(tracer, LatticeTracer) and tracer.together
    return ended_in(tracer, origins, directions)


def ended_in(tracer: LatticeTracer, origins: np.ndarray, directions: np.ndarray,
             begins: np.ndarray = NO_BEGINS) -> tuple[r.Out, r.Out]:
    """The same for rays through a lattice that is at hand; begins: t before which each meets nothing."""
    made, alone, rays = columns_for(len(origins)), columns_for(len(origins)), np.arange(len(origins))
    tracer.trace(origins, directions, rays, made, begins=begins)
    replace(tracer, together=False).trace(origins, directions, rays, alone, begins=begins)
    return made, alone


def assert_equal(made: r.Out, alone: r.Out) -> None:
    """Every column has the same bits, those that count work among them."""
    for name, column, other in zip(r.Out._fields, made, alone, strict=True):
        np.testing.assert_array_equal(column, other, err_msg=name)


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("name", ENDS)
def test_each_ray_ends_as_it_does_alone(name: str, camera: str) -> None:
    values, states = ENDS[name]
    origins, directions = CAMERAS[camera].rays((45, 37))
    made, alone = ended(PLAIN.replace(**values), BALLS, origins, directions)
    assert_equal(made, alone)
    seen = {STATUS_NAMES[s] for s in np.unique(made.status)}
    assert camera != "from outside" or {STATUS_NAMES[s] for s in states} <= seen, seen


@pytest.mark.parametrize("name", ["plain", "narrow weights"])
def test_each_ray_ends_as_it_does_alone_from_where_its_block_begins(name: str) -> None:
    camera, size = CAMERAS["from outside"], (48, 40)
    tracer = prepare.prepared(BALLS, PLAIN.replace(**ENDS[name][0])).tracer
    begins = tracer.blocks(camera.view(size)).repeat(EDGE, axis=0).repeat(EDGE, axis=1).ravel()
    assert isinstance(tracer, LatticeTracer) and (begins > 0.0).any()
    assert_equal(*ended_in(tracer, *camera.rays(size), begins))


@pytest.mark.parametrize("camera", CAMERAS)
def test_where_room_is_short_they_are_traced_anew(camera: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also those of a packet that go alone, from inside and along faces."""
    rays = CAMERAS[camera].rays((23, 19))
    roomy, _ = ended(PLAIN, Scene("roomy", model=BALLS.model), *rays)
    monkeypatch.setattr(places, "CHUNK", 8)
    monkeypatch.setattr(places, "SURFELS", 1)
    tight = Scene("tight", model=BALLS.model)
    assert_equal(ended(PLAIN, tight, *rays)[0], roomy)
    assert places.places_of(prepare.prepared(tight, PLAIN).tracer.sites).kept.chunks > 50


@pytest.mark.parametrize("count", [1, 2, int(ABREAST) - 1, int(ABREAST), int(ABREAST) + 1, int(LANES), int(LANES) + 3])
def test_any_number_of_rays_may_go_together(count: int) -> None:
    origins, directions = CAMERAS["from outside"].rays((40, 40))
    some = slice(664, 664 + count)
    made, alone = ended(PLAIN, BALLS, origins[some], directions[some])
    assert_equal(made, alone)
    assert made.starts.any()


@pytest.mark.parametrize("shape", [(1, 1, 1), (1, 9, 4), (7, 1, 3), (5, 6, 2), (17, 3, 9)])
def test_odd_lattices(shape: tuple[int, int, int]) -> None:
    levels = np.random.default_rng(sum(shape)).uniform(size=shape)
    levels[levels > 0.7], levels[levels < 0.3] = 1.0, 0.0
    camera = Camera.fit((np.zeros(3), np.array(shape, float)), size=(60, 60))
    assert_equal(*ended(PLAIN, Scene("odd", levels=levels), *camera.rays((60, 60))))


def test_normals_that_cancel_are_said_and_have_no_step() -> None:
    scene = Scene("two sides of nothing", levels=np.zeros((6, 6, 6)))
    values = chosen(scene, PLAIN)
    found = Surfels(np.array([[2, 2, 2], [2, 2, 3]], np.int32), np.array([[0.1, 0.0, 0.5], [0.1, 0.0, -0.5]]),
                    np.array([[0.0, 0.6, 0.8], [0.0, -0.6, -0.8]]))  # at one place
    cells, rays = cell_table(found, (6, 6, 6), values, 1), plan_of(scene, PLAIN, values)
    made, alone = ended_in(LatticeTracer(lambda: cells, rays, together=True),
                           *Camera(eye=(9.0, 8.0, 20.0), target=(2.6, 2.5, 3.0), fov=9.0).rays((20, 20)))
    assert_equal(made, alone)
    undefined = made.status == r.UNDEFINED_NORMAL
    assert undefined.sum() > 20 and np.isnan(made.energy[undefined]).all()


def test_rays_along_the_plane_are_said_to_be_parallel() -> None:
    scene = Scene("a surfel", levels=np.zeros((6, 6, 6)))
    values = chosen(scene, PLAIN)
    found = Surfels(np.array([[2, 2, 2]], np.int32), np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
    cells, rays = cell_table(found, (6, 6, 6), values, 1), plan_of(scene, PLAIN, values)
    angle, height = np.linspace(-0.1, 0.1, 40), np.linspace(2.1, 2.9, 40)
    origins = np.column_stack((np.full(40, -3.0), np.full(40, 2.5), height))
    directions = np.column_stack((np.cos(angle), np.sin(angle), np.zeros(40)))
    made, alone = ended_in(LatticeTracer(lambda: cells, rays, together=True), origins, directions)
    assert_equal(made, alone)
    assert (made.status == r.PARALLEL).sum() > 20


def test_rays_without_meaning_disturb_no_other() -> None:
    origins, directions = (a.copy() for a in CAMERAS["from outside"].rays((40, 40)))
    origins[801, 1], directions[805], directions[810, 0], origins[815] = np.nan, 0.0, np.inf, 1e300
    made, alone = ended(PLAIN, BALLS, origins, directions)
    assert_equal(made, alone)
    assert (made.status == r.BAD_RAY).sum() == 4


def test_a_followed_ray_has_the_bits_of_the_picture() -> None:
    scene, settings = jaart.load("splash"), preset("thesis")
    camera = Camera.fit((np.zeros(3), np.array(scene.levels.shape, float)), size=(64, 48))
    picture = render(scene, settings, camera, (64, 48))
    for row in np.flatnonzero(picture.hit)[::97]:
        followed = trace(scene, settings, picture.origin[row], picture.direction[row])
        assert followed.t == picture.t[row]
        assert followed.normal.tolist() == picture.normal[row].tolist()
        assert len(followed.t_query) == picture.evaluations[row]


#: What must hold for rays to go together, one by one not so.
NOT_PLAIN: tuple[dict[str, Any], ...] = (
    {"method": "polynomial"}, {"search": "secant"}, {"search": "safe"}, {"normal": "covariance"}, {"weight": "hat"},
    {"neighbourhood": "ball"}, {"neighbourhood": "knn"}, {"traversal": "uniform"}, {"bail": "growth"},
    {"min_weight": 0.1}, {"max_nearest": 1.0}, {"max_angle": 0.5}, {"min_gap": 0.1}, {"shading_normal": "gradient"},
    {"method": "fill_level"}, {"method": "cylinder"},
)


@pytest.mark.parametrize("values", NOT_PLAIN, ids=str)
def test_what_is_not_plain_goes_alone_and_the_plan_says_so(values: dict[str, Any]) -> None:
    settings = PLAIN.replace(**values)
    assert not goes_together(BALLS, settings, meaning.check(BALLS, settings))
    stage = plan(BALLS, settings)["rays side by side"]
    assert not stage.runs and set(values) <= set(stage.settings)
    tracer = prepare.prepared(BALLS, settings).tracer
    assert not isinstance(tracer, LatticeTracer) or not tracer.together


def test_the_plain_iteration_goes_together_and_the_plan_says_so() -> None:
    for settings in (PLAIN, PLAIN.replace(neighbourhood="cell_knn"), preset("thesis")):
        assert plan(BALLS, settings)["rays side by side"].runs
    assert not plan(Scene("four", points=np.eye(4)[:, :3]), Settings())["rays side by side"].runs


def test_a_log_is_written_by_a_ray_alone() -> None:
    tracer = prepare.prepared(BALLS, PLAIN).tracer
    origins, directions = CAMERAS["from outside"].rays((40, 40))
    log, out = np.full((50, r.LOG_WIDTH), np.nan), columns_for(1600)
    written = tracer.trace(origins, directions, np.array([664]), out, log)
    assert written == out.evaluations[664] > 0 and np.isfinite(log[:written, r.T]).all()


def test_only_the_driver_that_is_needed_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    monkeypatch.setattr(warm, "compiled", lambda kernel: asked.append(kernel) or True)
    drivers = {together.trace_together, ray.trace_rays}
    for settings, tracing, driver in ((PLAIN, False, together.trace_together), (PLAIN, True, ray.trace_rays),
                                      (PLAIN.replace(search="secant"), False, ray.trace_rays)):
        asked.clear()
        assert not warm.needs_compile(BALLS, settings, tracing)
        assert drivers & set(asked) == {driver}
