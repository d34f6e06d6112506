"""Isosurfaces of energies and of fill levels, sampled, meshed, rendered and written: against what they must be."""

from __future__ import annotations

from dataclasses import replace
from threading import Event

import numpy as np
import pytest

import jaart
from jaart.core import assemble, memory, prepare
from jaart.core.errors import Cancelled, FileError, RayError, SettingsError
from jaart.core.field import ENERGIES, Energy, energy_field, energy_gradients
from jaart.core.mesh_files import SUFFIXES, save_mesh
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.warm import warm_up

SHAPE = (11, 12, 10)
BASE = Settings(h=0.8, radius=2.0)


def ball(radius: float = 3.4) -> Scene:
    """Fill levels of a ball, as a linear ramp of the distance."""
    at = np.stack(np.indices(SHAPE), axis=-1) + 0.5
    distance = np.linalg.norm(at - np.array(SHAPE) / 2, axis=-1)
    return Scene("ball", levels=np.clip(0.5 + radius - distance, 0, 1))


def energy_of(scene: Scene, name: str, settings: Settings | None = None, **more) -> Energy:
    settings = settings or BASE
    values = warm_up(scene, settings)
    return Energy(prepare.cells(scene, settings, values), assemble.plan_of(scene, settings, values), name, **more)


def expected(scene: Scene, name: str, x: np.ndarray, cell: tuple[int, ...], d: np.ndarray) -> float:
    """The energy from its definition, with the surfels within 2 cells of the cell's centre [T 2.15–2.23]."""
    found = prepare.surfels(scene, BASE)
    near = np.linalg.norm(found.points - (np.array(cell) + 0.5), axis=1) <= 2.0
    p, n = found.points[near], found.normal[near]
    if not len(p):
        return np.nan
    w = np.exp(-((p - x) ** 2).sum(axis=1) / 0.64)
    w /= w.sum()
    off = w @ p - x
    normal = w @ n / np.linalg.norm(w @ n)
    q = p - x
    height = (q * n).sum(axis=1)
    return {"tangent": abs(normal @ off), "tangent_step": abs(normal @ off / (normal @ d)),
            "off_centre": np.linalg.norm(off), "angle": abs(off @ normal) / np.linalg.norm(off),
            "mahalanobis": w @ (0.75 * height**2 + 0.25 * (q * q).sum(axis=1))}[name]


