"""Figures of a ray through a cloud, and of searches that look at places: drawn from real traces."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.camera import Camera
from jaart.core.io import load
from jaart.core.samples import bumpy_sphere
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.trace import trace
from jaart.plot import scale, searched
from jaart.plot.energy import energy_figure
from jaart.plot.projection import projection_figure
from jaart.plot.scene3d import step_meshes
from jaart.plot.trace import trace_figure

SHIFT = np.array([30.0, -20.0, 10.0])


@pytest.fixture(scope="module")
def cloud():
    return Scene("small", points=0.01 * bumpy_sphere(4000).points + SHIFT)


def through_middle(scene, settings):
    """The ray through the middle of a scene's picture."""
    camera = Camera.fit(scene)
    origin, direction = camera.rays((1, 1))
    return trace(scene, settings, origin[0], direction[0])


@pytest.fixture(scope="module")
def ray(cloud):
    return through_middle(cloud, Settings())


def test_things_are_drawn_as_large_as_the_balls(ray):
    assert scale.is_cloud(ray)
    assert scale.size(ray) == np.median(ray.balls[:, 3])
    assert scale.unit(ray) == "units"
    meshes = step_meshes(ray, 0)
    around = np.linalg.norm(meshes["solids"].points - ray.query[0], axis=1)
    assert around.max() < 10 * scale.size(ray)
    assert len(meshes["full_cells"])


def test_stretches_lie_between_the_ends_of_each_ball(ray):
    ways = scale.stretches(ray)
    assert ways.shape == (len(ray.balls), 2)
    for (enter, leave), (*centre, radius) in zip(ways, ray.balls, strict=True):
        for t in (enter, leave):
            assert np.linalg.norm(ray.origin + t * ray.direction - centre) == pytest.approx(radius, rel=1e-6)


def test_the_circles_in_the_plane_go_through_where_the_ray_pierces_the_balls(ray):
    axes = projection_figure(ray).axes[0]
    ways = scale.stretches(ray)
    found = []
    for collection in axes.collections:
        if type(collection).__name__ == "EllipseCollection":
            for (t, away), wide in zip(collection.get_offsets(), collection.get_widths(), strict=True):
                half = np.sqrt((wide / 2) ** 2 - away**2)
                found.append((t - half, t + half))
    assert np.array(sorted(found)) == pytest.approx(np.array(sorted(map(tuple, ways))), rel=1e-6)


def test_one_ball_stands_out_and_it_is_the_one_that_the_search_is_in(ray):
    for step in range(ray.steps):
        centre, radius = np.split(ray.balls[ray.step_cell[step, 0]], [3])
        around = ray.query[step] - ray.balls[:, :3]
        assert np.count_nonzero(np.linalg.norm(around, axis=1) <= ray.balls[:, 3]) > 1  # others hold the query too
        circles = [c for c in projection_figure(ray, step).axes[0].collections
                   if type(c).__name__ == "EllipseCollection" and c.get_linewidth()[0] > 1]
        (bold,) = circles
        (((t, _), wide),) = zip(bold.get_offsets(), bold.get_widths(), strict=True)
        assert t == pytest.approx((centre - ray.origin) @ ray.direction, rel=1e-6)
        assert 0 < wide <= 2 * radius[0]
        meshes = step_meshes(ray, step)
        away = np.linalg.norm(meshes["full_cells"].points - centre, axis=1)
        assert away == pytest.approx(np.full(len(away), radius[0]), rel=1e-6)
        assert len(meshes["cells"])


def test_the_energy_plot_of_a_cloud_shows_its_stretches_and_four_curves(ray):
    axes = energy_figure(ray).axes[0]
    labels = [line.get_label() for line in axes.lines]
    assert "$e_{ts}$" in labels
    size = scale.size(ray)
    angle = next(line for line in axes.lines if r"\angle" in line.get_label())
    assert np.nanmax(angle.get_ydata()) == pytest.approx(size * np.nanmax(ray.curves.angle))
    bars = [c for c in axes.collections if type(c).__name__ == "PolyCollection"]
    starts = {round(path.vertices[:, 0].min(), 9) for bar in bars for path in bar.get_paths()}
    assert {round(t, 9) for t in scale.stretches(ray)[:, 0]} <= starts


