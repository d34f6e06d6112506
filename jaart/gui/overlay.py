"""What is drawn over the picture: the picked pixel, the scale of a map, and the lens with a pixel's numbers."""

from __future__ import annotations

import functools
import math

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QFontMetrics, QImage, QPainter, QPen

from jaart.core.colours import BACKGROUND, COLOURS, TABLE
from jaart.core.maps import MAPS, scale, unit
from jaart.core.records import STATUS_NAMES, Hits, Quality
from jaart.gui import theme as look
from jaart.plot.style import OUTCOMES

#: Width of the colour bar and of its column [pixels].
BAR, COLUMN = 14, 92
RIGHT = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight


def draw_mark(painter: QPainter, at: QPointF, theme: str) -> None:
    """A ring and a cross around the picked pixel, readable on any ground."""
    for colour, width in ((look.colour(theme, "base"), 4.0), (QColor("#d55e00"), 1.8)):
        painter.setPen(QPen(colour, width))
        painter.drawEllipse(at, 9, 9)
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            painter.drawLine(at + QPointF(6 * dx, 6 * dy), at + QPointF(15 * dx, 15 * dy))


def draw_scale(painter: QPainter, area: QRect, name: str, hits: Hits, quality: Quality | None, theme: str,
               kind: str = "lattice") -> None:
    """The colours of a map at the right edge of an area: a bar with units, or a legend of the states.

    kind: of the scene.
    """
    if name == "status":
        _draw_states(painter, area, hits, theme)
    elif name != "shaded":
        _draw_bar(painter, area, (MAPS[name].label, unit(name, kind)), _limits(name, hits, quality), theme)


@functools.lru_cache(maxsize=1)
def _limits(name: str, hits: Hits, quality: Quality | None) -> tuple[float, float]:
    """The limits of a map's scale, found once for a picture: it is painted whenever the mouse moves."""
    return scale(name, hits, quality)


@functools.lru_cache(maxsize=1)
def _counts(hits: Hits) -> dict[str, int]:
    return hits.counts()


def _draw_bar(painter: QPainter, area: QRect, name: tuple[str, str], limits: tuple[float, float], theme: str) -> None:
    (label, of), (low, high) = name, limits
    left, top, height = area.right() - COLUMN + 20, area.top() + 48, max(60, area.height() - 72)
    colours = np.ascontiguousarray(TABLE[::-1])[:, None, :].copy()
    strip = QImage(colours.data, 1, len(TABLE), 3, QImage.Format.Format_RGB888)
    painter.drawImage(QRect(left, top, BAR, height), strip)
    painter.setPen(look.colour(theme, "edge"))
    painter.drawRect(left, top, BAR, height)
    painter.setPen(look.colour(theme, "text"))
    for value in ticks(low, high):
        y = round(top + height * (high - value) / (high - low))
        painter.drawLine(left + BAR, y, left + BAR + 3, y)
        painter.drawText(QRect(left + BAR + 7, y - 8, 60, 16), Qt.AlignmentFlag.AlignVCenter, f"{value:g}")
    text = f"{label} [{of}]" if of else label
    painter.drawText(QRect(area.right() - 330, area.top() + 12, 320, 20), RIGHT, text)


def _draw_states(painter: QPainter, area: QRect, hits: Hits, theme: str) -> None:
    width, y = 224, area.top() + 12
    for name, count in _counts(hits).items():
        rgb = BACKGROUND[theme] if name == "background" else COLOURS[name]
        painter.setPen(look.colour(theme, "weak"))
        painter.setBrush(QColor(*rgb))
        painter.drawRect(area.right() - width, y + 2, 12, 12)
        painter.setPen(look.colour(theme, "text"))
        painter.drawText(QRect(area.right() - width + 20, y, width - 28, 16), Qt.AlignmentFlag.AlignVCenter,
                         OUTCOMES[name])
        share = f"{100 * count / len(hits):.2f} %"
        painter.drawText(QRect(area.right() - 66, y, 56, 16), RIGHT, share)
        y += 20


