"""`proof = true`: a miss of the safe search is certain, or it is called undecided; hits stay as they are."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.errors import SettingsError
from jaart.core.records import STATUS, Hits
from jaart.core.render import render
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from tests.core.cloud_scenes import cloud
from tests.core.cloud_scenes import rays as cloud_rays
from tests.core.oracle_scene import Oracle, scene_of, stretches
from tests.core.search_rays import TIGHT, rays
from tests.oracle.searches import bisect
from tests.oracle.vectors import along

SAFE = TIGHT.replace(search="safe", max_off_centre=0.3)
WEIGHTS = ["gaussian", "hat", "squared_hat", "wendland"]


def both(scene: Scene, settings: Settings, along_: tuple[np.ndarray, np.ndarray]) -> tuple[Hits, Hits]:
    """Hits without and with the proof."""
    return render(scene, settings, rays=along_), render(scene, settings.replace(proof=True), rays=along_)


@pytest.mark.parametrize("weight", WEIGHTS)
@pytest.mark.parametrize("neighbourhood", ["cell_ball", "ball", "cell_knn"])
def test_hits_are_the_same_and_most_misses_are_proven(weight: str, neighbourhood: str) -> None:
    settings = SAFE.replace(weight=weight, neighbourhood=neighbourhood)
    free, proven = both(scene_of("standard"), settings, rays("standard"))
    assert (proven.hit == free.hit).all() and proven.hit.sum() > 20
    assert proven.t[free.hit].tobytes() == free.t[free.hit].tobytes()
    left = ~free.hit & (free.status == STATUS["background"])
    assert set(np.unique(proven.status[left])) <= {STATUS["background"], STATUS["undecided"]}
    assert (proven.status[left] == STATUS["undecided"]).sum() <= 0.1 * len(free)
    assert (proven.evaluations[left] > free.evaluations[left]).any()
    assert (proven.evaluations[free.hit] >= free.evaluations[free.hit]).all()


@pytest.mark.parametrize("name", ["standard", "random"])
def test_no_root_lies_on_a_proven_miss(name: str) -> None:
    """The oracle looks closely: where f changes its sign it jumps, or the barycentre is too far off."""
    settings = SAFE.replace(proof=True)
    hits = render(scene_of(name), settings, rays=rays(name, 40))
    oracle, looked = Oracle.of(scene_of(name), settings), 0
    for i in np.flatnonzero((hits.status == STATUS["background"]) & (hits.evaluations > 0))[:16]:
        o, d = hits.origin[i].tolist(), hits.direction[i].tolist()
        for part in stretches(oracle, o, d):
            ts = np.linspace(part.enter, part.leave, 24)[1:-1].tolist()
            f = part.along(oracle.f, o, d)
            values = [f(t) for t in ts]
            looked += sum(value is not None for value in values)
            for k in range(len(ts) - 1):
                before, after = values[k], values[k + 1]
                if before is not None and after is not None and before * after < 0:
                    root = bisect(f, ts[k], ts[k + 1], 1e-13)
                    if root is None:
                        continue  # f ends there
                    beside, off = f(root), oracle.off_centre(part.cell, along(o, d, root))
                    assert beside is None or abs(beside) > 1e-9 or off > oracle.values.off_centre
    assert looked > 50


@pytest.mark.parametrize("weight", ["gaussian", "wendland"])
def test_clouds_prove_their_misses_too(weight: str) -> None:
    scene = cloud("sphere", 400)
    free, proven = both(scene, Settings(method="tangent", search="safe", weight=weight), cloud_rays(300))
    assert proven.t.tobytes() == free.t.tobytes()
    assert proven.counts().get("undecided", 0) == 0
    assert proven.counts()["background"] == free.counts()["background"] > 20


def test_a_sheet_that_cannot_be_told_from_a_miss_is_undecided() -> None:
    """Two sheets that face the same way: between them f changes its sign and rises, which is no surface."""
    x, y = (a.ravel() for a in np.meshgrid(np.arange(-4.0, 5), np.arange(-4.0, 5)))
    points = np.concatenate([np.column_stack((x, y, np.full(81, z))) for z in (-1.0, 1.0)])
    scene = Scene("sheets", points=points, normals=np.tile((0.0, 0, 1), (162, 1)))
    settings = Settings(method="tangent", search="safe", h=1.0, radius=8.0)
    along_ = np.array([[0.3, 0.2, 0.9]]), np.array([[0.0, 0.0, -1.0]])  # past the ghost to the lower sheet
    between = np.array([[0.3, 0.2, 0.5]]), np.array([[1.0, 0.0, 0.0]])  # along the sheets: f keeps its sign
    assert both(scene, settings, along_)[1].hit.all()
    assert not both(scene, settings, between)[1].hit.any()
    assert both(scene, settings, between)[1].status[0] == STATUS["background"]
    tilted = np.array([[-3.0, 0.2, 0.3]]), np.array([[1.0, 0.0, -0.1]]) / np.sqrt(1.01)
    free, proven = both(scene, settings, tilted)
    assert not free.hit.any() and free.status[0] == STATUS["background"]
    assert proven.status[0] == STATUS["undecided"]


@pytest.mark.parametrize("other", [{"search": "march"}, {"method": "polynomial"}, {"normal": "covariance"},
                                   {"neighbourhood": "knn"}, {"traversal": "uniform"}])
def test_what_has_no_bounds_is_refused(other: dict[str, str]) -> None:
    with pytest.raises(SettingsError, match=r"proof = true: bounds are known for the tangent surface"):
        render(scene_of("standard"), SAFE.replace(proof=True, **other), size=(4, 4))


@pytest.mark.parametrize("search", ["safe", "march", "minimise"])
def test_a_wall_in_the_lattices_border_is_seen(search: str) -> None:
    """With the border closed a full lattice is a box, whose faces lie exactly where rays enter."""
    scene = Scene("full", levels=np.ones((6, 5, 4)))
    rng = np.random.default_rng(2)
    targets = rng.uniform(1, 3, (200, 3))
    eyes = targets + 12 * _unit(rng.normal(size=(200, 3)))
    settings = Settings(method="tangent", search=search, border="closed", placement="exact", tolerance=1e-6)
    hits = render(scene, settings, rays=(eyes, _unit(targets - eyes)))
    low = (np.where(hits.direction > 0, 0, (6, 5, 4)) - hits.origin) / hits.direction
    flat = np.sort(np.abs(hits.origin + low.max(axis=1)[:, None] * hits.direction - (3, 2.5, 2)) - (3, 2.5, 2), axis=1)
    clear = flat[:, 1] < -1.5  # far from edges, where the surface is round
    assert clear.sum() > 30 and hits.hit[clear].all()
    assert hits.t[clear] == pytest.approx(low.max(axis=1)[clear], abs=1e-2)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
