"""A small traced ray made with plain numpy: surfels of a sphere, iterated as mathematics says."""

from __future__ import annotations

import numpy as np

from jaart.core.records import Curves, Trace
from jaart.core.settings import Settings
from jaart.core.surfels import Surfels

H, RADIUS, TOLERANCE, BOUND, CAP = 0.8, 2.0, 0.1, 0.3, 20


def sphere_surfels(raster: int = 12, centre: tuple[float, float, float] = (6.0, 6.0, 6.0),
                   radius: float = 4.0) -> Surfels:
    """One surfel in each cell that holds the foot of its centre on the sphere."""
    cells = np.argwhere(np.ones((raster,) * 3, dtype=bool))
    away = cells + 0.5 - centre
    distance = np.linalg.norm(away, axis=1)
    normal = away / distance[:, None]
    offset = normal * (radius - distance)[:, None]
    inside = (np.abs(offset) < 0.5).all(axis=1)
    return Surfels(cells[inside].astype(np.int32), offset[inside], normal[inside])


def local(surfels: Surfels, x: np.ndarray) -> dict | None:
    """Sums of the neighbourhood at x; None where no surfel is near."""
    cell = np.floor(x).astype(np.int32)
    near = np.flatnonzero(np.linalg.norm(surfels.points - (cell + 0.5), axis=1) <= RADIUS)
    if not len(near):
        return None
    away = surfels.points[near] - x
    weight = np.exp(-(away**2).sum(axis=1) / H**2)
    share = weight / weight.sum()
    normal = share @ surfels.normal[near]
    along = (away * surfels.normal[near]).sum(axis=1)
    aside = (away**2).sum(axis=1) - along**2
    return {"cell": cell, "near": near, "share": share, "sum": weight.sum(), "off": share @ away,
            "normal": normal / np.linalg.norm(normal), "mahalanobis": share @ (along**2 + 0.25 * aside)}


def crossed(origin: np.ndarray, direction: np.ndarray, raster: int) -> tuple[np.ndarray, np.ndarray]:
    """Cells along the ray and the t of their borders, by sorting all crossings."""
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (np.arange(raster + 1)[:, None] - origin) / direction
    t = np.unique(np.round(t[np.isfinite(t) & (t > 0)], 12))
    middle = origin + (0.5 * (t[1:] + t[:-1]))[:, None] * direction
    inside = ((middle > 0) & (middle < raster)).all(axis=1)
    cells = np.floor(middle[inside]).astype(np.int32)
    return cells, np.append(t[:-1][inside], t[1:][inside][-1:])


def iterate(surfels: Surfels, origin: np.ndarray, direction: np.ndarray, t: float, start: int) -> list[dict]:
    """The steps of one start at t."""
    steps, first = [], t
    for _ in range(CAP):
        x = origin + t * direction
        here = local(surfels, x)
        if here is None:
            steps[-1]["outcome"] = "few_neighbours"
            return steps
        energy = (here["normal"] @ here["off"]) / (here["normal"] @ direction)
        step = {**here, "t": t, "x": x, "energy": energy, "next": t + energy, "start": start, "outcome": "continue"}
        steps.append(step)
        if abs(t + energy - first) > RADIUS:
            step["outcome"] = "left_trust"
            return steps
        if abs(energy) < TOLERANCE:
            step["outcome"] = "converged" if np.linalg.norm(here["off"]) < BOUND else "bounded"
            return steps
        t += energy
    steps[-1]["outcome"] = "cap"
    return steps


def curves(surfels: Surfels, origin: np.ndarray, direction: np.ndarray, low: float, high: float) -> Curves:
    """The four energies along the ray."""
    t = np.linspace(low, high, 400)
    values = np.full((4, len(t)), np.nan)
    for k, at in enumerate(t):
        here = local(surfels, origin + at * direction)
        if here is not None:
            tangent = (here["normal"] @ here["off"]) / (here["normal"] @ direction)
            values[:, k] = tangent, np.linalg.norm(here["off"]), here["mahalanobis"], (
                abs(here["off"] @ here["normal"]) / np.linalg.norm(here["off"]))
    return Curves(t, *values)


def make_trace(origin=(0.6, -6.0, 7.1), direction=(0.35, 1.0, -0.05), raster: int = 12,
               surfels: Surfels | None = None) -> Trace:
    """A ray through the sphere's surfels, every start until one arrives."""
    surfels = sphere_surfels(raster) if surfels is None else surfels
    origin, direction = np.asarray(origin, float), np.asarray(direction, float)
    direction = direction / np.linalg.norm(direction)
    cells, borders = crossed(origin, direction, raster)
    with_surfel = (cells[:, None] == surfels.cells[None]).all(axis=2).any(axis=1)
    steps: list[dict] = []
    for number, cell in enumerate(np.flatnonzero(with_surfel)):
        steps += iterate(surfels, origin, direction, borders[cell], number)
        if steps[-1]["outcome"] == "converged":
            break
    return _record(steps, surfels, origin, direction, cells, borders, with_surfel, raster)


def _record(steps, surfels, origin, direction, cells, borders, with_surfel, raster) -> Trace:
    def column(name, shape=()):
        return np.array([s[name] for s in steps], dtype=float).reshape(len(steps), *shape)

    status = steps[-1]["outcome"] if steps else "background"
    t = steps[-1]["next"] if status == "converged" else np.nan
    query, off = column("x", (3,)), column("off", (3,))
    return Trace(
        origin=origin, direction=direction, t=t, point=origin + t * direction,
        normal=steps[-1]["normal"] if status == "converged" else np.full(3, np.nan), status=status,
        t_query=column("t"), query=query, barycentre=query + off,
        step_normal=column("normal", (3,)), t_next=column("next"),
        next_point=origin + column("next")[:, None] * direction, energy=column("energy"),
        off_centre=np.linalg.norm(off, axis=1), weight_sum=column("sum"),
        start=np.array([s["start"] for s in steps], dtype=np.int32),
        step_cell=np.array([s["cell"] for s in steps], dtype=np.int32).reshape(-1, 3),
        outcome=tuple(s["outcome"] for s in steps), neighbours=tuple(s["near"] for s in steps),
        weights=tuple(s["share"] for s in steps), cells=cells, borders=borders, with_surfel=with_surfel,
        surfels=surfels, curves=curves(surfels, origin, direction, borders[0], borders[-1]) if len(cells)
        else Curves(*np.empty((5, 0))), settings=Settings(), balls=np.empty((0, 4)), low=np.zeros(3),
        high=np.full(3, float(raster)))