def draw_lens(painter: QPainter, corner: QPointF, image: QImage, pixel: tuple[int, int],
              rows: list[tuple[str, str]], theme: str) -> None:
    """A card with the pixel's surroundings enlarged and its numbers."""
    metrics = QFontMetrics(painter.font())
    line, first = metrics.height() + 2, max(metrics.horizontalAdvance(name) for name, _ in rows) + 14
    second = max(metrics.horizontalAdvance(text) for _, text in rows)
    card = QRectF(corner.x(), corner.y(), 104 + first + second, max(98, 14 + line * len(rows)))
    painter.setPen(QPen(look.colour(theme, "edge"), 1))
    ground = look.colour(theme, "base")
    ground.setAlpha(235)
    painter.setBrush(ground)
    painter.drawRoundedRect(card, 4, 4)
    _draw_patch(painter, QRectF(card.left() + 8, card.top() + 8, 81, 81), image, pixel)
    for number, (name, text) in enumerate(rows):
        y = card.top() + 7 + number * line
        painter.setPen(look.colour(theme, "weak"))
        painter.drawText(QRectF(card.left() + 98, y, first, line), Qt.AlignmentFlag.AlignVCenter, name)
        painter.setPen(look.colour(theme, "text"))
        painter.drawText(QRectF(card.left() + 98 + first, y, second + 4, line), Qt.AlignmentFlag.AlignVCenter, text)


def _draw_patch(painter: QPainter, box: QRectF, image: QImage, pixel: tuple[int, int]) -> None:
    x, y = pixel
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, False)
    painter.drawImage(box, image, QRectF(x - 4, y - 4, 9, 9))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(QColor("#d55e00"), 1.5))
    cell = box.width() / 9
    painter.drawRect(QRectF(box.left() + 4 * cell, box.top() + 4 * cell, cell, cell))


def numbers(hits: Hits, quality: Quality | None, x: int, y: int, kind: str = "lattice",
            sided: bool = False) -> list[tuple[str, str]]:
    """Name and text of each number of a pixel (x, y) of the picture.

    kind: of the scene; sided: whether normals point outwards, so that a hit may be one from behind.
    """
    assert hits.size is not None
    at, of = x + y * hits.size[0], "units" if kind == "cloud" else "cells"
    behind = ", from behind" if sided and hits.hit[at] and hits.normal[at] @ hits.direction[at] > 0 else ""
    rows = [("Pixel", f"{x}, {y}"), ("Ray", OUTCOMES[STATUS_NAMES[hits.status[at]]] + behind)]
    if hits.hit[at]:
        normal = ", ".join(f"{n:+.3f}" for n in hits.normal[at])
        rows += [("Depth t", f"{fixed(hits.t[at])} {of}"), ("Normal", normal),
                 ("Off-centre", f"{fixed(hits.off_centre[at])} {of}")]
    if hits.evaluations[at]:
        rows += [("Iterations", f"{hits.iterations[at]} of {hits.evaluations[at]} in all")]
    if quality is not None and math.isfinite(quality.distance[at]):
        apart = unit("distance_error", kind)
        rows += [("Error", f"{fixed(quality.distance[at])} {apart}, {quality.angle[at]:.2f}°")]
    return rows


def fixed(length: float) -> str:
    """A length to four places, or to four digits where it is small."""
    return f"{length:.4f}" if abs(length) >= 0.01 or length == 0 else f"{length:.4g}"


def ticks(low: float, high: float) -> list[float]:
    """Round values between the limits of a scale, four to nine of them."""
    span = high - low
    power = 10.0 ** math.floor(math.log10(span / 4))
    step = max(s * power for s in (1, 2, 5) if s * power <= span / 4 * (1 + 1e-9))
    return [round(step * k, 12) for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]
