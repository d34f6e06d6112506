"""From hits to a picture: shaded by a light, or a number of each ray in false colour."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from jaart.core.colours import BACKGROUND, COLOURS, NO_VALUE, TABLE, Bytes, coloured
from jaart.core.errors import SettingsError
from jaart.core.maps import MAPS, Map, find, scale
from jaart.core.records import STATUS_NAMES, Hits, Quality
from jaart.core.settings import Settings

__all__ = ["BACKGROUND", "COLOURS", "MAPS", "NO_VALUE", "TABLE", "Map", "scale", "shade"]

Array = NDArray[np.float64]

#: Water in linear light; with the default coefficients and full light no part exceeds 1.
_WATER = np.array((0.045, 0.27, 0.60))
#: Linear light in 4096 steps to the bytes of sRGB.
_LIGHT = np.linspace(0.0, 1.0, 4096)
_SRGB = np.rint(255 * np.where(_LIGHT <= 0.0031308, 12.92 * _LIGHT,
                               1.055 * _LIGHT ** (1 / 2.4) - 0.055)).astype(np.uint8)


def shade(hits: Hits, map: str = "shaded", quality: Quality | None = None, theme: str = "light",
          settings: Settings | None = None) -> Bytes:
    """A picture (h, w, 3) of hits; rays that are no picture give one row.

    map: a name of MAPS; quality: for the error maps; theme: light or dark background; settings: how
    to shade, those of the hits when None. Raises SettingsError for a name that does not exist.
    """
    find(map)
    if theme not in BACKGROUND:
        raise SettingsError(f"no theme is called {theme!r}; there are {', '.join(BACKGROUND)}")
    colours = np.empty((len(hits), 3), np.uint8)
    colours[:] = BACKGROUND[theme]
    if map == "shaded":
        at = np.flatnonzero(hits.hit)
        colours[at] = _lit(hits, at, settings or hits.settings)
    elif map == "status":
        colours[:] = _states(theme)[hits.status]
    else:
        _false_colours(colours, hits, map, quality)
    width, height = hits.size or (len(hits), 1)
    return colours.reshape(height, width, 3)


def _states(theme: str) -> Bytes:
    named = {**COLOURS, "background": BACKGROUND[theme]}
    return np.array([named[name] for name in STATUS_NAMES], np.uint8)


def _false_colours(colours: Bytes, hits: Hits, name: str, quality: Quality | None) -> None:
    values = MAPS[name].values(hits, quality)
    known = np.isfinite(values)
    colours[hits.hit & ~known] = NO_VALUE
    colours[known] = coloured(values[known], *scale(name, hits, quality))


def _lit(hits: Hits, at: NDArray[np.intp], settings: Settings) -> Bytes:
    normal, view = hits.normal[at], -hits.direction[at]
    facing = _dots(normal, view)
    if settings.light == "headlight":
        towards, to_light = np.abs(facing), np.ones(len(at))
    else:
        light = _units(np.asarray(settings.light) - hits.point[at])
        towards, to_light = _dots(normal, light) * np.copysign(1.0, facing), _dots(light, view)
    if settings.shading == "diffuse":
        return _blue(towards)
    return _phong(towards, 2 * towards * np.abs(facing) - to_light, settings)


def _blue(towards: Array) -> Bytes:
    """(0, 0, |<l, n>|), the simplified model [T §2.1.2]."""
    colours = np.zeros((len(towards), 3), np.uint8)
    colours[:, 2] = np.rint(255 * np.minimum(np.abs(towards), 1.0))
    return colours


def _phong(towards: Array, mirrored: Array, settings: Settings) -> Bytes:
    """k_a I_a + k_d <l, n> I_d + k_s <r, v>^α I_s with water's colour and white highlights [T 2.4].

    towards: <l, n>, n turned to the viewer; mirrored: <r, v>, r the mirrored light. Both count where
    the light stands on the viewer's side only.
    """
    water = settings.ambient + settings.diffuse * np.maximum(towards, 0.0)
    white = settings.specular * np.where(towards > 0, np.clip(mirrored, 0.0, 1.0), 0.0) ** settings.shininess
    colours = np.empty((len(towards), 3), np.uint8)
    for channel, share in enumerate(_WATER):
        light = np.minimum(share * water + white, 1.0)
        colours[:, channel] = _SRGB[(light * (len(_SRGB) - 1)).astype(np.intp)]
    return colours


def _dots(a: Array, b: Array) -> Array:
    dots: Array = np.einsum("ij,ij->i", a, b)
    return dots


def _units(vectors: Array) -> Array:
    lengths = np.sqrt(_dots(vectors, vectors))[:, None]
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0)
