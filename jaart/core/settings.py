"""The settings: one record of all parameters, which the groups declare, and presets of whole sets."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from jaart.core.errors import SettingsError
from jaart.core.groups.scenes import CloudSettings, LatticeSettings, ModelSettings
from jaart.core.groups.search import BoundarySettings, SearchSettings
from jaart.core.groups.shading import ShadingSettings
from jaart.core.groups.surface import SurfaceSettings, WeightSettings
from jaart.core.parameter import STAGES, Parameter, declared


@dataclass(frozen=True, kw_only=True)
class Settings(ShadingSettings, CloudSettings, ModelSettings, LatticeSettings, BoundarySettings, SearchSettings,
               WeightSettings, SurfaceSettings):
    """What to compute. Lengths are in cells of a lattice or units of a cloud; see `PARAMETERS` for all of them."""

    def __post_init__(self) -> None:
        for name, about in PARAMETERS.items():
            object.__setattr__(self, name, about.check(getattr(self, name)))

    def replace(self, **values: Any) -> Settings:
        """These settings with some values changed. Raises SettingsError for a name that does not exist."""
        for name in values:
            if name not in PARAMETERS:
                raise SettingsError(f"no setting is called {name!r}; {_nearest(name)}")
        return dataclasses.replace(self, **values)

    def key(self, stage: str) -> tuple[Any, ...]:
        """The values that a stage and those before it depend on, to keep results by."""
        last = STAGES.index(stage)
        return tuple(getattr(self, p.name) for p in PARAMETERS.values() if STAGES.index(p.stage) <= last)


#: Every parameter by name, in the order of the form.
PARAMETERS: dict[str, Parameter] = declared(Settings)

#: Whole sets of values by name; "best" follows the project's measurements, "thesis" its source.
PRESETS: dict[str, Mapping[str, Any]] = {
    "best": {"method": "polynomial", "degree": 2, "patch": 1.0, "search": "secant", "tolerance": 0.01,
             "placement": "exact", "gradient": "youngs"},
    "thesis": {"method": "tangent", "search": "iterate", "weight": "gaussian", "h": 0.8, "normal": "surfel",
               "neighbourhood": "cell_ball", "radius": 2.0, "placement": "box", "gradient": "central",
               "traversal": "exact", "tolerance": 0.125, "max_off_centre": 0.3, "max_iterations": 20,
               "filling": "corners"},
    "adamson-alexa": {"method": "polynomial", "degree": 2, "search": "iterate", "weight": "gaussian", "h": "0.004d",
                      "normal": "covariance_at_x", "ball_k": 6, "tolerance": 1e-3},
}


@functools.cache
def preset(name: str) -> Settings:
    """The settings of a preset. Raises SettingsError for a name that does not exist."""
    if name not in PRESETS:
        raise SettingsError(f"no preset is called {name!r}; there are {', '.join(PRESETS)}")
    return Settings(**PRESETS[name])


def parse(assignments: Iterable[str], base: Settings | None = None) -> Settings:
    """Settings from "name=value" texts on top of a base. Raises SettingsError that names the text."""
    values = {}
    for text in assignments:
        name, equals, value = text.partition("=")
        if not equals:
            raise SettingsError(f"--set {text!r}: expected name=value")
        values[name.strip()] = value.strip()
    return (base or Settings()).replace(**values)


def _nearest(name: str) -> str:
    import difflib

    close = difflib.get_close_matches(name, PARAMETERS, n=1)
    return f"did you mean {close[0]}?" if close else f"there are {', '.join(PARAMETERS)}"
