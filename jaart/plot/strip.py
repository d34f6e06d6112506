"""The strip of cells below the energies: hatched boxes, drawn as a few paths; matplotlib renders a pattern for each."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.path import Path
from matplotlib.transforms import Bbox, IdentityTransform
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: From one stroke of a hatching to the next along the strip [points].
_GAP = 5.8


class Strip(Artist):
    """Boxes from x to x (N, 2), hatched to one side and the other in turn, along the lower edge of an axes.

    falling: (N,) which of them are hatched downwards; height: share of the axes; ground, edge: colours;
    frame, stroke: widths of lines in points.
    """

    def __init__(self, ways: Array, falling: NDArray[np.bool_], height: float, ground: str, edge: str, frame: float,
                 stroke: float) -> None:
        super().__init__()
        self.set_zorder(2)
        self.set_in_layout(False)
        self.ways, self.falling, self.height = ways, falling, height
        self.ground, self.edge, self.frame, self.stroke = ground, edge, frame, stroke

    def draw(self, renderer: Any) -> None:
        """Draw the boxes that are in view."""
        box = self.axes.bbox
        points = np.column_stack([self.ways.ravel(), np.zeros(self.ways.size)])
        ends = self.axes.transData.transform(points)[:, 0].reshape(-1, 2)
        seen = (ends[:, 1] > box.x0) & (ends[:, 0] < box.x1)
        if seen.any() and self.get_visible():
            ends, top = np.clip(ends[seen], box.x0 - 50, box.x1 + 50), box.y0 + self.height * box.height
            gap = renderer.points_to_pixels(_GAP)
            frames, strokes = _frames(ends, box.y0, top), _strokes(ends, self.falling[seen], box.y0, top, gap)
            self._draw_lines(renderer, frames, 0.0, self.ground)
            self._draw_lines(renderer, strokes, self.stroke)
            self._draw_lines(renderer, frames, self.frame)
        self.stale = False

    def get_window_extent(self, renderer: Any = None) -> Bbox:
        """The part of the axes that it fills [pixels]."""
        box = self.axes.bbox
        return Bbox.from_bounds(box.x0, box.y0, box.width, self.height * box.height)

    def _draw_lines(self, renderer: Any, path: Path, width: float, ground: str | None = None) -> None:
        gc = renderer.new_gc()
        gc.set_clip_rectangle(self.axes.bbox)
        gc.set_foreground(self.edge)
        gc.set_linewidth(width)
        gc.set_capstyle("butt")
        gc.set_joinstyle("miter")
        filled = None if ground is None else (*_rgb(ground), 1.0)
        renderer.draw_path(gc, path, IdentityTransform(), filled)
        gc.restore()


def _frames(ends: Array, low: float, high: float) -> Path:
    """The outlines of boxes."""
    x = ends[:, (0, 1, 1, 0, 0)]
    points = np.stack([x, np.broadcast_to((low, low, high, high, low), x.shape)], axis=2).reshape(-1, 2)
    codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]
    return Path(points, codes * len(ends))


def _strokes(ends: Array, falling: NDArray[np.bool_], low: float, high: float, gap: float) -> Path:
    """Lines at 45° across boxes, cut off at their sides."""
    tall = high - low
    begins = [np.arange(left - tall + gap / 2, right, gap) for left, right in ends]
    of = np.repeat(np.arange(len(ends)), [len(some) for some in begins])
    begin = np.concatenate(begins)
    first = np.maximum(ends[of, 0] - begin, 0.0)
    last = np.minimum(ends[of, 1] - begin, tall)
    up = np.stack([first, last], axis=1)
    y = np.where(falling[of, None], high - up, low + up)
    points = np.stack([begin[:, None] + up, y], axis=2)[last > first].reshape(-1, 2)
    return Path(points, [Path.MOVETO, Path.LINETO] * (len(points) // 2))


def _rgb(colour: str) -> tuple[float, float, float]:
    from matplotlib.colors import to_rgb

    return to_rgb(colour)
