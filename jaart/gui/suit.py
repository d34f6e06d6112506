"""Which settings suit a scene; what does not goes back to a preset's value."""

from __future__ import annotations

from jaart.core.errors import SettingsError
from jaart.core.parameter import Length
from jaart.core.scene import Scene
from jaart.core.settings import PARAMETERS, Settings, preset
from jaart.gui.values import text_of


def of_preset(scene: Scene, name: str) -> tuple[Settings, str]:
    """A preset's values as they suit a scene, and a line that says what was changed, "" for nothing.

    What is for other kinds of scenes stays: it is hidden, and comes back with them.
    """
    from jaart.core.suited import suited

    whole = preset(name)
    hidden = {name: getattr(whole, name) for name, about in PARAMETERS.items() if scene.kind not in about.scenes}
    try:
        values = suited(scene, whole)[0].replace(**hidden)
    except SettingsError:  # as of a cloud without spacing; the picture will say it
        return whole, ""
    return values, _told(scene, whole, values)


def suited(scene: Scene, settings: Settings, base: Settings, before: Scene | None = None) -> tuple[Settings, str]:
    """Settings that make sense in a scene, and a line that says what was changed, "" for nothing.

    base: a preset's values in the scene, which replace those that do not suit; before: the scene that the settings
    were made for: lengths in cells say nothing in a cloud, nor the other way round. May take seconds for a large cloud.
    """
    from jaart.core import meaning

    kept = _in_kind(scene, settings, base, before)
    for _ in PARAMETERS:
        try:
            meaning.check(scene, kept)
        except SettingsError as error:
            better = _without(kept, base, refused_name(str(error)))
            if better is None:
                break
            kept = better
        else:
            break
    return kept, _told(scene, settings, kept)


def _told(scene: Scene, old: Settings, new: Settings) -> str:
    changed = [f"{name} = {text_of(getattr(new, name))}" for name in PARAMETERS
               if getattr(new, name) != getattr(old, name)]
    return f"Put back, for a {scene.kind} has no other use for it: {', '.join(changed)}" if changed else ""


def refused_name(message: str) -> str:
    """The setting that a message of the core refuses, "" where it names none."""
    words = message.replace(":", " ").split()
    return words[0] if words and words[0] in PARAMETERS else ""


def _in_kind(scene: Scene, settings: Settings, base: Settings, before: Scene | None) -> Settings:
    """The settings with what is for other kinds of scenes as the preset has it."""
    moved = before is not None and (before.kind == "cloud") != (scene.kind == "cloud")
    values = {}
    for name, about in PARAMETERS.items():
        value = getattr(settings, name)
        number = not isinstance(value, str) and not (isinstance(value, Length) and value.unit)
        absolute = number and (about.kind == "length" or name == "level")
        if scene.kind not in about.scenes or (moved and absolute):
            values[name] = getattr(base, name)
    return settings.replace(**values)


def _without(settings: Settings, base: Settings, name: str) -> Settings | None:
    """The settings with one of the preset's value, or else its default; None where it has both already."""
    for value in (getattr(base, name), PARAMETERS[name].default) if name else ():
        if getattr(settings, name) != value:
            return settings.replace(**{name: value})
    return None