def test_curves_are_not_drawn_where_nothing_is_known(cloud):
    found = through_middle(cloud, Settings(search="march", max_off_centre=1e-9))
    t = np.sort(found.curves.t)
    assert np.diff(t).max() > 10 * np.median(np.diff(t))  # the ray leaves the front balls and enters the back ones
    line = next(line for line in energy_figure(found).axes[0].lines if line.get_label() == "$e_{oc}$")
    x, y = line.get_data()
    gap = int(np.argmax(np.diff(t))) + 1
    assert np.isnan(y[gap])
    assert np.isnan(x[gap])


def test_lengths_have_digits_that_count(ray):
    assert scale.text(ray, 1.23456789, 4) == "1.2345679"
    assert scale.step_text(ray, 1.23456e-7, 4, "+") == "+1.23e-07"


@pytest.mark.parametrize(("method", "name"), [("tangent", "tangent"), ("off_centre", "off_centre"), ("angle", "angle"),
                                              ("mahalanobis", "mahalanobis")])
def test_looks_have_the_energy_that_is_searched(cloud, method, name):
    found = through_middle(cloud, Settings(method=method, search="minimise"))
    assert searched.energy_name(found) == name
    assert searched.looks(found)
    values = searched.at_steps(found)
    curves = {"tangent": found.curves.tangent, "off_centre": found.curves.off_centre, "angle": found.curves.angle,
              "mahalanobis": found.curves.mahalanobis}[name]
    near = [np.abs(found.curves.t - t).argmin() for t in found.t_query]
    apart = np.abs(values - curves[near])  # a curve may be steep between two of its samples, but not at most looks
    assert np.nanmedian(apart) <= 0.05 * np.ptp(curves[np.isfinite(curves)])


def test_a_level_is_drawn_where_a_minimum_is_searched():
    found = through_middle(load("standard"), Settings(method="off_centre", level=0.3))
    lines = [line for line in energy_figure(found).axes[0].lines if line.get_label() == "level"]
    assert lines[0].get_ydata()[0] == 0.3
    lines = [line for line in energy_figure(found, level=0.2).axes[0].lines if line.get_label() == "level"]
    assert lines[0].get_ydata()[0] == 0.2
    stepping = through_middle(load("standard"), Settings(method="tangent", search="iterate", level=0.3))
    assert not [line for line in energy_figure(stepping).axes[0].lines if line.get_label() == "level"]


def test_the_page_of_a_ray_through_a_cloud_is_drawn(ray, tmp_path):
    figure = trace_figure(ray, theme="dark")
    figure.savefig(tmp_path / "ray.svg")
    assert (tmp_path / "ray.svg").stat().st_size > 5000


@pytest.mark.parametrize(("x", "words"), [
    (0.5, "pierces 2 balls,\nbut the normal is undefined there"),
    (-1.0, "pierces 1 ball,\nbut the normal is undefined there"),
    (-2.0, "pierces no ball")])
def test_a_ray_without_steps_says_what_it_went_through(x, words):
    scene = Scene("two", points=np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    found = trace(scene, Settings(ball_k=1), (x, 0.0, 9.0), (0.0, 0.0, -1.0))
    assert found.steps == 0
    assert scale.no_steps(found) == f"This ray {words}:\nno step was taken."


def test_why_no_step_was_taken_stands_in_the_middle_of_the_energies_and_below_the_title():
    scene = Scene("two", points=np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    figure = energy_figure(trace(scene, Settings(), (0.4, 0.0, 9.0), (0.0, 0.0, -1.0)), size=(4.0, 2.0))
    figure.draw_without_rendering()
    axes = figure.axes[0]
    boxes = {text.get_text(): text.get_window_extent() for text in axes.texts}
    assert "Normal undefined: no step was taken" in boxes
    why = next(box for text, box in boxes.items() if "pierces 2 balls" in text)
    for low, at, high in ((axes.bbox.x0, why.x0, why.x1), (axes.bbox.y0, why.y0, why.y1)):
        assert low < at < high
    assert why.x1 < axes.bbox.x1
    assert why.y1 < axes.bbox.y1
    for box in boxes.values():
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1


def test_a_ray_that_misses_keeps_its_curves_free(cloud):
    rays = (trace(cloud, Settings(), SHIFT + (0.0, y, 1.0), (0.0, 0.0, -1.0)) for y in np.arange(0.009, 0.0125, 1e-5))
    found = next(ray for ray in rays if not ray.hit and not ray.steps and np.isfinite(ray.curves.tangent).any())
    assert scale.no_steps(found).startswith("This ray misses the surface")
    assert [text.get_text() for text in energy_figure(found).axes[0].texts] == ["Background: no step was taken"]
