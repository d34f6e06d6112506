"""Rows 64 and 65: pictures and cameras that cannot be."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from jaart.core.camera import Camera, parse
from jaart.core.records import Hits
from jaart.core.render import render
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case, counted, error_of, largest, refused
from jaart.core.study.stability.scenes import plane

#: Straight above the plane of the scenes.
ABOVE = Camera((0.0, 0.0, 9.0), (0.0, 0.0, 0.0))


@case(64, "pictures of 0×8, 8×-1, 8×100000 and 1×1 pixels; fields of view of 0, 180, -30 and NaN degrees",
      "errors that name the option, and a picture of one pixel")
def pictures_and_views_without_a_size() -> Outcome:
    """The ray of a single pixel is the camera's own."""
    sizes = [_said(partial(_picture, size), f"size {size[0]}x{size[1]}") for size in ((0, 8), (8, -1), (8, 100_000))]
    views = [_said(partial(ABOVE.replace, fov=fov), "fov") for fov in (0.0, 180.0, -30.0, float("nan"))]
    typed = [_said(partial(parse, [f"fov={fov}"], ABOVE), "fov") for fov in ("0", "180", "nan", "wide")]
    one = _picture((1, 1))
    met = one.counts() == {"converged": 1} and bool(one.t[0] == 9.0)
    return Outcome(f"{sum(sizes)} of 3 sizes, {sum(views)} of 4 angles and {sum(typed)} of 4 typed ones refused; 1×1: "
                   f"{counted(one.counts())} at t = {one.t[0]:g}", all((*sizes, *views, *typed, met)))


@case(65, "up along the view, given and not given; eye and target the same",
      "an error that says so; without an up one is chosen, and no direction is NaN")
def up_along_the_view() -> Outcome:
    """An up a little aside is taken: it has a direction across the view."""
    given = refused(partial(ABOVE.replace, up=(0.0, 0.0, -3.0)), "camera: up runs along the view")
    same = refused(partial(ABOVE.replace, target=ABOVE.eye), "camera: eye and target are the same point")
    beside = [ABOVE.replace(up=(1e-6, 0.0, 1.0)), *(ABOVE.replace(eye=eye) for eye in 9 * np.eye(3))]
    off = largest([np.abs(np.array(camera.frame()) @ np.array(camera.frame()).T - np.eye(3)) for camera in beside])
    return Outcome(f"{given.got}; {same.got}; chosen: {len(beside)} frames, off orthonormal by up to {off:.1e}",
                   given.holds and same.holds and off <= 1e-15)


def _picture(size: tuple[int, int]) -> Hits:
    return render(plane(), Settings(), ABOVE, size)


def _said(call: Callable[[], object], word: str) -> bool:
    """Whether a call ends in an error that begins with where it is."""
    return word in error_of(call)
