"""Small scenes of every kind, settings that need different stages, and a count of calls, for plans."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from jaart.core import prepare
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere
from tests.core.cloud_scenes import fresh


def model() -> Scene:
    return Scene("ball", model=Model((Sphere((0.5, 0.5, 0.5), 0.3),), 12))


def lattice() -> Scene:
    return Scene("levels", levels=prepare.levels(model(), Settings()))


def bare() -> Scene:
    return fresh("sphere", 300, bare=True)


def oriented() -> Scene:
    return fresh("sphere", 300)


MADE: dict[str, Callable[[], Scene]] = {"model": model, "lattice": lattice, "bare": bare, "cloud": oriented}
SETTINGS: dict[str, dict[str, Any]] = {
    "tangent": {}, "safe": {"search": "safe"}, "off_centre": {"method": "off_centre"},
    "surfel": {"method": "off_centre", "normal": "surfel"},
    "covariance": {"normal": "covariance", "neighbourhood": "knn"}, "cylinder": {"method": "cylinder", "h": 0.6},
    "polynomial": {"method": "polynomial", "search": "secant"}, "fill_level": {"method": "fill_level"},
    "isosurface": {"method": "isosurface", "subdivide": 1},
}
CASES = [(scene, name) for scene in MADE for name, given in SETTINGS.items()
         if not (given.get("method") in ("fill_level", "isosurface") and scene in ("bare", "cloud"))]


def counted(monkeypatch: pytest.MonkeyPatch, calls: list[str], module: Any, name: str, call: Any = None) -> None:
    """Have a module's function write its name down before it does what it does."""
    inner = call or getattr(module, name)

    def written(*args: Any, **more: Any) -> Any:
        calls.append(name)
        return inner(*args, **more)

    monkeypatch.setattr(module, name, written)
