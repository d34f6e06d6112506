"""Colours of pictures: a perceptual table for numbers, one colour for each state, backgrounds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Colour = tuple[int, int, int]

#: Every fifth colour of viridis (by S. van der Walt and N. Smith, public domain CC0), as hexadecimal RGB.
_VIRIDIS = (
    "440154 46085c 471063 481769 481d6f 482475 472a7a 46307e 453781 433d84 414287 3f4889 3d4e8a "
    "3a538b 38598c 355e8d 33638d 31688e 2e6d8e 2c718e 2a768e 297b8e 27808e 25848e 23898e 218e8d "
    "20928c 1f978b 1e9c89 1fa188 21a585 24aa83 28ae80 2eb37c 35b779 3dbc74 46c06f 50c46a 5ac864 "
   "65cb5e 70cf57 7cd250 89d548 95d840 a2da37 b0dd2f bddf26 cae11f d8e219 e5e419 f1e51d fde725"
)


def _interpolated(anchors: str, count: int = 256) -> Bytes:
    """A table (count, 3) of colours between evenly spaced anchors."""
    known = np.array([list(bytes.fromhex(word)) for word in anchors.split()], dtype=np.float64)
    at = np.linspace(0, len(known) - 1, count)
    table = np.stack([np.interp(at, np.arange(len(known)), known[:, k]) for k in range(3)], axis=1)
    return np.rint(table).astype(np.uint8)


#: Colours (256, 3) of numbers from low to high: dark violet, green, yellow.
TABLE = _interpolated(_VIRIDIS)
TABLE.flags.writeable = False

#: What is behind the scene, by theme.
BACKGROUND: dict[str, Colour] = {"light": (237, 240, 245), "dark": (31, 33, 38)}

#: A hit that has no value in a map, as the distance error of a false hit.
NO_VALUE: Colour = (150, 150, 150)

#: Ends of a ray, by name; background takes the theme's. Okabe and Ito's colours, then shades of them.
COLOURS: dict[str, Colour] = {
    "converged": (86, 180, 233), "background": (200, 204, 210), "cap": (213, 94, 0),
    "left_trust": (230, 159, 0), "parallel": (240, 228, 66), "few_neighbours": (204, 121, 167),
    "undefined_normal": (117, 57, 140), "bounded": (0, 158, 115), "floor": (0, 114, 178),
    "undecided": (120, 72, 40), "bad_ray": (220, 20, 60),
    # what else is refused: greens beside that of bounded
    "bounded_weight": (0, 92, 66), "bounded_nearest": (86, 198, 164), "bounded_angle": (122, 168, 32),
    "bounded_gap": (168, 220, 190)}


def coloured(values: NDArray[np.float64], low: float, high: float) -> Bytes:
    """Colours (N, 3) of finite numbers (N,), low and below the first, high and above the last."""
    span = high - low if high > low else 1.0
    at = np.clip((values - low) * (256.0 / span), 0, 255)
    return TABLE[at.astype(np.uint8)]
