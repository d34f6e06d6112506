"""The edges of an axes with their numbers and names, in a tenth of the time of matplotlib's own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.path import Path
from matplotlib.transforms import Bbox, IdentityTransform

from jaart.plot.lettering import Look, measure, put

if TYPE_CHECKING:
    from matplotlib.axis import Axis

#: Length of ticks, from them to numbers, height of a digit as a share of the size of letters [points].
_TICK, _PAD, _DIGIT = 3.0, 2.0, 0.73


class Ruler(Artist):
    """Draws the lower and left edge of its axes, which is otherwise off: limits and names are those of the axes.

    edge, number, name: colours; small, large: sizes of numbers and names in points.
    """

    def __init__(self, edge: str, number: str, name: str, small: float, large: float) -> None:
        super().__init__()
        self.set_zorder(2.5)
        self.set_clip_on(False)
        self.edge, self.number, self.name, self.small, self.large = edge, number, name, small, large

    def draw(self, renderer: Any) -> None:
        """Draw the edges, ticks, numbers and names."""
        gc = renderer.new_gc()
        gc.set_snap(True)
        self._draw_lines(renderer, gc)
        gc.restore()
        for look, x, y in self._texts():
            put(renderer, look, x, y)
        self.stale = False

    def get_window_extent(self, renderer: Any = None) -> Bbox:
        """The box around the axes and what stands at its edges [pixels]."""
        boxes = [self.axes.bbox]
        for look, x, y in self._texts():
            width, height, depth = measure(look, self._dpi())
            boxes.append(Bbox.from_bounds(x - height + depth, y, height, width) if look.upright else
                         Bbox.from_bounds(x, y - depth, width, height))
        return Bbox.union(boxes)

    def _draw_lines(self, renderer: Any, gc: Any) -> None:
        box, length = self.axes.bbox, self._pixels(_TICK)
        ends = [[(at, box.y0), (at, box.y0 - length)] for at, _ in self._ticks(self.axes.xaxis)]
        ends += [[(box.x0, at), (box.x0 - length, at)] for at, _ in self._ticks(self.axes.yaxis)]
        edges = [[(box.x0, box.y1), (box.x0, box.y0)], [(box.x0, box.y0), (box.x1, box.y0)]]
        for lines, colour, width in ((ends, self.number, 0.7), (edges, self.edge, 0.8)):
            if lines:
                points = np.array(lines).reshape(-1, 2)
                gc.set_foreground(colour)
                gc.set_linewidth(renderer.points_to_pixels(width))
                renderer.draw_path(gc, Path(points, [Path.MOVETO, Path.LINETO] * (len(points) // 2)),
                                   IdentityTransform())

    def _texts(self) -> Iterator[tuple[Look, float, float]]:
        """Each text with the place of its first letter: numbers, powers of ten that they share, names."""
        box, gap, digit = self.axes.bbox, self._pixels(_TICK + _PAD), self._pixels(_DIGIT * self.small)
        widest = 0.0
        for at, text in self._ticks(self.axes.xaxis):
            look = Look(text, self.small, self.number)
            yield look, at - measure(look, self._dpi())[0] / 2, box.y0 - gap - digit
        for at, text in self._ticks(self.axes.yaxis):
            look = Look(text, self.small, self.number)
            width = measure(look, self._dpi())[0]
            widest = max(widest, width)
            yield look, box.x0 - gap - width, at - digit / 2
        below = box.y0 - gap - digit - self._pixels(_PAD + self.large)
        yield from self._shared(below)
        name = Look(self.axes.get_xlabel(), self.large, self.name)
        yield name, (box.x0 + box.x1 - measure(name, self._dpi())[0]) / 2, below
        name = Look(self.axes.get_ylabel(), self.large, self.name, upright=True)
        length = measure(name, self._dpi())[0]
        yield name, box.x0 - gap - widest - self._pixels(2 * _PAD), (box.y0 + box.y1 - length) / 2

    def _shared(self, below: float) -> Iterator[tuple[Look, float, float]]:
        """What the numbers of an edge leave out, as 1e6."""
        box = self.axes.bbox
        x, y = (Look(axis.get_major_formatter().get_offset(), self.small, self.number)
                for axis in (self.axes.xaxis, self.axes.yaxis))
        if x.text:
            yield x, box.x1 - measure(x, self._dpi())[0], below
        if y.text:
            yield y, box.x0 + self._pixels(_PAD), box.y1 - self._pixels(self.small)

    def _ticks(self, axis: Axis) -> list[tuple[float, str]]:
        """Where the numbers of an edge stand [pixels], and their texts."""
        low, high = sorted(axis.get_view_interval())
        values = np.asarray(axis.get_majorticklocs())
        values = values[(values >= low) & (values <= high)]
        across = axis is self.axes.xaxis
        points = np.zeros((len(values), 2))
        points[:, 0 if across else 1] = values
        at = self.axes.transData.transform(points)[:, 0 if across else 1] if len(values) else ()
        return list(zip(at, axis.get_major_formatter().format_ticks(values), strict=True))

    def _pixels(self, points: float) -> float:
        return points * self._dpi() / 72

    def _dpi(self) -> float:
        return float(self.axes.figure.dpi)
