"""Values that a preset brings and a scene has no use for: replaced by the defaults, and said."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from jaart.core.chosen import chosen
from jaart.core.meaning import REFUSED
from jaart.core.parameter import Length
from jaart.core.scene import Scene
from jaart.core.settings import PARAMETERS, Settings

#: What every parameter is when nobody says.
DEFAULTS = Settings()


def suited(scene: Scene, settings: Settings, typed: Iterable[str] = ()) -> tuple[Settings, tuple[str, ...]]:
    """The settings without those values that nobody typed and that mean nothing in the scene, and notes of these.

    typed: names of the settings that a person gave; they stay, for `meaning` to refuse. A preset's length in cells
    means nothing in a cloud, one in diagonals or spacings of a cloud nothing in a lattice; nor does a value that the
    scene's kind, or what was typed, rules out.
    """
    kept = frozenset(typed)
    settings, foreign = _without(settings, kept, lambda name, s: _foreign(scene, getattr(s, name)))
    settings, idle = _without(settings, kept, lambda name, s: scene.kind not in PARAMETERS[name].scenes
                              or not PARAMETERS[name].matters(s) or name in _refused(scene, s))
    unit = "in cells, which a cloud has not" if scene.kind == "cloud" else "in shares of a cloud"
    notes = [(unit, foreign), ("without a meaning here", idle)]
    return settings, tuple(f"left out of the preset, {why}: {', '.join(texts)}" for why, texts in notes if texts)


def _without(settings: Settings, kept: frozenset[str],
             useless: Callable[[str, Settings], bool]) -> tuple[Settings, list[str]]:
    """The settings with defaults in the place of useless values, and those values as texts."""
    left_out = []
    for name in PARAMETERS:
        value = getattr(settings, name)
        if name not in kept and value != getattr(DEFAULTS, name) and useless(name, settings):
            left_out.append(f"{name} = {str(value).lower() if isinstance(value, bool) else value}")
            settings = settings.replace(**{name: getattr(DEFAULTS, name)})
    return settings, left_out


def _foreign(scene: Scene, value: object) -> bool:
    """Whether a value is a length in the units of the other kind of scene."""
    return isinstance(value, Length) and (value.unit == "") == (scene.kind == "cloud")


def _refused(scene: Scene, settings: Settings) -> set[str]:
    values = chosen(scene, settings)
    return {name for name, refused, _ in REFUSED if refused(scene, settings, values)}
