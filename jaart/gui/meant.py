"""What the words of the settings, such as auto, stand for in the scene that is open."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from jaart.core.errors import SettingsError
from jaart.core.parameter import Length
from jaart.core.settings import PARAMETERS, Settings
from jaart.gui.values import unit_in

if TYPE_CHECKING:
    from jaart.core.chosen import Chosen
    from jaart.core.scene import Scene
    from jaart.gui.model import SceneModel
    from jaart.gui.tasks import Known

#: Where a parameter's value stands among the chosen ones, if its name is another there.
_CALLED = {"max_off_centre": "off_centre", "max_nearest": "nearest"}


def meant(name: str, model: SceneModel) -> Any:
    """What the word of a setting stands for at present; None where nobody knows, or where it is no value.

    Of a choice it is what auto would come to, whatever is chosen.
    """
    about, camera, scene = PARAMETERS[name], model.camera, model.scene
    if name == "raster":
        return scene.model.raster if scene is not None and scene.model is not None else None
    if name == "light":
        return tuple(float(f"{n:.4g}") for n in camera.eye) if camera is not None else None
    if not about.choices or model.known is None or scene is None:
        return None
    if about.kind == "choice":
        return _of_auto(name, scene, model.settings) if "auto" in about.choices else None
    value = _step(model.known.values, model) if name == "step" else \
        getattr(model.known.values, _CALLED.get(name, name), None)
    return _length(about.name, value, model.known, model.kind) if isinstance(value, float) else value


def _step(values: Chosen, model: SceneModel) -> float:
    """The step as it is typed: that of march in h for a cloud, in cells otherwise; without march the stride."""
    if model.settings.search != "march":
        return values.stride
    return values.step / values.h if unit_in(PARAMETERS["step"], model.kind) == "h" else values.step


def _of_auto(name: str, scene: Scene, settings: Settings) -> str:
    from jaart.core.chosen import of_auto  # numba comes with it: not before the window is up

    return of_auto(scene, settings, name)


def _length(name: str, value: float, known: Known, kind: str) -> Any:
    """A chosen number as it would be typed: lengths of a cloud in its spacing; None for an infinite one."""
    about = PARAMETERS[name]
    if not math.isfinite(value):
        return None
    wanted: Any = float(f"{value:.6g}")
    if about.kind == "length" and kind == "cloud" and known.spacing > 0:
        wanted = Length(float(f"{value / known.spacing:.4g}"), "s")
    try:
        return about.check(wanted)
    except SettingsError:
        return None
