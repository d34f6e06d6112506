"""What becomes of results in the window when something else changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from jaart.core.records import Hits, Trace
from jaart.core.settings import Settings

#: While the camera is dragged, pictures are made smaller until one takes about this long [s].
DRAG_SECONDS = 0.03


def first_of_last_start(trace: Trace) -> int:
    """The first step of the start that ended the ray, 0 without steps."""
    return int(np.argmax(trace.start == trace.start[-1])) if trace.steps else 0


def with_settings(hits: Hits, settings: Settings) -> Hits:
    """The same hits with other shading, when only that differs."""
    if hits.settings == settings or hits.settings.key("rays") != settings.key("rays"):
        return hits
    return replace(hits, settings=settings)


def smaller(hits: Hits | None, size: tuple[int, int]) -> tuple[int, int]:
    """The size of a picture while the camera is dragged, by how long the last took: a half, a quarter or an eighth."""
    whole = 0.0 if hits is None else hits.ray_s / len(hits) * size[0] * size[1]
    factor = next((f for f in (1, 2, 4) if whole / f**2 <= DRAG_SECONDS), 8)
    return -(-size[0] // factor), -(-size[1] // factor)


def moved(pixel: tuple[int, int], old: tuple[int, int], new: tuple[int, int]) -> tuple[int, int]:
    """A pixel of a picture at the same place in one of another size."""
    return pixel[0] * new[0] // old[0], pixel[1] * new[1] // old[1]
