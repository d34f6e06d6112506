"""The scene model: what is computed again, what is kept, and what is said when it cannot be."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from patience import PATIENCE, settle

from jaart.core.camera import Camera
from jaart.core.errors import SettingsError
from jaart.gui.navigation import STEEPEST, orbit, pan, view, width, zoom
from jaart.gui.worker import Worker


def counted(signal):
    calls = []
    signal.connect(lambda *given: calls.append(given))
    return calls


def test_a_scene_gives_coarse_pictures_then_the_full_one_and_its_quality(qtbot, model, monkeypatch):
    monkeypatch.setattr("jaart.core.render.PATIENCE", 0.0)
    model.set_size(64, 64)
    sizes, measured = [], []
    model.hits_changed.connect(lambda: sizes.append(model.hits.size if model.hits else None))
    model.hits_changed.connect(lambda: measured.append(model.quality is not None))
    model.open("standard")
    settle(qtbot, model)
    assert sizes == [None, (8, 8), (16, 16), (32, 32), (64, 64), (64, 64)]
    assert measured == [False, False, False, False, False, True]
    assert model.complete
    assert 0 < model.quality.delta < 1
    assert len(model.quality.distance) == 64 * 64


def test_a_ray_is_traced_once_for_a_picture_that_comes_again_with_its_errors(qtbot, standard):
    standard.pick(48, 48)
    settle(qtbot, standard)
    pictures, traces = counted(standard.hits_changed), counted(standard.trace_changed)
    standard.set_value("h", 1.6)
    settle(qtbot, standard)
    assert standard.quality is not None
    assert len(pictures) >= 3
    assert len(traces) == 1


def test_a_file_that_cannot_be_read_leaves_the_old_scene(qtbot, standard, tmp_path):
    broken = tmp_path / "broken.npz"
    broken.write_bytes(b"PK\x03\x04 cut off")
    scene, hits, picked = standard.scene, standard.hits, standard.picked
    failures = counted(standard.failed)
    standard.open(broken)
    settle(qtbot, standard)
    assert len(failures) == 1
    assert "broken.npz" in failures[0][0]
    assert (standard.scene, standard.hits, standard.picked) == (scene, hits, picked)


def test_a_lattice_without_a_surface_is_background_and_a_note(qtbot, standard, tmp_path):
    empty = tmp_path / "empty.npz"
    np.savez(empty, levels=np.zeros((5, 5, 5)))
    failures, told = counted(standard.failed), counted(standard.said)
    standard.open(empty)
    settle(qtbot, standard)
    assert not failures and standard.scene.source == str(empty)
    assert not standard.hits.hit.any() and standard.trace is None
    assert any("0 surfels" in text for text, in told)
    standard.pick(48, 48)
    settle(qtbot, standard)
    assert standard.trace.status == "background" and standard.trace.steps == 0


def test_shading_is_changed_without_tracing_again(qtbot, standard):
    t, pictures = standard.hits.t, counted(standard.hits_changed)
    standard.set_value("ambient", 0.5)
    assert standard.idle
    assert standard.hits.t is t
    assert standard.hits.settings.ambient == 0.5
    assert not pictures


def test_mahalanobis_c_enters_the_energies_of_the_picked_ray(qtbot, standard):
    standard.pick(48, 48)
    settle(qtbot, standard)
    before = standard.trace
    standard.set_value("mahalanobis_c", 0.75)
    settle(qtbot, standard)
    assert not np.array_equal(standard.trace.curves.mahalanobis, before.curves.mahalanobis, equal_nan=True)


def test_another_h_makes_a_new_picture_and_traces_the_picked_ray_again(qtbot, standard):
    standard.pick(48, 48)
    settle(qtbot, standard)
    before = standard.trace
    standard.set_value("h", 1.2)
    settle(qtbot, standard)
    assert standard.hits.settings.h.value == 1.2
    assert standard.trace is not before
    assert standard.trace.settings.h.value == 1.2


def test_the_picked_ray_is_the_one_of_the_picture(qtbot, standard):
    standard.pick(50, 40)
    settle(qtbot, standard)
    at = 50 + 40 * 96
    assert standard.trace.pixel == (50, 40)
    assert standard.trace.t == standard.hits.t[at]
    assert standard.trace.steps == standard.hits.evaluations[at]


def test_a_pick_beside_the_picture_takes_its_edge(qtbot, standard):
    standard.pick(-5, 1000)
    assert standard.picked == (0, 95)


def test_steps_stay_within_the_ray(qtbot, standard):
    standard.pick(48, 48)
    settle(qtbot, standard)
    standard.set_step(10_000)
    assert standard.step == standard.trace.steps - 1
    standard.set_step(-1)
    assert standard.step == 0
    standard.clear_pick()
    assert (standard.picked, standard.trace, standard.step) == (None, None, 0)


def test_another_raster_is_seen_from_the_same_side(qtbot, standard):
    eye, share = np.array(standard.camera.eye), standard.hits.hit.mean()
    standard.set_value("raster", 32)
    settle(qtbot, standard)
    np.testing.assert_allclose(standard.camera.eye, 2 * eye)
    assert standard.hits.hit.mean() == pytest.approx(share, abs=0.03)


def test_many_changes_at_once_end_in_a_picture_of_the_last(qtbot, standard):
    full = []
    standard.hits_changed.connect(lambda: full.append(standard.hits.settings.h.value) if standard.complete else None)
    for step in range(30):
        standard.set_value("h", round(0.5 + 0.01 * step, 2))
    settle(qtbot, standard)
    assert full[-1] == 0.79
    assert len(full) < 10


def test_the_picked_pixel_keeps_its_place_in_a_larger_picture(qtbot, standard):
    standard.pick(48, 24)
    standard.set_size(192, 192)
    settle(qtbot, standard)
    assert standard.picked == (96, 48)
    assert standard.hits.size == (192, 192)


def test_a_drag_is_followed_by_small_pictures_and_ends_in_the_full_one(qtbot, standard, monkeypatch):
    monkeypatch.setattr("jaart.gui.results.DRAG_SECONDS", 0.0)
    sizes = []
    standard.hits_changed.connect(lambda: sizes.append(standard.hits.size))
    for degrees in (5, 10):
        standard.set_camera(orbit(standard.camera, degrees, 0), dragging=True)
    standard.set_camera(standard.camera)
    settle(qtbot, standard)
    assert sizes[0] == (12, 12)
    assert standard.complete
    assert standard.hits.camera == standard.camera


def test_the_same_camera_makes_no_new_picture(qtbot, standard):
    standard.set_camera(standard.camera)
    assert standard.idle


def test_a_bad_value_changes_nothing(qtbot, standard):
    before = standard.settings
    with pytest.raises(SettingsError, match="h"):
        standard.set_value("h", -1)
    assert standard.settings is before


@pytest.fixture
def worker(qtbot):
    worker = Worker()
    yield worker
    worker.stop()


def test_the_newest_job_of_a_kind_wins(qtbot, worker):
    gate, started, done = threading.Event(), threading.Event(), []

    def first(job):
        started.set()
        gate.wait(30)
        return "first"

    worker.submit("picture", first, done.append)
    started.wait(30)
    for name in ("second", "third"):
        worker.submit("picture", lambda job, name=name: name, done.append)
    gate.set()
    qtbot.waitUntil(lambda: worker.idle, timeout=PATIENCE)
    assert done == ["third"]


def test_a_job_that_was_replaced_still_shows_something_first(qtbot, worker):
    gate, started, cancelled, shown = threading.Event(), threading.Event(), [], []

    def first(job):
        started.set()
        gate.wait(30)
        cancelled.append(job.cancel.is_set())
        job.partial("coarse")
        cancelled.append(job.cancel.is_set())

    worker.submit("picture", first, shown.append, shown.append)
    started.wait(30)
    worker.submit("picture", lambda job: "second", shown.append, shown.append)
    gate.set()
    qtbot.waitUntil(lambda: worker.idle, timeout=PATIENCE)
    assert cancelled == [False, True]
    assert shown == ["coarse", "second"]


def test_an_unexpected_error_is_told_in_words(qtbot, worker, caplog):
    failures = counted(worker.failed)
    worker.submit("trace", lambda job: 1 / 0, lambda result: None)
    qtbot.waitUntil(lambda: worker.idle, timeout=PATIENCE)
    assert failures[0][0].startswith("internal error: ZeroDivisionError")
    assert "Traceback" in caplog.text


def test_stopping_cancels_what_runs_and_ends_the_thread(qtbot):
    worker, started = Worker(), threading.Event()

    def endless(job):
        started.set()
        assert job.cancel.wait(30)

    worker.submit("picture", endless, lambda result: None)
    started.wait(30)
    worker.stop()
    assert "jaart worker" not in [thread.name for thread in threading.enumerate()]


def test_orbit_keeps_the_distance_and_stays_upright():
    camera = Camera.fit((10.0, 10.0, 10.0))
    for turned in (orbit(camera, 40, 0), orbit(camera, 0, 500), orbit(camera, 0, -500), orbit(camera, 725, 33)):
        away = np.subtract(turned.eye, turned.target)
        assert np.linalg.norm(away) == pytest.approx(np.linalg.norm(np.subtract(camera.eye, camera.target)))
        assert abs(np.degrees(np.arcsin(away[2] / np.linalg.norm(away)))) <= STEEPEST + 1e-9
        assert turned.frame()[1][2] > 0


def test_pan_moves_what_is_under_the_mouse_with_it():
    camera = Camera.fit((10.0, 10.0, 10.0))
    moved = pan(camera, 0.25, 0.0)
    right = camera.frame()[0]
    shift = np.subtract(moved.target, camera.target)
    np.testing.assert_allclose(shift, -0.25 * width(camera) * right, atol=1e-12)


def test_zoom_shows_half_the_width_twice_as_large():
    for camera in (Camera.fit((4.0, 5.0, 6.0)), Camera((0, -9, 0), (0, 0, 0), ortho=8.0)):
        assert width(zoom(camera, 2.0)) == pytest.approx(width(camera) / 2)


def test_a_standard_view_can_be_orbited():
    turned = orbit(view(((-2.0, -2.0, 1.0), (2.0, 2.0, 5.0)), "Top"), 10, -20)
    away = np.subtract(turned.eye, turned.target)
    assert np.degrees(np.arcsin(away[2] / np.linalg.norm(away))) == pytest.approx(70)


def test_settings_that_were_refused_after_they_changed_are_not_told(qtbot, worker):
    gate, started, told = threading.Event(), threading.Event(), counted(worker.refused)

    def first(job):
        started.set()
        gate.wait(30)
        raise SettingsError("h = 9: too large")

    worker.submit("picture", first, print, print)
    started.wait(30)
    worker.submit("picture", lambda job: "second", lambda result: None, print)
    gate.set()
    qtbot.waitUntil(lambda: worker.idle, timeout=PATIENCE)
    assert not told
