"""The command that writes a scene's surface as a mesh."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from jaart import cli_arguments as typed
from jaart.core.errors import SettingsError

if TYPE_CHECKING:
    from collections.abc import Callable

    from jaart.core.contour import Mesh
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings

EnergyName = Annotated[str, typer.Option("--energy", metavar="NAME", help=(
    "tangent (|f|), off_centre, mahalanobis, angle, tangent_step (a ray's |e_ts|; needs --direction or --camera), or "
    "fill_level for the lattice's own levels."))]
LevelText = Annotated[str | None, typer.Option("--level", metavar="L", help=(
    "The energy's value, or the fill level; by default as the method asks for."))]
Divisions = Annotated[int | None, typer.Option("--subdivide", metavar="N", help="Samples along an edge of a cell.")]
DirectionText = Annotated[str | None, typer.Option("--direction", metavar="x,y,z", help="The ray's, of tangent_step.")]
MeshFile = Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="The mesh, .ply, .stl, .obj or .vtp.")]

#: Settings that the command's own options give.
IMPLIED = ("method", "energy", "level", "subdivide")


def asked(energy: str, level: str | None, subdivide: int | None, preset: str, assignments: list[str]) -> Settings:
    """The settings of the command; --set overrides the options, and is refused where it means nothing for them."""
    from jaart.core.field import DIRECTED
    from jaart.core.isosurface import NAMES

    if energy not in NAMES:
        raise SettingsError(f"--energy {energy}: expected {', '.join(NAMES)}")
    if energy == "fill_level" and subdivide is not None:
        raise typed.usage("--subdivide", "has no meaning with --energy fill_level")
    own = ["method=fill_level"]
    if energy != "fill_level":
        own = ["method=isosurface", f"energy={'tangent' if energy == DIRECTED else energy}"]
    own += [] if level is None else [f"level={level}"]
    own += [] if subdivide is None else [f"subdivide={subdivide}"]
    for name in ("method", "energy"):
        if any(text.partition("=")[0].strip() == name for text in assignments):
            raise typed.usage("--set", f"{name} is what --energy says")
    return typed.settings(preset, [*own, *assignments])


def direction_of(energy: str, text: str | None, camera: list[str], scene: Scene, settings: Settings) -> Any:
    """The direction (3,) that tangent_step is seen in: typed, or the camera's; None for other energies."""
    from jaart.core.field import DIRECTED

    if energy != DIRECTED:
        for option, given in (("--direction", text), ("--camera", camera)):
            if given:
                raise typed.usage(option, f"has no meaning without --energy {DIRECTED}")
        return None
    if (text is None) == (not camera):
        raise typed.usage("--direction", f"expected either --direction x,y,z or --camera with --energy {DIRECTED}")
    if text is not None:
        return typed.vector(text, "--direction")
    view = typed.camera(camera, scene, settings)
    return [t - e for t, e in zip(view.target, view.eye, strict=True)]


def check_output(output: Path) -> None:
    """Refuse, before any work, a file that cannot be written."""
    from jaart.core.mesh_files import SUFFIXES

    typed.output(output, "--output", *SUFFIXES)


def write(scene: Scene, settings: Settings, energy: str, direction: Any, output: Path,
          progress: Callable[[int, int], None] | None = None) -> None:
    """Make the mesh, write it and say so."""
    from jaart.core.isosurface import isosurface
    from jaart.core.mesh_files import save_mesh

    mesh: Mesh = isosurface(scene, settings, energy, direction=direction, progress=progress)
    save_mesh(mesh, output, scene.spacing, scene.origin)
    print(f"{len(mesh.vertices)} vertices, {len(mesh)} triangles")
    print(f"wrote {output}")
