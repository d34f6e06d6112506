"""What a scene with these settings needs, and what it does not: every stage with its reason, and what `auto` came to.

Nothing is made for it but the lengths that a cloud's spacing gives. Each answer is that of the function by which the
program itself decides.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from jaart.core import extents, meaning, quality, visible
from jaart.core.camera import Camera
from jaart.core.chosen import AS_SET, Chosen, arrival, explained, tolerance_unit
from jaart.core.lights import shadows_wanted
from jaart.core.parameter import shown
from jaart.core.plan_rays import ray_stages
from jaart.core.plan_scene import scene_stages
from jaart.core.scene import Scene
from jaart.core.settings import PARAMETERS, Settings, preset
from jaart.core.stage import Stage, stage

#: Settings whose value depends on the scene, and the field of Chosen that holds it.
RESOLVED = {"h": "h", "neighbourhood": "neighbourhood", "radius": "radius", "normal": "normal", "search": "search",
            "trust": "trust", "max_off_centre": "off_centre", "max_nearest": "nearest", "level": "level"}


@dataclass(frozen=True)
class Value:
    """What a setting came to: its value, its unit or "", and in words where it comes from."""

    name: str
    value: Any
    unit: str
    origin: str


@dataclass(frozen=True)
class Plan:
    """What will be done.

    source, kind: of the scene; stages: all of them, in the order of the computation; values: what the settings came
    to that depend on the scene.
    """

    source: str
    kind: str
    settings: Settings
    stages: tuple[Stage, ...]
    values: tuple[Value, ...]

    @property
    def runs(self) -> tuple[Stage, ...]:
        """The stages that run."""
        return tuple(s for s in self.stages if s.runs)

    @property
    def left_out(self) -> tuple[Stage, ...]:
        """The stages that nothing needs."""
        return tuple(s for s in self.stages if not s.runs)

    def __getitem__(self, name: str) -> Stage:
        """The stage of a name. Raises KeyError for a name that there is not."""
        return {s.name: s for s in self.stages}[name]

    def deciding(self, one: Stage) -> dict[str, str]:
        """The settings that decide on a stage, as they may be typed."""
        return {name: shown(getattr(self.settings, name)) for name in one.settings}


def plan(scene: Scene, settings: Settings | None = None, camera: Camera | None = None,
         size: tuple[int, int] = (512, 512)) -> Plan:
    """The stages that a picture of a scene takes and those it leaves out, and the values that its settings come to.

    settings: those of the preset "best" when None; camera: the whole scene in view when None; size: (width, height).
    Raises SettingsError for settings that make no sense in the scene.
    """
    settings = settings or preset("best")
    camera = camera or Camera.fit(extents.bounds(scene, settings), size=size)
    values = meaning.check(scene, visible.seen(scene, settings, camera, size))
    stages = (*scene_stages(scene, settings, values), *ray_stages(scene, settings, values),
              *_picture_stages(scene, settings))
    kept = tuple(replace(one, settings=tuple(name for name in one.settings if _matters(scene, settings, name)))
                 for one in stages)
    return Plan(scene.source, scene.kind, settings, kept, (*_values(scene, settings, values),
                                                           *_tolerance(scene, settings, values, camera, size)))


def _picture_stages(scene: Scene, settings: Settings) -> tuple[Stage, ...]:
    """What comes after the hits."""
    return (
        stage("shadow rays", shadows_wanted(settings), "from each hit to each light", "none are asked for",
              "shadows", "light", "shading"),
        stage("reflection and refraction", settings.shading == "water", f"up to {settings.depth} times a ray",
              "shading is no water: no stack of media either", "shading", "depth", "ior"),
        stage("more samples", settings.samples > 1, f"{settings.samples}×{settings.samples} rays a pixel",
              "one ray a pixel", "samples"),
        stage("exact surface", quality.known(scene), "known: errors are measured where they are asked for",
              "nobody knows it, so there are no errors to measure"))


def _values(scene: Scene, settings: Settings, values: Chosen) -> tuple[Value, ...]:
    """What settings that have a meaning here came to."""
    origins = explained(scene, settings)
    return tuple(Value(name, value, "" if isinstance(value, str) or name == "level" else _unit(scene), origin)
                 for name, (value, origin) in ((name, origins[field]) for name, field in RESOLVED.items())
                 if _matters(scene, settings, name))


def _tolerance(scene: Scene, settings: Settings, values: Chosen, camera: Camera,
               size: tuple[int, int]) -> tuple[Value, ...]:
    """How short a step ends a search, and why, where one does."""
    if not _matters(scene, settings, "tolerance"):
        return ()
    why = AS_SET if settings.tolerance != "auto" else visible.for_picture(scene, settings, camera, size)[1]
    return (Value("tolerance", arrival(values), _unit(scene), f"{values.tolerance:g} {tolerance_unit(values)}, {why}"),)


def _unit(scene: Scene) -> str:
    """What lengths count in."""
    return "cells" if scene.kind != "cloud" else "cloud units"


def _matters(scene: Scene, settings: Settings, name: str) -> bool:
    """Whether a setting has a meaning in the scene and beside the others."""
    return scene.kind in PARAMETERS[name].scenes and PARAMETERS[name].matters(settings)
