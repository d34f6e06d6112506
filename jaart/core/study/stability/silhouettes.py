"""Rows 44 to 46: rays that graze the surface."""

from __future__ import annotations

import numpy as np

from jaart.core.records import Hits
from jaart.core.render import unit
from jaart.core.scene import Array
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case
from jaart.core.study.stability.looks import Looks, thesis_sphere
from jaart.core.study.stability.scenes import shot
from jaart.core.trace import trace

#: Lists of 6 cells cut off less than 1e-16: no jump at cell faces blurs the silhouette.
H = 0.8
LONG_LISTS = Settings(tolerance=1e-12, max_iterations=100).replace(h=H, radius=6)
#: A hit farther than this from the true one is another root.
OTHER = 1e-6
#: Between which t rays from 9 cells before the sphere's middle come nearest to its surface, and meet it.
NEAREST, MEET = (6.0, 12.0), (5.5, 12.5)


def _beside(count: int, seed: int, distance: Array) -> tuple[Array, Array, Array]:
    """Rays that pass the sphere's middle at a distance (R,) in cells, and where they lie aside of it (R, 3)."""
    rng = np.random.default_rng(seed)
    directions = unit(rng.normal(size=(count, 3)))
    aside = unit(np.cross(directions, rng.normal(size=(count, 3))))
    return 8 + distance[:, None] * aside - 9 * directions, directions, aside


def _errors(hits: Hits, truth: Array) -> tuple[int, int, int]:
    """False hits, false misses and other roots than the first."""
    met = np.isfinite(truth)
    other = hits.hit & met & ~(np.abs(hits.t - truth) <= OTHER)
    return int((hits.hit & ~met).sum()), int((~hits.hit & met).sum()), int(other.sum())


@case(44, "rays that graze the sphere of the thesis, 0.001 h within and beside its silhouette",
      "search = safe: no false hit, no false miss, no rear root, by a dense look at the same f", rays=(100, 30))
def grazing_rays(count: int) -> Outcome:
    """The silhouette is that of {f = 0}. The other searches promise nothing there; how they do stands beside."""
    looks = Looks.of(thesis_sphere(), LONG_LISTS)
    origins, directions, aside = _beside(count, 44, np.full(count, 4.0))
    low, high = (np.full(count, t) for t in NEAREST)
    margin = np.where(np.arange(count) % 2, 0.001 * H, -0.001 * H)
    origins += (looks.silhouette(origins, directions, aside, low, high) + margin)[:, None] * aside
    truth = looks.first(origins, directions, *MEET, 0.05)
    found = {search: shot(thesis_sphere(), LONG_LISTS.replace(search=search), origins, directions)
             for search in ("safe", "newton", "iterate")}
    said = [f"{search} {'/'.join(map(str, _errors(hits, truth)))} at {hits.evaluations.mean():.0f} evaluations"
            for search, hits in found.items()]
    split = np.array_equal(np.isfinite(truth), margin < 0)
    return Outcome(f"false hits/false misses/other roots of {count} rays: {', '.join(said)}",
                   _errors(found["safe"], truth) == (0, 0, 0) and split)


@case(45, "a ray that misses the sphere, on which the iteration is caught in its 2-cycle",
      "iterate: cap, never a hit; safe: a clean miss, by the extremum of f")
def the_cycle_at_a_silhouette() -> Outcome:
    """Beside a silhouette the step is t' = (t - c²/t)/2, so cot θ to cot 2θ: from 60° to 120° and back, unstably.

    The ray's height is halved in until x₆ = x₄; the last digits of it then keep the iteration there up to the cap.
    """
    settings = LONG_LISTS.replace(search="iterate", max_iterations=20, trust=100)
    low, high = 11.9694, 11.9704
    for _ in range(60):
        middle = (low + high) / 2
        t = _steps(middle, settings)
        low, high = (middle, high) if t[6] < t[4] else (low, middle)
    caught, safe = (trace(thesis_sphere(), chosen, (0, low, 8.3), (1, 0, 0))
                    for chosen in (settings, settings.replace(search="safe")))
    t = caught.t_query[caught.start == 0]
    drift = float(np.abs(t[6:] - t[4:-2]).max())
    return Outcome(f"iterate goes between t = {t[4]:.4f} and {t[5]:.4f}, to {drift:.0e}, and ends with "
                   f"{caught.outcome[len(t) - 1]}; safe: {safe.status} after {safe.steps} looks",
                   len(t) == 20 and drift < 1e-2 and abs(t[5] - t[4]) > 0.1 and not caught.hit
                   and caught.outcome[len(t) - 1] == "cap" and safe.status == "background" and safe.steps < 200)


def _steps(height: float, settings: Settings) -> Array:
    """The t of the steps of the first start, on a ray along x."""
    found = trace(thesis_sphere(), settings, (0, height, 8.3), (1, 0, 0))
    first: Array = found.t_query[found.start == 0]
    return first


@case(46, "rays that pass the sphere at 4.0, 4.2 and 4.5 cells from its middle, outside, with covariance normals",
      "no hit with normals about a(x), the default; those about x, as in the sources, meet ghosts", rays=(180, 60))
def false_hits_outside(count: int) -> Outcome:
    """No bound refuses any. About x the direction of least spread is a tangent where a(x) is 0.71 h away."""
    origins, directions, _ = _beside(count, 46, np.resize([4.0, 4.2, 4.5], count))
    found = {(normal, search): int(shot(thesis_sphere(), LONG_LISTS.replace(
        normal=normal, search=search, max_off_centre="none"), origins, directions).hit.sum())
        for normal in ("covariance", "covariance_at_x") for search in ("iterate", "newton", "safe")}
    said = [f"{n} {search}" for (normal, search), n in found.items() if normal == "covariance"]
    ghosts = [f"{n} {search}" for (normal, search), n in found.items() if normal != "covariance"]
    clean = not any(n for (normal, _), n in found.items() if normal == "covariance")
    return Outcome(f"hits of {count} rays about a(x): {', '.join(said)}; about x: {', '.join(ghosts)}", clean)
