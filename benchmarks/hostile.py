"""What rays without meaning cost beside ordinary ones: NaN, Inf, zero and denormal numbers, and 1e±300.

Each kind is timed in turn with ordinary rays, several times over, and the median of the ratios counts.
"""

from __future__ import annotations

import numpy as np

import jaart
from jaart.core.records import Array
from jaart.core.suited import suited

RAYS = 100_000
ROUNDS = 7
ODD = (np.nan, np.inf, -np.inf, 0.0, 5e-324, -1e-310, 1e-300, -1e300, 1e300)
Rays = tuple[Array, Array]


def main() -> None:
    print(f"{RAYS} rays, median of {ROUNDS} rounds; ratio: to ordinary rays (at most 1.5 is wanted)")
    print(f"{'scene':8} {'rays':12} {'seconds':>8} {'ratio':>6} {'bad_ray':>8} {'hits':>7}")
    for name in ("splash", "bumpy"):
        scene = jaart.load(name)
        settings = suited(scene, jaart.preset("best"))[0]
        for kind, seconds, ratio, hits in measured(scene, settings):
            counts = hits.counts()
            print(f"{name:8} {kind:12} {seconds:8.3f} {ratio:6.2f} {counts.get('bad_ray', 0):8} {hits.hit.sum():7}")


def measured(scene: jaart.Scene, settings: jaart.Settings) -> list[tuple[str, float, float, jaart.Hits]]:
    """(kind, median seconds, median ratio to ordinary rays, hits) of every kind of rays."""
    all_kinds = kinds(scene, settings)
    first = {name: jaart.render(scene, settings, rays=rays) for name, rays in all_kinds.items()}
    seconds = np.array([[jaart.render(scene, settings, rays=rays).ray_s for rays in all_kinds.values()]
                        for _ in range(ROUNDS)])
    ratios = np.median(seconds / seconds[:, :1], axis=0)
    return list(zip(all_kinds, np.median(seconds, axis=0).tolist(), ratios.tolist(), first.values(), strict=True))


def kinds(scene: jaart.Scene, settings: jaart.Settings) -> dict[str, Rays]:
    """Ordinary rays of a picture, and with numbers of ODD in origins, directions, both, or both in every other ray."""
    rng = np.random.default_rng(1)
    usual = jaart.render(scene, settings, size=(RAYS // 250, 250))
    origins, directions = usual.origin.copy(), usual.direction.copy()

    def odd(values: Array) -> Array:
        """The values with one to three numbers of each row replaced."""
        hit = rng.uniform(size=values.shape) < 0.4
        hit[np.arange(len(hit)), rng.integers(0, 3, len(hit))] = True
        return np.where(hit, rng.choice(ODD, values.shape), values)

    strange, ways = odd(origins), odd(directions)
    half = np.arange(len(origins))[:, None] % 2 == 0
    mixed = np.where(half, strange, origins), np.where(half, ways, directions)
    return {"ordinary": (origins, directions), "origins": (strange, directions), "directions": (origins, ways),
            "both": (strange, ways), "half of them": mixed}


if __name__ == "__main__":
    main()
