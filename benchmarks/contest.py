"""What contestants are: programs that make a picture of a scene, from its data to the hits of all rays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from typing import Protocol

import numpy as np

import jaart
from jaart.core.records import STATUS, Array, Hits
from jaart.core.tiles import columns_for

#: Width and height of a picture.
Size = tuple[int, int]


@dataclass(frozen=True)
class View:
    """The rays of a picture. settings: what the scene's exact surface depends on, a model's raster."""

    camera: jaart.Camera
    size: Size
    settings: jaart.Settings

    @cached_property
    def blank(self) -> Hits:
        """The rays, none of which hits."""
        origins, directions = self.camera.rays(self.size)
        columns = columns_for(len(origins))._asdict()
        columns["status"][:] = STATUS["background"]
        return Hits(origin=origins, direction=directions, **columns, settings=self.settings, camera=self.camera,
                    size=self.size)

    @cached_property
    def floats(self) -> np.ndarray:
        """Origins and directions (R, 6) in single precision, as meshes are met."""
        return np.concatenate((self.blank.origin, self.blank.direction), axis=1, dtype=np.float32, casting="same_kind")

    def hits(self, t: Array, normal: Array, seconds: float) -> Hits:
        """Hits of another program: t (R,), infinite for none, and normals (R, 3)."""
        met = np.isfinite(t)
        t, normal = np.where(met, t, np.nan), np.where(met[:, None], normal, np.nan)
        status = np.where(met, STATUS["converged"], STATUS["background"]).astype(np.uint8)
        point = self.blank.origin + t[:, None] * self.blank.direction
        return replace(self.blank, t=t, normal=normal, point=point, status=status, ray_s=seconds)


@dataclass(frozen=True)
class First:
    """The first picture of a scene.

    prep_s: from loaded data to before the first ray; bvh_s: of it, the tree that rays descend; shoot: the hits of a
    view with what is prepared; note: what a reader should know.
    """

    hits: Hits
    prep_s: float
    shoot: Callable[[View], Hits]
    bvh_s: float | None = None
    note: str = ""

    @property
    def picture_s(self) -> float:
        return self.prep_s + self.hits.ray_s


class Contestant(Protocol):
    """A program. lazy: it prepares for the rays that come, so that each picture has a first of its own."""

    name: str
    lazy: bool

    def first(self, view: View) -> First:
        """The first picture, from loaded data."""


@dataclass(frozen=True)
class Absent:
    """A program that cannot run, and why."""

    name: str
    why: str


@dataclass
class Jaart:
    """The program itself. scene: with the data as loaded; settings: those of a preset."""

    name: str
    scene: jaart.Scene
    settings: jaart.Settings
    lazy: bool = True

    def load_kernels(self, view: View) -> None:
        """Compile, or load from disk, what the pictures need: no measured time or memory holds it."""
        jaart.render(replace(self.scene), self.settings, view.camera, (16, 16))

    def first(self, view: View) -> First:
        """A picture of the scene with nothing kept from an earlier one."""
        scene = replace(self.scene)

        def shoot(seen: View) -> Hits:
            return jaart.render(scene, self.settings, seen.camera, seen.size)

        hits = shoot(view)
        return First(hits, hits.prep_s, shoot)


def why_absent(*modules: str) -> str:
    """Why one of the modules cannot be loaded, in a few words; empty where all can."""
    for name in modules:
        try:
            import_module(name)
        except ModuleNotFoundError:
            return f"{name} is not installed"
        except (ImportError, OSError) as error:
            return f"{name} does not load: {error}"
    return ""
