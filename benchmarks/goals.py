"""The goals that are ratios to peers, read off the rows of a run."""

from __future__ import annotations

from benchmarks.table import Row

SIZE = "512x512"
#: A mesh with holes is no whole surface: the share of our hits that it must meet.
WHOLE = 0.999


def lines(rows: list[Row]) -> list[str]:
    """A line for each goal whose rows were measured."""
    return ["goals, as ratios of this run", *_lattice(rows), *_cloud(rows)]


def _lattice(rows: list[Row]) -> list[str]:
    own = {row.program: row for row in rows if (row.scene, row.size) == ("standard 64^3", SIZE) and row.rays_s}
    embree, found = own.get("marching cubes + Embree"), []
    if embree is None or "Jaart, best" not in own:
        return [f"  standard 64^3 at {SIZE}, rays: not measured beside a peer"]
    for name, goal in (("thesis", 1.3), ("best", 3.0)):
        row = own[f"Jaart, {name}"]
        found.append(f"  standard 64^3 at {SIZE}, {name}: rays {row.embree_ratio:.2f} times those of Embree, at most "
                     f"{goal} wanted; delta {row.error / embree.error:.2f} times its own"
                     + (", below 0.5 wanted" if name == "best" else ""))
    return found


def _cloud(rows: list[Row]) -> list[str]:
    own = [row for row in rows if row.scene.startswith("bumpy 67,038") and row.size == SIZE and row.rays_s]
    ours = [row for row in own if row.program.startswith("Jaart")]
    whole = [row for row in own if row not in ours and row.hits >= WHOLE * max(r.hits for r in ours)]
    if not whole:
        return [f"  67,038 points at {SIZE}, first picture: not measured beside a peer with a whole surface"]
    quickest = min(whole, key=lambda row: row.first_s)
    return [f"  67,038 points at {SIZE}, {row.program}: first picture {quickest.first_s / row.first_s:.2f} times "
            f"as soon as with {quickest.program}, at least 10 wanted" for row in ours]
