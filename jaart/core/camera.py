"""A camera and the rays through its pixels."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from jaart.core.errors import RayError

if TYPE_CHECKING:
    from jaart.core.kernels.pinhole import View
    from jaart.core.scene import Scene

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

#: From where a scene is seen when nobody says: from the front, to the right and above.
DEFAULT_VIEW = (0.45, -1.0, 0.55)
#: A picture has at most this many pixels along an edge.
LONGEST_EDGE = 16384
#: Rays from so far, in cells of a lattice or h of a cloud, have no precision left; the kernels call them bad.
TOO_FAR = 1e15
#: How much farther away a fitted camera stands than it must.
MARGIN = 1.03


@dataclass(frozen=True)
class Camera:
    """A pinhole camera, or an orthographic one when ortho is given.

    eye, target: in cells; up: which way is up, chosen when None (z, or y where the view runs
    along z); fov: degrees across the longer side of the picture; ortho: width of the view across the
    longer side, in cells, instead of fov.
    """

    eye: Vector
    target: Vector
    up: Vector | None = None
    fov: float = 30.0
    ortho: float | None = None

    def __post_init__(self) -> None:
        for name in ("eye", "target", "up"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, _vector(name, value))
        if self.ortho is None and not 0 < self.fov < 180:
            raise RayError(f"camera fov = {self.fov:g}: expected degrees above 0 and below 180")
        if self.ortho is not None and not (0 < self.ortho < math.inf):
            raise RayError(f"camera ortho = {self.ortho:g}: expected a width above 0")
        self.frame()

    @classmethod
    def fit(cls, scene: Scene | Vector | tuple[Array, Array], direction: Vector = DEFAULT_VIEW, fov: float = 30.0,
            size: tuple[int, int] = (1, 1)) -> Camera:
        """A camera that sees a whole scene from a direction.

        scene: a scene at the raster of its file, the size of one that begins at the origin, or its lowest and
        highest corner; direction: from the middle towards the eye; fov: degrees; size: (width, height) of the
        picture, or their ratio. A scene that is a single point is seen from 1 away.
        """
        check_size(size)
        low, high = _corners(scene)
        extent = high - low
        middle, towards = low + extent / 2, np.asarray(direction) / np.linalg.norm(direction)
        far = float(np.linalg.norm(extent)) or 1.0
        camera = cls(eye=tuple(middle + far * towards), target=tuple(middle), fov=fov)
        corners = (np.array(list(itertools.product((0, 1), repeat=3))) - 0.5) * extent
        right, up, forward = camera.frame()
        slope = math.tan(math.radians(fov) / 2) / max(size)
        sideways = np.maximum(abs(corners @ right) / (slope * size[0]), abs(corners @ up) / (slope * size[1]))
        distance = MARGIN * float(np.max(sideways - corners @ forward)) or 1.0
        return camera.replace(eye=tuple(middle + towards * distance))

    def frame(self) -> tuple[Array, Array, Array]:
        """Unit vectors (right, up, forward). Raises RayError when eye, target and up give none."""
        forward = _scaled(np.divide(self.target, 2) - np.divide(self.eye, 2))
        if not forward.any():
            raise RayError("camera: eye and target are the same point")
        forward /= np.linalg.norm(forward)
        chosen = (0.0, 1.0, 0.0) if abs(forward[2]) > 0.999 else (0.0, 0.0, 1.0)
        up = _scaled(np.array(chosen if self.up is None else self.up))
        if not up.any():
            raise RayError("camera: up has zero length")
        right = np.cross(forward, up)
        if np.linalg.norm(right) <= 1e-9 * np.linalg.norm(up):
            raise RayError("camera: up runs along the view; expected another direction")
        right /= np.linalg.norm(right)
        return right, np.cross(right, forward), forward

    def view(self, size: tuple[int, int]) -> View:
        """This camera and the (width, height) of a picture as the kernels take them."""
        from jaart.core.kernels.pinhole import View

        right, up, forward = (tuple(float(v) for v in vector) for vector in self.frame())
        across = 2 * math.tan(math.radians(self.fov) / 2) if self.ortho is None else self.ortho
        return View(self.eye, right, up, forward,  # type: ignore[arg-type]
                    across / max(size), int(self.ortho is not None), size[0], size[1])

    def rays(self, size: tuple[int, int], pixels: NDArray[np.int64] | None = None) -> tuple[Array, Array]:
        """Origins and unit directions (R, 3) of the rays through pixel centres.

        size: (width, height) of the picture; pixels: numbers x + y·width counted row by row from the
        top, all when None.
        """
        from jaart.core.kernels.pinhole import write_rays

        numbers = np.arange(size[0] * size[1]) if pixels is None else np.asarray(pixels, dtype=np.int64)
        origins, directions = np.empty((len(numbers), 3)), np.empty((len(numbers), 3))
        write_rays(self.view(size), numbers, np.arange(len(numbers)), origins, directions,
                   np.empty((0, 0)), np.empty(0))
        return origins, directions

    def replace(self, **values: object) -> Camera:
        """This camera with some values changed."""
        return dataclasses.replace(self, **values)  # type: ignore[arg-type]


def parse(assignments: Iterable[str], base: Camera) -> Camera:
    """A camera from "eye=x,y,z" texts on top of a base. Raises RayError that names the text."""
    values: dict[str, object] = {}
    for text in assignments:
        name, equals, value = text.partition("=")
        if not equals or name not in ("eye", "target", "up", "fov", "ortho"):
            raise RayError(f"--camera {text!r}: expected eye=, target=, up=x,y,z, fov=degrees or ortho=width")
        values[name] = _vector(name, value.split(",")) if name in ("eye", "target", "up") else _number(name, value)
    return base.replace(**values)


def check_size(size: tuple[int, int]) -> None:
    """Raise RayError when no picture has this (width, height)."""
    if not all(isinstance(n, int) and 1 <= n <= LONGEST_EDGE for n in size):
        raise RayError(f"size {size[0]}x{size[1]}: expected a width and a height from 1 to {LONGEST_EDGE}")


def check_distance(camera: Camera, middle: Iterable[float], unit: float) -> None:
    """Raise RayError for a camera whose rays begin so far away that they have no precision.

    middle: of the scene; unit: a cell of a lattice, h of a cloud.
    """
    far = max(abs(e / unit - float(m) / unit) for e, m in zip(camera.eye, middle, strict=True))
    for name, distance in (("eye", far), ("ortho", (camera.ortho or 0.0) / unit)):
        if not distance < TOO_FAR:
            value = f"{camera.ortho:g}" if name == "ortho" else ",".join(f"{v:g}" for v in camera.eye)
            raise RayError(f"camera {name} = {value}: rays from so far have no precision; expected less than "
                           f"{TOO_FAR * unit:g} from the scene")


def _scaled(vector: Array) -> Array:
    """A vector times a power of 2, about 1 long: its square neither overflows nor vanishes."""
    return np.ldexp(vector, -math.frexp(float(np.abs(vector).max()))[1])


def _corners(scene: Scene | Vector | tuple[Array, Array]) -> tuple[Array, Array]:
    """Lowest and highest corner of a scene, of a size, or as they are."""
    if not isinstance(scene, tuple):
        from jaart.core.extents import bounds
        from jaart.core.settings import Settings

        return bounds(scene, Settings())
    if len(scene) == 2:
        return np.asarray(scene[0], dtype=np.float64), np.asarray(scene[1], dtype=np.float64)
    return np.zeros(3), np.asarray(scene, dtype=np.float64)


def _number(name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise RayError(f"camera {name} = {text!r}: expected a finite number")
    return value


def _vector(name: str, values: Iterable[object]) -> Vector:
    numbers = [_number(name, str(v)) for v in values]
    if len(numbers) != 3:
        raise RayError(f"camera {name}: expected three numbers x,y,z")
    return numbers[0], numbers[1], numbers[2]
