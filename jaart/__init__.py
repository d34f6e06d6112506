"""Ray tracing of point-based surfaces: what a script or a notebook needs, loaded when it is first used.

For example ``jaart.render(jaart.load("splash"), jaart.Settings(h=0.8)).counts()``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jaart.core import errors
    from jaart.core.camera import Camera
    from jaart.core.io import load
    from jaart.core.isosurface import isosurface
    from jaart.core.notes import notes
    from jaart.core.picture import picture
    from jaart.core.plan import plan
    from jaart.core.quality import quality
    from jaart.core.render import render
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings, preset
    from jaart.core.study.stability.study import stability
    from jaart.core.trace import trace

__version__ = "0.1.0"

__all__ = ["load", "render", "picture", "trace", "quality", "isosurface", "plan", "notes", "stability", "Settings",
           "Camera", "preset", "Scene", "errors", "__version__"]

#: Where each public name lives; importing them here would load numpy and numba with the package.
_HOMES = {
    "load": "jaart.core.io", "render": "jaart.core.render", "trace": "jaart.core.trace",
    "quality": "jaart.core.quality", "Settings": "jaart.core.settings", "Camera": "jaart.core.camera",
    "preset": "jaart.core.settings", "Scene": "jaart.core.scene", "isosurface": "jaart.core.isosurface",
    "picture": "jaart.core.picture", "notes": "jaart.core.notes", "plan": "jaart.core.plan",
    "stability": "jaart.core.study.stability.study",
}


def __getattr__(name: str) -> Any:
    if name == "errors":
        value: Any = import_module("jaart.core.errors")
    elif name in _HOMES:
        value = getattr(import_module(_HOMES[name]), name)
    else:
        raise AttributeError(f"module 'jaart' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
