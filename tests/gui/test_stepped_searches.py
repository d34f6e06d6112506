"""The panels of a ray with every search and surface: looks, levels, rays without a step."""

from __future__ import annotations

import numpy as np
import pytest
from patience import PATIENCE, settle, write_cloud
from qtpy.QtCore import QPoint, Qt
from qtpy.QtTest import QTest

from jaart.plot.lettering import Key

LEFT = Qt.MouseButton.LeftButton


def show(qtbot, window, **values):
    """Set values and pick the middle one of the hits by a click."""
    model = window.model
    model.set_settings(model.settings.replace(**values))
    settle(qtbot, model)
    assert model.fault is None
    hits = np.argwhere(model.hits.hit.reshape(model.size[::-1]))
    y, x = (int(n) for n in hits[len(hits) // 2])
    QTest.mouseClick(window.view, LEFT, pos=window.view.place_of((x, y)).toPoint())
    settle(qtbot, model)
    qtbot.waitUntil(lambda: not any(d.panel.pending for d in window.docks.values() if hasattr(d.panel, "pending")),
                    timeout=PATIENCE)
    assert model.trace.hit
    return model.trace


def titles(window, dock):
    axes = window.docks[dock].panel.canvas.figure.axes[0]
    return " ".join(text.get_text() for text in axes.texts)


def key(axes):
    """The names of the curves above them."""
    return next(artist.texts for artist in axes.artists if isinstance(artist, Key))


@pytest.fixture(params=["lattice", "cloud"])
def scene(request, qtbot, window, tmp_path):
    if request.param == "cloud":
        window.model.open(write_cloud(tmp_path / "points.npz"))
        settle(qtbot, window.model)
    return request.param


@pytest.mark.parametrize("search", ["march", "safe", "minimise"])
def test_the_looks_of_a_search_are_walked_through(qtbot, window, scene, search):
    trace = show(qtbot, window, method="tangent", search=search)
    assert trace.steps > 2
    steps = window.docks["Steps"].panel
    QTest.mouseClick(steps.first, LEFT)
    for number in range(1, 4):
        assert steps.position.text() == f"step {number} / {trace.steps}"
        qtbot.waitUntil(lambda n=number: titles(window, "Energy along the ray").startswith(f"Step {n}:"),
                        timeout=PATIENCE)
        QTest.mouseClick(steps.forward, LEFT)


@pytest.mark.parametrize("method", ["tangent", "off_centre", "mahalanobis", "angle"])
def test_a_search_that_minimises_shows_its_level(qtbot, window, scene, method):
    trace = show(qtbot, window, method=method, search="minimise")
    axes = window.docks["Energy along the ray"].panel.canvas.figure.axes[0]
    legend = key(axes)
    assert len(legend) == 5
    assert legend[-1] == "level"
    line = next(line for line in axes.lines if line.get_label() == "level")
    level = window.model.known.values.level
    size = 1.0 if scene == "lattice" else float(np.median(trace.balls[:, 3]))
    drawn = level * {"mahalanobis": 1 / size, "angle": size}.get(method, 1.0)
    assert line.get_ydata()[0] == pytest.approx(drawn)


def test_a_stepping_search_has_no_level(qtbot, window):
    show(qtbot, window, method="tangent", search="iterate")
    axes = window.docks["Energy along the ray"].panel.canvas.figure.axes[0]
    assert key(axes) == ["$e_{ts}$", "$e_{oc}$", "$e_M$ [cells²]", r"$e_{\angle}$"]


@pytest.mark.parametrize("values", [{"method": "isosurface"}, {"method": "fill_level"}], ids=lambda v: v["method"])
def test_a_ray_without_a_step_is_explained(qtbot, window, values):
    trace = show(qtbot, window, **values)
    assert trace.steps == 0
    assert "hit at once" in window.docks["3D ray analyzer"].panel._message.text()
    assert "hit at once" in titles(window, "2D projector")
    assert titles(window, "Energy along the ray").startswith("Arrived: ")
    assert window.docks["Steps"].panel.position.text() == "step 0 / 0"


def test_the_cylinder_takes_one_step(qtbot, window, scene):
    trace = show(qtbot, window, method="cylinder")
    assert trace.steps >= 1
    assert "Step" in titles(window, "2D projector")


def test_the_energies_of_a_cloud_are_zoomed_to_the_whole_ray(qtbot, window, tmp_path):
    window.model.open(write_cloud(tmp_path / "points.npz"))
    settle(qtbot, window.model)
    trace = show(qtbot, window)
    panel = window.docks["Energy along the ray"].panel
    near = np.ptp(panel.canvas.figure.axes[0].get_xlim())
    assert panel.whole.isVisible()
    QTest.mouseClick(panel.whole, LEFT, pos=QPoint(8, 8))
    far = trace.curves.t.max() - trace.curves.t.min()
    qtbot.waitUntil(lambda: np.ptp(panel.canvas.figure.axes[0].get_xlim()) >= 0.9 * far, timeout=PATIENCE)
    assert near <= np.ptp(panel.canvas.figure.axes[0].get_xlim())
