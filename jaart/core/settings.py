"""The settings: every parameter declared once, with its unit, range, help and source equation."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from jaart.core.errors import SettingsError
from jaart.core.parameter import STAGES, Length, Parameter, declared, parameter


def _phong(settings: Settings) -> bool:
    return settings.shading == "phong"


@dataclass(frozen=True, kw_only=True)
class Settings:
    """What to compute. Lengths are in cells of a lattice; see `PARAMETERS` for units and sources."""

    method: str = parameter(
        "choice", "tangent", choices=("tangent",), group="Surface", label="Surface", stage="rays",
        source="[T 2.15, 2.16; A 5]",
        help="The surface that is shown: tangent is the zero set of f(x) = <n(x), a(x) - x>.")
    mahalanobis_c: float = parameter(
        "number", 0.25, low=0, high=1, step=0.05, group="Surface", label="Mahalanobis c", stage="trace",
        source="[T 2.17]",
        help="Share of the distance along a surfel's plane in the energy e_M that a picked ray's curves show.")

    weight: str = parameter(
        "choice", "gaussian", choices=("gaussian",), group="Weight and area", label="Weight", stage="rays",
        source="[T 2.7; A §6]", help="How the influence of a surfel falls with its distance q: exp(-q²/h²).")
    h: Length = parameter(
        "length", Length(0.8), low=0, open_low=True, high=1e6, step=0.05, unit="cells",
        group="Weight and area", label="Feature size h", stage="rays", source="[T 2.7]",
        help="Width of the weight: larger values smooth more and shrink round shapes by about h²/2R.")
    normal: str = parameter(
        "choice", "surfel", choices=("surfel",), group="Weight and area", label="Normal", stage="rays",
        source="[T 2.13]", help="Where n(x) comes from: the weighted average of the surfels' normals.")
    neighbourhood: str = parameter(
        "choice", "cell_ball", choices=("cell_ball",), group="Weight and area", label="Neighbourhood",
        stage="neighbours", source="[T §3.1.3]",
        help="Which surfels count at x: those within the radius of the centre of the cell that holds x.")
    radius: Length = parameter(
        "length", Length(2.0), low=0.5, high=16, step=0.25, unit="cells", group="Weight and area",
        label="Radius", stage="neighbours", source="[T §3.1.3]",
        help="Radius of the neighbourhood, best 2.5 h or more: what it cuts off makes f jump at cell faces, and "
             "holes open.")

    search: str = parameter(
        "choice", "iterate", choices=("iterate",), group="Search", label="Search", stage="rays",
        source="[T §2.3.5; A §4]",
        help="How a ray finds the surface: iterate intersects it with the plane at x again and again.")
    tolerance: float = parameter(
        "number", 0.125, low=0, high=10, step=0.005, unit="h", group="Search", label="Tolerance",
        stage="rays", source="[T 2.14]",
        help="A ray has arrived when its next step is shorter than this; it counts in radii where the radius is "
             "below h.")
    max_iterations: int = parameter(
        "integer", 20, low=1, high=10_000, step=1, group="Search", label="Iterations a start", stage="rays",
        source="[T §2.4.5, footnote 14]", help="After so many steps from one start the ray tries the next cell.")
    trust: Length | str = parameter(
        "length", "radius", choices=("radius",), low=0, open_low=True, high=1e6, step=0.25, unit="cells",
        group="Search", label="Trust region", stage="rays", source="[A §4]",
        help="How far from its start a search may go before it is given up; by default the radius.")
    bail: str = parameter(
        "choice", "cap", choices=("cap", "growth"), group="Search", label="Give up at", stage="rays",
        source="[A §4]", help="cap: after the iterations allowed; growth: also as soon as |f| grows.")
    traversal: str = parameter(
        "choice", "exact", choices=("exact",), group="Search", label="Traversal", stage="rays",
        source="[T §3.1.4]", help="How the cells along a ray are found: exact visits every cell it crosses.")

    max_off_centre: Length = parameter(
        "length", Length(0.3), low=0, open_low=True, high=1e6, step=0.01, unit="cells", group="Boundary",
        label="Off-centre bound", stage="rays", source="[T 2.21]",
        help="A hit farther than this from its barycentre a(x) is refused; it removes shreds at silhouettes.")

    placement: str = parameter(
        "choice", "box", choices=("box",), group="Lattice", label="Placement", stage="surfels",
        source="[T 3.3, §3.1.2]", help="Where a cell's surfel lies along its normal: box maps the level linearly.")
    gradient: str = parameter(
        "choice", "central", choices=("central",), group="Lattice", label="Gradient", stage="surfels",
        source="[T 3.1, 3.2]", help="How a cell's normal is found: central differences, one-sided at the border.")
    neighbours: str = parameter(
        "choice", "6", choices=("6", "26"), group="Lattice", label="Interface rule", stage="surfels",
        source="[T §3.1]", help="Among how many neighbours an empty cell makes a full one an interface cell.")
    border: str = parameter(
        "choice", "open", choices=("open", "closed"), group="Lattice", label="Border", stage="surfels",
        help="open: outside the lattice is unknown, a basin has no surface at its walls; closed: it is empty.")

    raster: int | str = parameter(
        "integer", "file", choices=("file",), low=2, high=2048, step=1, unit="cells", group="Model",
        label="Raster", stage="levels", source="[T §3.3.3]",
        help="Cells along each edge of a model scene; by default as its file says.")
    filling: str = parameter(
        "choice", "corners", choices=("corners",), group="Model", label="Filling", stage="levels",
        source="[T Algorithms 3, 4]", help="How a model's fill levels are found: corners votes 8 corners a sub-cell.")
    subdivision: int = parameter(
        "integer", 20, low=1, high=100, step=1, group="Model", label="Sub-cells", stage="levels",
        source="[T §3.3.3]", help="Sub-cells along each edge of an interface cell when a model is filled.")

    shading: str = parameter(
        "choice", "phong", choices=("phong", "diffuse"), group="Shading", label="Shading", stage="shade",
        source="[T 2.4]", help="phong: ambient, diffuse and specular light; diffuse: the plain blue picture.")
    light: tuple[float, float, float] | str = parameter(
        "vector", "headlight", choices=("headlight",), group="Shading", label="Light", stage="shade",
        unit="cells", source="[T 2.4]", help="Where the light stands; headlight: at the eye.")
    ambient: float = parameter(
        "number", 0.15, low=0, high=1, step=0.05, group="Shading", label="Ambient", stage="shade",
        source="[T 2.4]", when=_phong, help="Light that reaches every point.")
    diffuse: float = parameter(
        "number", 0.75, low=0, high=1, step=0.05, group="Shading", label="Diffuse", stage="shade",
        source="[T 2.4]", when=_phong, help="Light scattered evenly, by the angle of light and normal.")
    specular: float = parameter(
        "number", 0.3, low=0, high=1, step=0.05, group="Shading", label="Specular", stage="shade",
        source="[T 2.4]", when=_phong, help="Light reflected towards the eye.")
    shininess: float = parameter(
        "number", 30.0, low=1, high=1000, step=1, group="Shading", label="Shininess", stage="shade",
        source="[T 2.4]", when=_phong, help="How narrow the highlight is.")

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
PRESETS: dict[str, Mapping[str, Any]] = {"best": {}, "thesis": {}}


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