@pytest.mark.parametrize("name", ENERGIES)
def test_the_field_is_the_energy_with_the_neighbourhood_of_the_cell_on_the_low_side(name):
    scene, d = ball(), np.array([2.0, -1.0, 2.0]) / 3
    values = energy_field(energy_of(scene, name, direction=tuple(d)), 2)
    assert values.shape == tuple(2 * n + 1 for n in SHAPE)
    rng = np.random.default_rng(5)
    known = np.argwhere(np.isfinite(values))
    for index in rng.permutation(known)[:60]:
        cell = tuple(np.maximum((index - 1) // 2, 0))
        assert values[tuple(index)] == pytest.approx(expected(scene, name, index / 2, cell, d), rel=1e-11, abs=1e-13)
    for index in rng.permutation(np.argwhere(np.isnan(values)))[:60]:
        assert np.isnan(expected(scene, name, index / 2, tuple(np.maximum((index - 1) // 2, 0)), d))


def test_an_emphasised_field_follows_its_formula():
    scene = ball()
    plain, angle = (energy_field(energy_of(scene, name), 1) for name in ("off_centre", "angle"))
    both = energy_field(energy_of(scene, "off_centre", emphasise=True), 1)
    assert np.allclose(both, 1 - (1 - angle) * (1 - np.minimum(plain, 1)), atol=1e-14, equal_nan=True)


def test_the_field_has_the_same_bits_whatever_the_threads():
    scene = ball()
    told: list[tuple[int, int]] = []
    one = energy_field(energy_of(scene, "tangent"), 2, threads=1, progress=lambda *done: told.append(done))
    four = energy_field(energy_of(scene, "tangent"), 2, threads=4)
    assert told == [(i + 1, SHAPE[0]) for i in range(SHAPE[0])]
    assert np.array_equal(one, four, equal_nan=True)


def test_gradients_are_those_of_the_field():
    scene = ball()
    energy = energy_of(scene, "off_centre", Settings(radius=4.0, weight="wendland"))
    points = np.argwhere(np.isfinite(energy_field(energy, 1))[1:-1, 1:-1, 1:-1]) + 0.6
    found = energy_gradients(energy, points)
    fine = energy_field(energy, 5)  # x.6 is a point of it
    i = np.rint(points * 5).astype(int)
    rough = np.stack([(fine[tuple((i + s).T)] - fine[tuple((i - s).T)]) / 0.4 for s in np.eye(3, dtype=int)], axis=1)
    both = np.isfinite(rough).all(axis=1) & (np.linalg.norm(found, axis=1) > 0.2)
    assert both.sum() > 100
    assert np.median(np.linalg.norm(found - rough, axis=1)[both]) < 0.05
    assert np.isnan(energy_gradients(energy, np.array([[0.0, 0.0, 0.0]]))).all()


def test_an_isosurface_is_a_shell_with_a_sheet_on_each_side():
    scene = ball()
    mesh = jaart.isosurface(scene, energy="tangent", level=0.25, subdivide=4)
    out = mesh.vertices - np.array(SHAPE) / 2
    distance = np.linalg.norm(out, axis=1)
    cosine = np.einsum("ij,ij->i", mesh.normals, out) / distance
    outer = distance > 3.3
    assert np.abs(distance[outer] - 3.55).max() < 0.15 and np.abs(distance[~outer] - 3.05).max() < 0.15
    assert cosine[outer].min() > 0.95 and cosine[~outer].max() < -0.95


def test_a_fill_level_is_the_balls_surface():
    scene = ball()
    mesh = jaart.isosurface(scene, energy="fill_level")
    out = mesh.vertices - np.array(SHAPE) / 2
    distance = np.linalg.norm(out, axis=1)
    assert np.abs(distance - 3.4).max() < 0.08 and abs(distance.mean() - 3.4) < 0.02
    assert (np.einsum("ij,ij->i", mesh.normals, out) / distance).min() > 0.97
    higher = jaart.isosurface(scene, energy="fill_level", level=0.7)
    assert np.linalg.norm(higher.vertices - np.array(SHAPE) / 2, axis=1).mean() == pytest.approx(3.2, abs=0.06)


def test_the_border_is_open_or_closed_and_the_filter_comes_first():
    levels = np.zeros((6, 6, 6))
    levels[:, :, :3] = 1.0
    scene = Scene("basin", levels=levels)
    opened = jaart.isosurface(scene, Settings(border="open"), "fill_level")
    closed = jaart.isosurface(scene, Settings(border="closed"), "fill_level")
    assert (opened.vertices[:, 2] == 3).all() and opened.vertices.min() == 0.5
    assert closed.vertices[:, 2].min() == 0.0 and closed.vertices[:, :2].max() == 6.0
    flat = jaart.isosurface(scene, Settings(border="closed", filter="gauss"), "fill_level", 0.8)
    assert flat.vertices[:, 2].max() < 2.6


def test_rays_meet_the_mesh_that_is_made_and_a_trace_has_curves_but_no_steps():
    scene = ball()
    settings = Settings(method="isosurface", subdivide=4, level=0.2)
    hits = jaart.render(scene, settings, size=(48, 48))
    assert set(hits.counts()) == {"converged", "background"}
    out = hits.point[hits.hit] - np.array(SHAPE) / 2
    assert np.abs(np.linalg.norm(out, axis=1) - 3.5).max() < 0.2
    assert not hits.evaluations.any() and not hits.iterations.any() and (hits.energy[hits.hit] == 0).all()
    ray = int(np.flatnonzero(hits.hit)[7])
    trace = jaart.trace(scene, settings, hits.origin[ray], hits.direction[ray])
    assert trace.t == hits.t[ray] and trace.normal.tolist() == hits.normal[ray].tolist()
    assert trace.steps == 0 and np.isfinite(trace.curves.tangent).any()
    at = np.abs(trace.curves.t - trace.t).argmin()
    assert abs(trace.curves.off_centre[at]) < 0.5


def test_the_shading_normal_is_the_meshs_or_the_triangles():
    scene, size = ball(), (64, 64)
    smooth, flat = (jaart.render(scene, Settings(method="fill_level", shading_normal=which), size=size)
                    for which in ("average", "gradient"))
    assert (smooth.status == flat.status).all() and smooth.t.tolist() == pytest.approx(flat.t.tolist(), nan_ok=True)
    assert len(np.unique(flat.normal[flat.hit], axis=0)) < 200 < len(np.unique(smooth.normal[smooth.hit], axis=0))
    assert np.einsum("ij,ij->i", smooth.normal[smooth.hit], flat.normal[flat.hit]).min() > 0.9


def test_a_mesh_is_close_to_the_exact_solids():
    scene = jaart.load("standard")
    bare = Settings(method="fill_level")
    shell = Settings(method="isosurface", subdivide=8, level=0.07, placement="exact")
    deltas = [jaart.quality(jaart.render(scene, s, size=(96, 96)), scene).delta for s in (bare, shell)]
    assert deltas[1] < deltas[0] < 0.25 and deltas[1] < 0.13


@pytest.mark.parametrize(("arguments", "message"), [
    ({"energy": "tangent_step"}, "expected a direction"),
    ({"energy": "tangent", "direction": (0, 0, 1)}, "direction: has no meaning for tangent"),
    ({"energy": "fill_level", "direction": (0, 0, 1)}, "direction: has no meaning"),
    ({"energy": "weight"}, "energy = weight: expected tangent, tangent_step"),
    ({"level": 50.0}, "level = 50: no surface there, tangent is between"),
    ({"energy": "fill_level", "level": 1.5}, "level = 1.5: no surface there, the fill level is between 0 and 1"),
    ({"subdivide": 9}, "subdivide = 9: expected"),
])
def test_what_makes_no_sense_is_refused_by_name(arguments, message):
    with pytest.raises(SettingsError, match=message):
        jaart.isosurface(ball(), **arguments)


def test_emphasis_is_for_energies_other_than_the_angle():
    emphasised = Settings(emphasise=True, max_off_centre="none")
    mesh = jaart.isosurface(ball(), emphasised, "off_centre", 0.8, 4)
    assert len(mesh) > 1000
    with pytest.raises(SettingsError, match="emphasise"):
        jaart.isosurface(ball(), emphasised, "angle", 0.8)


def test_a_direction_that_is_none_and_a_cloud_are_refused():
    with pytest.raises(RayError, match="direction"):
        jaart.isosurface(ball(), energy="tangent_step", direction=(0, 0, 0))
    with pytest.raises(SettingsError, match="needs a lattice"):
        jaart.isosurface(Scene("cloud", points=np.random.default_rng(1).normal(size=(50, 3))))


def test_the_direction_enters_the_step_by_its_line_alone():
    scene = ball()
    one, other = (jaart.isosurface(scene, energy="tangent_step", level=0.3, direction=d)
                  for d in ((0, 0, 3), (0, 0, -1)))
    assert np.array_equal(one.vertices, other.vertices)
    assert not np.array_equal(one.vertices, jaart.isosurface(scene, energy="tangent", level=0.3).vertices)


def test_too_large_a_field_is_refused_and_work_can_be_cancelled(monkeypatch):
    cancel = Event()
    cancel.set()
    with pytest.raises(Cancelled):
        jaart.isosurface(ball(), cancel=cancel)
    energy = energy_of(ball(), "tangent")
    monkeypatch.setattr(memory, "limit", lambda: 200_000)
    with pytest.raises(SettingsError, match="subdivide = 8: a field of 89x97x81 values needs 5"):
        energy_field(energy, 8)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_files_hold_the_mesh_where_the_lattice_lies(tmp_path, suffix):
    pyvista = pytest.importorskip("pyvista")
    mesh = jaart.isosurface(ball(), energy="fill_level")
    path = tmp_path / f"ball{suffix}"
    save_mesh(mesh, path, (0.5, 0.5, 0.5), (10.0, 20.0, 30.0))
    read = pyvista.read(path)
    assert read.n_cells == len(mesh)
    corners = read.points[read.faces.reshape(-1, 4)[:, 1:]]
    there = (0.5 * mesh.vertices + np.array([10.0, 20, 30]))[mesh.triangles]
    assert np.abs(corners - there).max() < (1e-14 if suffix == ".vtp" else 2e-5)
    if suffix != ".stl":
        assert read.n_points == len(mesh.vertices)
        assert np.abs(np.array(read.point_data.active_normals) - mesh.normals).max() < 2e-5
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("name", ["a.am", "a.vti", "a"])
def test_other_kinds_of_files_are_refused(tmp_path, name):
    with pytest.raises(FileError, match=r"expected \.ply, \.stl, \.obj, \.vtp"):
        save_mesh(jaart.isosurface(ball(), energy="fill_level"), tmp_path / name)
    with pytest.raises(FileError, match="cannot be written"):
        save_mesh(jaart.isosurface(ball(), energy="fill_level"), tmp_path / "nowhere" / "a.ply")


def test_a_stretched_lattice_is_stretched():
    plain, long = (jaart.isosurface(replace(ball(), spacing=s), energy="fill_level") for s in ((2, 2, 2), (2, 2, 1)))
    across = plain.normals / (1, 1, 0.5)
    assert np.abs(long.vertices - plain.vertices * (1, 1, 0.5)).max() < 1e-14
    assert np.abs(long.normals - across / np.linalg.norm(across, axis=1, keepdims=True)).max() < 1e-13
