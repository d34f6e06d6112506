"""From hits to a picture: shaded by lights, seen through water, or a number of each ray in false colour."""

from __future__ import annotations

from threading import Event

import numpy as np
from numpy.typing import NDArray

from jaart.core.colours import BACKGROUND, COLOURS, NO_VALUE, TABLE, Bytes, coloured
from jaart.core.environment import Environment
from jaart.core.errors import SettingsError
from jaart.core.lights import lights, shadows_wanted
from jaart.core.maps import MAPS, Map, find, scale
from jaart.core.memory import pieces
from jaart.core.phong import blue, phong
from jaart.core.records import STATUS_NAMES, Hits, Quality
from jaart.core.scene import Scene
from jaart.core.secondary import Tracer, tracer
from jaart.core.settings import Settings
from jaart.core.visible import of_hits
from jaart.core.water import water

__all__ = ["BACKGROUND", "COLOURS", "MAPS", "NO_VALUE", "TABLE", "Map", "needs_scene", "scale", "shade"]

Array = NDArray[np.float64]

#: So many hits are shaded at once where that takes no rays: what is computed on the way stays in the fast memory.
AT_ONCE = 1 << 15

#: Linear light in 4096 steps to the bytes of sRGB.
_LIGHT = np.linspace(0.0, 1.0, 4096)
_SRGB = np.rint(255 * np.where(_LIGHT <= 0.0031308, 12.92 * _LIGHT,
                               1.055 * _LIGHT ** (1 / 2.4) - 0.055)).astype(np.uint8)


def shade(hits: Hits, map: str = "shaded", quality: Quality | None = None, theme: str = "light",
          settings: Settings | None = None, scene: Scene | None = None, threads: int | None = None,
          cancel: Event | None = None) -> Bytes:
    """A picture (h, w, 3) of hits; rays that are no picture give one row.

    map: a name of MAPS; quality: for the error maps; theme: light or dark background; settings: how
    to shade, those of the hits when None; scene: that of the hits, where `needs_scene` says so: then rays are
    traced as the hits were, by so many threads, until cancel is set. Raises SettingsError for a name that does
    not exist and for a scene that is missing, Cancelled after cancel was set.
    """
    find(map)
    if theme not in BACKGROUND:
        raise SettingsError(f"no theme is called {theme!r}; there are {', '.join(BACKGROUND)}")
    settings = settings or hits.settings
    colours = np.frombuffer(bytearray(bytes(BACKGROUND[theme]) * len(hits)), np.uint8).reshape(-1, 3)
    if map == "shaded":
        _shaded(colours, hits, settings, scene, _tracer(hits, settings, scene, threads, cancel))
    elif map == "status":
        colours[:] = _states(theme)[hits.status]
    else:
        _false_colours(colours, hits, map, quality)
    width, height = hits.size or (len(hits), 1)
    return colours.reshape(height, width, 3)


def needs_scene(settings: Settings) -> bool:
    """Whether the shaded picture takes more rays: behind the surface of water, or from it to lights."""
    return settings.shading == "water" or shadows_wanted(settings)


def _tracer(hits: Hits, settings: Settings, scene: Scene | None, threads: int | None,
            cancel: Event | None) -> Tracer | None:
    if not needs_scene(settings):
        return None
    if scene is None:
        why = "shading = water" if settings.shading == "water" else "shadows = true"
        raise SettingsError(f"{why}: needs rays from the surface on; expected the scene of the hits")
    return tracer(scene, of_hits(scene, hits), threads, cancel)


def _shaded(colours: Bytes, hits: Hits, settings: Settings, scene: Scene | None, rays: Tracer | None) -> None:
    if settings.shading == "water":
        assert scene is not None and rays is not None
        colours[:] = _bytes(water(hits, settings, Environment.of(scene, hits.settings), rays).colour)
        return
    at = np.flatnonzero(hits.hit)
    for some in pieces(len(at), AT_ONCE if rays is None else len(at)):
        colours[at[some]] = _lit(hits, at[some], settings, rays)


def _lit(hits: Hits, at: NDArray[np.intp], settings: Settings, rays: Tracer | None) -> Bytes:
    """The colours (N, 3) of some hits."""
    point, normal, view = (column.take(at, axis=0) for column in (hits.point, hits.normal, hits.direction))
    view = -view
    seen = lights(settings, point, normal, view, tracer=rays)
    if settings.shading == "diffuse":
        plain: Bytes = np.rint(255 * blue(seen, normal)).astype(np.uint8)
        return plain
    return _bytes(phong(seen, normal, view, settings))


def _bytes(light: Array) -> Bytes:
    """Linear light (N, 3) as sRGB, what is brighter than white as white."""
    srgb: Bytes = _SRGB.take((light * (len(_SRGB) - 1)).astype(np.intp), mode="clip")
    return srgb


def _states(theme: str) -> Bytes:
    named = {**COLOURS, "background": BACKGROUND[theme]}
    return np.array([named[name] for name in STATUS_NAMES], np.uint8)


def _false_colours(colours: Bytes, hits: Hits, name: str, quality: Quality | None) -> None:
    values = MAPS[name].values(hits, quality)
    known = np.isfinite(values)
    colours[hits.hit & ~known] = NO_VALUE
    colours[known] = coloured(values[known], *scale(name, hits, quality))
