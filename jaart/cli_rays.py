"""The commands that trace all rays of a picture, or a list of them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from jaart import cli_arguments as typed
from jaart import cli_files as files
from jaart import cli_progress as bars
from jaart import cli_report as report
from jaart.cli_options import DEFAULT_SIZE

if TYPE_CHECKING:
    from jaart.core.camera import Camera
    from jaart.core.records import Hits, Quality
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings

MapName = Annotated[str, typer.Option("--map", metavar="NAME", help=(
    "What colours mean: shaded, iterations, evaluations, off_centre, sampling, lowered, depth, status, "
    "distance_error, normal_error."))]
RaysFile = Annotated[Path | None, typer.Option("--rays", metavar="FILE", help=(
    "Trace the origins and directions (R, 3) of this .npz instead of a camera's; needs --hits."))]
HitsFile = Annotated[Path | None, typer.Option("--hits", metavar="FILE", help="Every ray's hit as arrays, .npz.")]


def check_rays_alone(size: str, camera: list[str] | None, output: Path | None, hits: Path | None, map_: str) -> None:
    """Refuse options that have no meaning with --rays; that --size has none is only said."""
    if hits is None:
        raise typed.usage("--rays", "needs --hits FILE.npz to write to")
    for option, given in (("--camera", camera), ("--output", output), ("--map", map_ != "shaded")):
        if given:
            raise typed.usage(option, "has no meaning with --rays, which make no picture")
    if size != DEFAULT_SIZE:
        print("jaart: note: --size has no meaning with --rays", file=sys.stderr)


def check_outputs(scene: str, output: Path | None, hits: Path | None) -> Path | None:
    """The picture's file, named after the scene where nobody names any; files that cannot be are refused."""
    if output is None and hits is None:
        output = Path(f"{Path(scene).stem or 'scene'}.png")
    for path, option, suffix in ((output, "--output", ".png"), (hits, "--hits", ".npz")):
        if path is not None:
            typed.output(path, option, suffix)
    return output


def traced(scene: Scene, settings: Settings, view: Camera | None, size: tuple[int, int], threads: int | None,
           rays: Path | None = None) -> Hits:
    """The hits of a picture's rays, or of those in a file."""
    from jaart.core.render import render

    listed = None if rays is None else typed.rays(rays)
    report.say_compiling(scene, settings)
    with bars.counted("rays") as progress:
        return render(scene, settings, view, size, rays=listed, threads=threads, progress=progress)


def say(found: Hits, scene: Scene, settings: Settings, errors: Quality | None) -> None:
    """Say how the rays ended, and what to know of them."""
    print(report.hits_line(found, scene, errors))
    report.say_notes(scene, settings, found)


def write_picture(found: Hits, scene: Scene, map_: str, errors: Quality | None, threads: int | None,
                  output: Path) -> None:
    """Make the colours, write them and say so."""
    from jaart.core.picture import finish

    with bars.counted("light") as progress:
        colours = finish(found, scene, map_, errors, progress=progress, threads=threads)
    files.write_picture(colours, found, scene, errors, map_, output)
