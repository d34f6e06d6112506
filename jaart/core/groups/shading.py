"""Light, water and colour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from jaart.core.parameter import parameter


def _phong(settings: Any) -> bool:
    return bool(settings.shading == "phong")


def _lit(settings: Any) -> bool:
    return settings.shading in ("phong", "water")


def _water(settings: Any) -> bool:
    return bool(settings.shading == "water")


@dataclass(frozen=True, kw_only=True)
class ShadingSettings:
    """From hits to colours."""

    shading: str = parameter(
        "choice", "phong", choices=("phong", "diffuse", "water"), group="Shading", label="Shading", stage="shade",
        source="[T §2.1.2]",
        help="phong: ambient, diffuse and specular light; diffuse: the plain blue picture; water: rays are mirrored "
             "and bent at the surface.")
    shading_normal: str = parameter(
        "choice", "average", choices=("average", "gradient"), group="Shading", label="Normal of a hit", stage="rays",
        source="[T 2.13]",
        help="average: n(x) of the hit, or the fitted polynomial's; gradient: the true normal -∇f of the surface.")
    light: tuple[tuple[float, float, float], ...] | str = parameter(
        "vectors", "headlight", choices=("headlight",), group="Shading", label="Lights", stage="shade",
        unit="units", source="[T 2.4]", help="Where the lights stand, x,y,z each, several apart by ';'; headlight: "
                                            "at the eye.")
    ambient: float = parameter(
        "number", 0.15, low=0, high=1, step=0.05, group="Shading", label="Ambient", stage="shade",
        source="[T 2.4]", when=_phong, needs="shading = phong", help="Light that reaches every point.")
    diffuse: float = parameter(
        "number", 0.75, low=0, high=1, step=0.05, group="Shading", label="Diffuse", stage="shade",
        source="[T 2.4]", when=_phong, needs="shading = phong",
        help="Light scattered evenly, by the angle of light and normal.")
    specular: float = parameter(
        "number", 0.3, low=0, high=1, step=0.05, group="Shading", label="Specular", stage="shade",
        source="[T 2.4]", when=_lit, needs="shading = phong or water", help="Light reflected towards the eye.")
    shininess: float = parameter(
        "number", 30.0, low=1, high=1000, step=1, group="Shading", label="Shininess", stage="shade",
        source="[T 2.4]", when=_lit, needs="shading = phong or water", help="How narrow the highlight is.")
    shadows: bool = parameter(
        "flag", False, group="Shading", label="Shadows", stage="shade", source="[T §2.1.2; A 12]",
        when=lambda s: s.shading == "phong" and s.light != "headlight",
        needs="shading = phong and a light other than headlight",
        help="A ray to each light asks whether anything stands between.")
    depth: int = parameter(
        "integer", 6, low=0, high=64, step=1, group="Shading", label="Depth", stage="shade",
        source="[T §2.1.2]", when=_water, needs="shading = water", help="How often a ray may be mirrored or bent.")
    ior: float = parameter(
        "number", 1.33, low=1, high=4, step=0.01, group="Shading", label="Index of refraction", stage="shade",
        source="[T §2.1.2]", when=_water, needs="shading = water", help="By Snell's law; 1.33 is water.")
    samples: int = parameter(
        "integer", 1, low=1, high=8, step=1, group="Shading", label="Samples a pixel", stage="rays",
        source="[T §2.1.2]", help="So many rays along each edge of a pixel are averaged; 1 = none.")
