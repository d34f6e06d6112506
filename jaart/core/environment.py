"""What is around the water, so that it has something to mirror and to bend: a sky, and a tiled floor under the scene.

z is up, colours are linear light.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from jaart.core import extents, prepare
from jaart.core.optics import dots
from jaart.core.scene import Scene
from jaart.core.settings import Settings

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_HORIZON = np.array((0.80, 0.90, 0.98))
_ZENITH = np.array((0.10, 0.28, 0.62))
_SUN = np.array((1.0, 0.93, 0.78))
_SUN_WAY = np.array((-0.48, 0.60, 0.64))
_TILES = np.array(((0.78, 0.75, 0.68), (0.33, 0.36, 0.37)))
#: Tiles across the longest edge of the scene.
_ACROSS = 8
#: How abruptly one tile turns into the next: no more than the pixels of a picture can show.
_SHARP = 14.0
#: Ways through the water that no hit tells are found to this many halvings.
_HALVINGS = 16
#: How many such edges away the floor's pattern, and its colour, have faded into the horizon.
_PATTERN, _FLOOR = 1.6, 3.0


@dataclass(frozen=True, eq=False)
class Environment:
    """Sky and floor about a scene.

    low, high: corners (3,) of the scene's box, which stands on the floor; levels: fill levels (nx, ny, nz) of a
    lattice that fills the box, None for a cloud, of which nobody knows where it holds water.
    """

    low: Array
    high: Array
    levels: Array | None = None

    @classmethod
    def of(cls, scene: Scene, settings: Settings) -> Environment:
        """The environment of a scene, about its lattice or its points."""
        low, high = extents.bounds(scene, settings)
        return cls(low, high, None if scene.kind == "cloud" else prepare.levels(scene, settings))

    @property
    def edge(self) -> float:
        """The scene's longest edge; 1 for a single point."""
        return float((self.high - self.low).max()) or 1.0

    def span(self, origin: Array, direction: Array) -> tuple[Array, Array]:
        """Where each ray (R, 3) enters and leaves the scene's box, from its origin on; (0, 0) where it never does."""
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = (self.low - origin) / direction, (self.high - origin) / direction
        enter = np.maximum(np.fmax.reduce(np.fmin(a, b), axis=1), 0.0)
        leave = np.fmin.reduce(np.fmax(a, b), axis=1)
        crosses = enter <= leave
        return np.where(crosses, enter, 0.0), np.where(crosses, leave, 0.0)

    def in_water(self, point: Array) -> Mask:
        """Whether points (N, 3) in the box or on it are in the water: where the level between cells is above 1/2."""
        wet = np.zeros(len(point), dtype=np.bool_)
        if self.levels is not None:
            held = np.flatnonzero((point > -1e-6).all(axis=1) & (point < self.high + 1e-6).all(axis=1))
            cells = np.array(self.levels.shape) / (self.high - self.low)
            wet[held] = _between(self.levels, point[held] * cells) > 0.5
        return wet

    def change(self, origin: Array, direction: Array, begin: Array, end: Array) -> Array:
        """Where rays (R, 3) pass between air and water from begin to end (R,), by the levels, halved until close."""
        wet = self.in_water(origin + end[:, None] * direction)
        for _ in range(_HALVINGS):
            middle = 0.5 * (begin + end)
            beyond = self.in_water(origin + middle[:, None] * direction) == wet
            begin, end = np.where(beyond, begin, middle), np.where(beyond, middle, end)
        return end

    def colour(self, origin: Array, direction: Array) -> Array:
        """Linear light (R, 3) that comes to each origin against its unit direction."""
        seen = sky(direction)
        down = np.flatnonzero((direction[:, 2] < -1e-6) & (origin[:, 2] > self.low[2]))
        t = (self.low[2] - origin[down, 2]) / direction[down, 2]
        place = origin[down, :2] + t[:, None] * direction[down, :2]
        seen[down] = self.floor(place)
        return seen

    def floor(self, place: Array) -> Array:
        """Colours (N, 3) of the floor at places (N, 2): tiles that fade into the horizon."""
        place = (place - (self.low + self.high)[:2] / 2) / self.edge
        waves = np.sin(np.pi * _ACROSS * place)
        tile = 0.5 + 0.5 * np.tanh(_SHARP * waves[:, 0] * waves[:, 1])
        away = np.linalg.norm(place, axis=1)
        contrast = (tile - 0.5) * np.exp(-(away / _PATTERN) ** 2) + 0.5
        tiles = _mix(_TILES[0], _TILES[1], contrast)
        return _mix(tiles, _HORIZON, 1 - np.exp(-(away / _FLOOR) ** 2))


def sky(direction: Array) -> Array:
    """Linear light (N, 3) of the sky: bright at the horizon, blue above, the sun's glow on one side."""
    up = np.abs(direction[:, 2])
    glow = np.maximum(dots(direction, np.broadcast_to(_SUN_WAY, direction.shape)), 0.0)
    seen = _mix(_HORIZON, _ZENITH, up ** 0.6)
    seen += (0.5 * glow ** 24 + 4.0 * glow ** 900)[:, None] * _SUN
    return seen


def _mix(a: Array, b: Array, share: Array) -> Array:
    mixed: Array = a + share[:, None] * (b - a)
    return mixed


def _between(levels: Array, point: Array) -> Array:
    """Levels at points (N, 3), linear between the centres of cells and constant beyond the outermost."""
    last = np.array(levels.shape) - 1
    place = np.clip(point - 0.5, 0, last)
    low = np.minimum(place.astype(np.intp), np.maximum(last - 1, 0))
    share, total = place - low, np.zeros(len(point))
    for corner in np.ndindex(2, 2, 2):
        weight = np.where(corner, share, 1 - share).prod(axis=1)
        total += weight * levels[tuple(np.minimum(low + corner, last).T)]
    return total
