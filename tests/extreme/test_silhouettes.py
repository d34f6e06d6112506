"""The safe search at silhouettes: a thousand rays, half of them grazing, against a dense look at the same f.

The hundred thousand of docs/numerics.md are `python -m benchmarks.silhouettes`.
"""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.dense import looked
from benchmarks.silhouettes import BESIDE, SAME, H, anywhere, compared, grazing, scenes
from jaart.core.render import render

NAMES = ("sphere", "box", "torus", "splash")


@pytest.mark.parametrize("name", NAMES)
def test_the_safe_search_is_never_wrong_and_the_iteration_is(name: str) -> None:
    found = compared(name, 250)
    for kind in ("anywhere", "grazing"):
        safe, iterate = found[kind, "safe"], found[kind, "iterate"]
        assert (safe.false_hits, safe.false_misses, safe.rear) == (0, 0, 0)
        assert safe.rays == iterate.rays == 125 and 20 < safe.hits < 110
        assert safe.evaluations < 100
    wrong = found["grazing", "iterate"]
    assert wrong.false_hits + wrong.false_misses + wrong.rear > 5
    assert wrong.evaluations > found["grazing", "safe"].evaluations


def test_grazing_rays_are_as_near_to_the_silhouette_as_they_say() -> None:
    """Of each pair of rays beside a touching one, the inner hits a sphere, whose silhouette is all there is."""
    scene, chosen = scenes()["sphere"]
    rays = grazing(scene, chosen, 8 * BESIDE, 3)
    hit = ~np.isnan(looked(scene, chosen, *rays))
    assert (hit == np.tile((True, False), 4 * BESIDE)).all()
    closest = np.sort(np.linalg.norm(np.cross(rays[0] - 8, rays[1]), axis=1).reshape(8, BESIDE), axis=1)
    assert (np.diff(closest[:, BESIDE // 2 - 1:BESIDE // 2 + 1]) < 1e-3 * H).all()


def test_the_dense_look_finds_what_a_look_ten_times_as_dense_finds() -> None:
    scene, chosen = scenes()["torus"]
    rays = anywhere(scene, chosen, 60, 8)
    fine, coarse = (looked(scene, chosen, *rays, step) for step in (0.005, 0.05))
    assert np.array_equal(np.isnan(fine), np.isnan(coarse)) and (~np.isnan(fine)).sum() > 10
    assert np.nanmax(np.abs(fine - coarse)) < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_proven_misses_are_misses(name: str) -> None:
    """Nothing that the proof excludes is found by the dense look, and next to nothing is left undecided."""
    scene, chosen = scenes()[name]
    rays = [np.concatenate(pair) for pair in zip(anywhere(scene, chosen, 60, 9), grazing(scene, chosen, 60, 9),
                                                 strict=True)]
    hits, truth = render(scene, chosen.replace(proof=True), rays=(rays[0], rays[1])), looked(scene, chosen, *rays)
    names = hits.counts()
    assert hits.hit.tolist() == (~np.isnan(truth)).tolist()
    assert names["background"] > 20 and names.get("undecided", 0) <= 6
    assert np.nanmax(np.abs(hits.t - truth)) < SAME
