"""Meshes of a step: shapes by their measures, and each part at its place."""

from __future__ import annotations

import numpy as np
import pytest
from make_trace import make_trace

from jaart.plot import glyphs
from jaart.plot.scene3d import PARTS, rgb, span, step_meshes, view
from jaart.plot.style import THEMES

HITS = make_trace((0.3, -6, 2.2), (0.25, 1, 0.1))


def volume(template):
    """Volume inside a closed surface of outward triangles."""
    a, b, c = (template[0][template[1][:, k]] for k in range(3))
    return (a * np.cross(b, c)).sum() / 6


def test_closed_templates_face_outwards():
    assert volume(glyphs.diamond()) == pytest.approx(4 / 3)
    assert volume(glyphs.ball(40, 60)) == pytest.approx(4 * np.pi / 3, rel=0.01)
    assert volume(glyphs.cone(1.0, 3.0, 100)) == pytest.approx(np.pi, rel=0.01)
    one = glyphs.star()
    assert volume((one[0], one[1][:4])) == pytest.approx(volume((one[0], one[1][4:])))
    assert volume(one) > 0


def test_frames_are_right_handed_with_the_axis_last():
    axes = np.random.default_rng(3).normal(size=(50, 3))
    axes = np.vstack([axes / np.linalg.norm(axes, axis=1, keepdims=True), np.eye(3), -np.eye(3)])
    made = glyphs.frames(axes)
    np.testing.assert_allclose(made @ made.transpose(0, 2, 1), np.tile(np.eye(3), (56, 1, 1)), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(made), 1)
    np.testing.assert_allclose(made[:, 2], axes)


def test_copies_stand_at_their_places_along_their_axes():
    template = glyphs.cone(0.1, 1.0)
    mesh = glyphs.copies(template, np.array([[1.0, 2, 3], [4, 5, 6]]), np.array([[1.0, 0, 0], [0, -1, 0]]),
                         np.array([1.0, 2.0]), np.array([[255, 0, 0], [0, 0, 255]]))
    tips = mesh.points[len(template[0]) - 1::len(template[0])]
    np.testing.assert_allclose(tips, [[2, 2, 3], [4, 3, 6]], atol=1e-14)
    assert mesh.elements.max() == len(mesh.points) - 1
    assert mesh.colours[-1].tolist() == [0, 0, 255]


def test_joined_meshes_keep_their_triangles():
    one = glyphs.copies(glyphs.disc(8), np.zeros((1, 3)), np.array([[0.0, 0, 1]]), 1.0, rgb("#ffffff"))
    both = glyphs.join(one, one)
    np.testing.assert_array_equal(both.points[both.elements[len(one):]], one.points[one.elements])


def test_the_boxes_are_the_cells_near_the_steps():
    low, high = span(HITS, 0)
    near = (HITS.borders[1:] >= low - 1) & (HITS.borders[:-1] <= high + 1)
    meshes = step_meshes(HITS, 0)
    corners = meshes["full_cells"].points.reshape(-1, 8, 3)
    np.testing.assert_array_equal(corners.min(axis=1), HITS.cells[near & HITS.with_surfel])
    assert len(meshes["cells"]) == 12 * (near & ~HITS.with_surfel).sum()


@pytest.mark.parametrize("theme", THEMES)
def test_every_part_of_a_step_is_there_and_finite(theme):
    for step in range(HITS.steps):
        meshes = step_meshes(HITS, step, theme)
        assert list(meshes) == list(PARTS)
        colours = {tuple(c) for c in meshes["solids"].colours}
        for kind in ("query", "barycentre", "hit", "ray", "plane"):
            assert tuple(rgb(getattr(THEMES[theme], kind)).astype(int)) in colours


def test_the_patch_of_the_plane_lies_in_it():
    patch = step_meshes(HITS, 1)["plane"].points
    np.testing.assert_allclose((patch - HITS.barycentre[1]) @ HITS.step_normal[1], 0, atol=1e-12)


def test_undefined_parts_are_left_out():
    trace = make_trace((0.3, -6, 2.2), (0.25, 1, 0.1))
    for name in ("barycentre", "step_normal", "next_point"):
        getattr(trace, name)[0] = np.nan
    trace.t_next[0] = trace.energy[0] = np.nan
    assert {"plane", "open"}.isdisjoint(step_meshes(trace, 0))
    assert np.isfinite(step_meshes(trace, 0)["solids"].points).all()


def test_views_look_where_they_say():
    for kind, along in (("ray", HITS.direction), ("side", None)):
        eye, target, up = (np.array(v) for v in view(HITS, 0, kind))
        ahead = (target - eye) / np.linalg.norm(target - eye)
        if along is None:
            assert ahead @ HITS.direction == pytest.approx(0, abs=1e-12)
            assert np.cross(ahead, up) @ HITS.direction == pytest.approx(1)
        else:
            np.testing.assert_allclose(ahead, along, atol=1e-12)
