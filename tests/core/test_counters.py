"""What the counters of hits say, against what a scene needs: nothing that it does not need was done."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from jaart.core import picture, prepare, secondary
from jaart.core.balls import CloudTracer
from jaart.core.camera import Camera
from jaart.core.export import hits_arrays
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from jaart.core.statistics import statistics
from jaart.core.trace import trace
from tests.core.cloud_scenes import fresh

SIZE = (24, 24)
COUNTED = ("starts", "eigenvectors", "gradients")


def ball() -> Scene:
    return Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), 12))


def cloud() -> Scene:
    return fresh("sphere", 300)


def hits_of(scene: Scene, **given: Any) -> Hits:
    found = render(scene, Settings(**given), size=SIZE)
    assert found.hit.any()
    return found


@pytest.mark.parametrize("made", [ball, cloud])
@pytest.mark.parametrize("method", ["tangent", "polynomial"])
def test_one_eigenvector_for_each_evaluation_with_a_covariance_and_none_without(made: Callable[[], Scene],
                                                                                method: str) -> None:
    assert not hits_of(made(), method=method, normal="surfel").eigenvectors.any()
    for normal in ("covariance", "covariance_at_x"):
        found = hits_of(made(), method=method, normal=normal)
        np.testing.assert_array_equal(found.eigenvectors, found.evaluations)


@pytest.mark.parametrize("made", [ball, cloud])
@pytest.mark.parametrize("method", ["off_centre", "mahalanobis"])
def test_an_energy_that_needs_no_normal_takes_an_eigenvector_where_it_is_least_alone(made: Callable[[], Scene],
                                                                                     method: str) -> None:
    found = hits_of(made(), method=method, normal="covariance")
    assert (found.eigenvectors[found.hit] >= 1).all()
    assert found.eigenvectors.sum() < 0.2 * found.evaluations.sum()
    emphasised = hits_of(made(), method=method, normal="covariance", emphasise=True, level=1.0)
    np.testing.assert_array_equal(emphasised.eigenvectors, emphasised.evaluations)


@pytest.mark.parametrize("normal", ["surfel", "covariance"])
def test_gradients_where_a_search_or_the_shown_normal_takes_them(normal: str) -> None:
    newton = hits_of(ball(), search="newton", normal=normal)
    np.testing.assert_array_equal(newton.gradients, newton.evaluations)
    assert not hits_of(ball(), search="secant", normal=normal).gradients.any()
    assert not hits_of(ball(), method="polynomial", search="newton").gradients.any()  # differences take their place
    shown = hits_of(ball(), search="iterate", normal=normal, shading_normal="gradient")
    np.testing.assert_array_equal(shown.gradients, shown.hit)


@pytest.mark.parametrize("made", [ball, cloud])
@pytest.mark.parametrize("search", ["iterate", "newton", "march", "safe", "minimise", "centres"])
def test_starts_are_those_that_a_followed_ray_has(made: Callable[[], Scene], search: str) -> None:
    scene, settings = made(), Settings(search=search)
    found = render(scene, settings, size=(9, 9))
    for ray in range(0, 81, 4):
        followed = trace(scene, settings, found.origin[ray], found.direction[ray])
        assert len(np.unique(followed.start)) == found.starts[ray]


@pytest.mark.parametrize("method", ["fill_level", "isosurface", "cylinder"])
def test_what_is_hit_at_once_begins_no_search(method: str) -> None:
    found = hits_of(ball(), method=method)
    assert not any(getattr(found, name).any() for name in COUNTED)


def test_a_lattice_makes_no_tree_and_a_mesh_of_the_levels_no_surfels() -> None:
    scene = ball()
    hits_of(scene)
    assert {"surfels", "cells"} <= set(scene._kept) and not {"balls", "kd_tree"} & set(scene._kept)
    scene = ball()
    found = hits_of(scene, method="fill_level")
    assert not {"surfels", "cells"} & set(scene._kept)
    ray = int(np.argmax(found.hit))
    followed = trace(scene, Settings(method="fill_level"), found.origin[ray], found.direction[ray])
    assert {"surfels", "cells"} <= set(scene._kept) and np.isfinite(followed.curves.off_centre).any()


def test_places_gathered_are_those_of_this_picture() -> None:
    scene, settings = cloud(), Settings()
    eye = Camera.fit(prepare.extents.bounds(scene, settings), size=SIZE)
    first, second = render(scene, settings, eye, SIZE), render(scene, settings, eye, SIZE)
    tracer = prepare.prepared(scene, settings).tracer
    assert isinstance(tracer, CloudTracer)
    assert (first.gathered, first.fits) == (tracer.gathered, tracer.fits) and first.gathered == first.fits > 0
    assert 0 < first.gathered < len(tracer.cloud.radii)
    assert (second.gathered, second.fits) == (0, 0)
    assert hits_of(scene, search="safe").fits == 0 < render(scene, Settings(search="march"), eye, SIZE).gathered
    assert hits_of(ball()).gathered > 0 == hits_of(ball()).fits


@pytest.mark.parametrize("shadows", [False, True])
def test_no_second_rays_without_shadows(shadows: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    traced: list[int] = []

    def counted(*args: Any, **more: Any) -> Hits:
        traced.append(len(more["rays"][0]))
        return render(*args, **more)

    monkeypatch.setattr(secondary, "render", counted)
    picture.picture(ball(), Settings(light=((30.0, 5.0, 30.0),), shadows=shadows), size=SIZE)
    assert (sum(traced) > 0) == shadows


def test_files_and_statistics_hold_them() -> None:
    found = hits_of(ball(), search="newton", normal="covariance")
    arrays, counted = hits_arrays(found), statistics(found)
    for name in COUNTED:
        np.testing.assert_array_equal(arrays[name], getattr(found, name))
        assert getattr(counted, name) == getattr(found, name).sum() > 0
    assert (arrays["gathered"], arrays["fits"]) == (counted.gathered, 0) and counted.gathered > 0


@pytest.mark.parametrize(("search", "more"),
                         [("iterate", 0), ("secant", 0), ("minimise", 1), ("march", 2), ("safe", 2)])
def test_iterations_are_the_steps_of_the_start_that_hit_and_evaluations_those_of_all(search: str, more: int) -> None:
    settings, scene = Settings(search=search, method="off_centre" if search == "minimise" else "tangent"), cloud()
    found, later = render(scene, settings, size=(12, 12)), 0
    for i in np.flatnonzero(found.hit):
        ray = trace(scene, settings, found.origin[i], found.direction[i])
        arrived = [s for s in np.unique(ray.start)
                   if ray.outcome[np.flatnonzero(ray.start == s)[-1]].startswith(("converged", "floor", "bounded"))]
        steps = [int(np.count_nonzero(ray.start == s)) for s in arrived]
        assert found.iterations[i] in steps
        assert ray.steps <= found.evaluations[i] <= ray.steps + more * len(arrived)
        assert (found.evaluations[i] > ray.steps) == (more > 0)
        later += found.iterations[i] != np.count_nonzero(ray.start == ray.start[-1])
    assert later or not more
