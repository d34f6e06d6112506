"""The light models of an opaque surface: Phong's, and the plain blue one [T §2.1.2]."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from jaart.core.lights import Light
from jaart.core.optics import dots
from jaart.core.settings import Settings

Array = NDArray[np.float64]

#: Water in linear light; with the default coefficients and full light no part exceeds 1.
WATER = np.array((0.045, 0.27, 0.60))


def phong(lights: Iterable[Light], normal: Array, view: Array, settings: Settings) -> Array:
    """k_a I_a + Σ (k_d <l, n> I_d + k_s <r, v>^α I_s), linear light (N, 3) [T 2.4].

    I_a and I_d are water's colour, I_s is white. lights: each adds its part where it stands on the viewer's
    side; normal: (N, 3) of either side; view: unit vectors to the viewer (N, 3).
    """
    facing = dots(normal, view)
    water = np.full(len(normal), settings.ambient)
    white = np.zeros(len(normal))
    for light in lights:
        towards = dots(normal, light.towards) * np.copysign(1.0, facing)
        mirrored = 2 * towards * np.abs(facing) - dots(light.towards, view)
        water += light.share * settings.diffuse * np.maximum(towards, 0.0)
        highlight = np.where(towards > 0, np.clip(mirrored, 0.0, 1.0), 0.0) ** settings.shininess
        white += light.share * settings.specular * highlight
    light_seen = np.empty((3, len(normal)))
    for part, own in zip(light_seen, WATER, strict=True):
        part[:] = water * own + white
    return light_seen.T


def blue(lights: Iterable[Light], normal: Array) -> Array:
    """(0, 0, Σ |<l, n>|), the simplified model [T §2.1.2], as parts of full colours (N, 3), no linear light."""
    colours = np.zeros(normal.shape)
    for light in lights:
        colours[:, 2] += light.share * np.abs(dots(normal, light.towards))
    return np.minimum(colours, 1.0)
