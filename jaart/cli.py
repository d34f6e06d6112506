"""The command line: no arguments or a scene alone open the window, a verb works without one."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from jaart import cli_arguments as typed
from jaart import cli_files as files
from jaart import cli_isosurface as meshes
from jaart import cli_plan as plans
from jaart import cli_progress as bars
from jaart import cli_rays as pictures
from jaart import cli_report as report
from jaart import cli_study as studies
from jaart.cli_interrupt import beside
from jaart.cli_options import (
    DEFAULT_PRESET,
    DEFAULT_SIZE,
    CameraTexts,
    Frame,
    OutputFile,
    PresetName,
    SceneName,
    SetTexts,
    SizeText,
    Threads,
)
from jaart.core.errors import JaartError

#: What the parser raises for wrong usage; it has no public name of its own.
_USAGE: Any = typer.BadParameter.__mro__[1]

app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False,
                  context_settings={"help_option_names": ["-h", "--help"]})


def run(arguments: list[str]) -> int:
    """Do what the arguments say. Returns the exit status; every error is one line on stderr."""
    command = typer.main.get_command(app)
    try:
        words = typed.complete(arguments, getattr(command, "commands", {}))
        if isinstance(sys.stdout, io.TextIOWrapper):
            sys.stdout.reconfigure(line_buffering=True)  # what was said stays said when Ctrl-C ends the process
        with bars.shown():
            status = _main(command, words) if words[0] == "gui" else beside(lambda: _main(command, words))
    except JaartError as error:
        return _fail(str(error), 1)
    except _USAGE as error:
        message = error.format_message().removeprefix("Invalid value: ")
        return _fail(f"{message} (jaart -h helps)", 2)
    except (KeyboardInterrupt, typer.Abort):
        status = 130
    except BrokenPipeError:
        sys.stdout = None  # the reader has left; there is nobody to flush to
        return 1
    except OSError as error:
        return _fail(f"{error.filename or 'system'}: {error.strerror or error}", 1)
    except MemoryError:
        return _fail("not enough memory for this scene and size", 1)
    if status == 130:  # what the parser makes of Ctrl-C as well
        return _fail("interrupted", 130)
    return status if isinstance(status, int) else 0


@app.callback(invoke_without_command=True)
def _start(version: Annotated[bool, typer.Option("--version", help="Say the versions and end.")] = False) -> None:
    """Ray tracing of point-based surfaces, one ray at a time in plain sight.

    No arguments, or a scene alone, open the window.

    Exit status: 0 done, 1 failed or refused, 2 typed wrongly, 130 interrupted.
    """
    if version:
        print(report.versions())
        raise typer.Exit(0)


@app.command()
def gui(scene: SceneName = "splash",
        pick: Annotated[str | None, typer.Option(metavar="X,Y", help="Pick this pixel of the picture.")] = None,
        screenshot: Annotated[Path | None, typer.Option(metavar="FILE", help="Save the window here and end.")] = None,
        frame: Frame = None, camera: CameraTexts = None, preset: PresetName = DEFAULT_PRESET,
        set_: SetTexts = None) -> int:
    """Open the window."""
    pixel = None if pick is None else typed.pixel(pick, "--pick")
    settings = typed.settings(preset, set_ or [])
    if screenshot is not None:
        typed.output(screenshot, "--screenshot", ".png")
    view = None
    notes: tuple[str, ...] = ()
    if camera or set_ or preset != DEFAULT_PRESET:
        loaded = files.load(scene, frame)
        settings, notes = files.fitted(loaded, settings, preset, set_)
        report.note(notes)
        view = typed.camera(camera, loaded, settings) if camera else None

    from jaart.gui.app import run as open_window

    return open_window(scene, settings, view, pixel, None if screenshot is None else str(screenshot), frame, notes,
                       preset)


@app.command()
def info(scene: SceneName, frame: Frame = None,
         as_json: Annotated[bool, typer.Option("--json", help="The same for programs.")] = False) -> None:
    """Say what a scene holds.

    Kind, size, counts, value range, spacing, exact solids, what was repaired on reading, and what to know of it.
    """
    from jaart.core.io import load

    record = report.scene_record(load(scene, frame))
    print(json.dumps(record, indent=1, ensure_ascii=False) if as_json else report.scene_table(record))


@app.command()
def plan(scene: SceneName, size: SizeText = DEFAULT_SIZE, camera: CameraTexts = None,
         preset: PresetName = DEFAULT_PRESET, set_: SetTexts = None, frame: Frame = None,
         as_json: plans.AsJson = False) -> None:
    """Say what a picture needs with these settings and what it does not, each with its reason, and what auto is."""
    shape = typed.size(size)
    loaded, chosen = files.open_scene(scene, frame, typed.settings(preset, set_ or []), preset, set_)
    print(plans.text(plans.made(loaded, chosen, camera or [], shape), as_json))


@app.command()
def settings(name: Annotated[str | None, typer.Argument(metavar="NAME", help=(
        "A setting, a group of them, or a preset; everything when left out."))] = None) -> None:
    """List what --set takes: default, range, unit and meaning of each setting, and the presets."""
    from jaart.cli_settings import text

    print(text(name))


@app.command()
def render(
        scene: SceneName, size: SizeText = DEFAULT_SIZE, camera: CameraTexts = None,
        preset: PresetName = DEFAULT_PRESET, set_: SetTexts = None, frame: Frame = None,
        map_: pictures.MapName = "shaded", rays: pictures.RaysFile = None, threads: Threads = None,
        output: OutputFile = None, hits: pictures.HitsFile = None) -> None:
    """Render a picture, or trace rays.

    To files; without --output and --hits to SCENE.png in this folder.
    """
    if rays is not None:
        pictures.check_rays_alone(size, camera, output, hits, map_)
    output = pictures.check_outputs(scene, output, hits)
    shape, chosen = typed.size(size), typed.settings(preset, set_ or [])
    loaded, chosen = files.open_scene(scene, frame, chosen, preset, set_)
    files.check_map(map_, loaded, chosen)
    view = None if rays is not None else typed.camera(camera or [], loaded, chosen, shape)
    found = pictures.traced(loaded, chosen, view, shape, threads, rays)

    from jaart.core.quality import quality

    errors = quality(found, loaded) if loaded.model is not None or map_.endswith("_error") else None
    pictures.say(found, loaded, chosen, errors)
    if output is not None:
        pictures.write_picture(found, loaded, map_, errors, threads, output)
    if hits is not None:
        files.write_hits(found, hits)


@app.command()
def trace(
        scene: SceneName,
        output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help=(
            "Everything as .json, a row for each step as .csv, or the plots as .svg."))],
        pixel: Annotated[str | None, typer.Option(metavar="X,Y", help="The ray through this pixel.")] = None,
        size: SizeText = DEFAULT_SIZE, camera: CameraTexts = None,
        origin: Annotated[str | None, typer.Option(metavar="x,y,z", help="Where the ray begins, in cells.")] = None,
        direction: Annotated[str | None, typer.Option(metavar="x,y,z", help="Where it goes, of any length.")] = None,
        preset: PresetName = DEFAULT_PRESET, set_: SetTexts = None, frame: Frame = None) -> None:
    """Follow one ray and write every step it took."""
    at, ray = typed.which_ray(pixel, origin, direction)
    typed.output(output, "--output", ".json", ".csv", ".svg")
    shape, chosen = typed.size(size), typed.settings(preset, set_ or [])
    if at is None and size != DEFAULT_SIZE:
        print("jaart: note: --size has no meaning with --origin and --direction", file=sys.stderr)
    if at is not None:
        typed.check_pixel(at, shape)
    elif camera:
        raise typed.usage("--camera", "has no meaning with --origin and --direction")
    (loaded, chosen), up = files.open_scene(scene, frame, chosen, preset, set_), (0.0, 0.0, 1.0)

    from jaart.core.chosen import chosen as values_of
    from jaart.core.trace import trace as follow
    from jaart.core.visible import seen

    if at is not None:
        view = typed.camera(camera or [], loaded, chosen, shape)
        ray, up = typed.pixel_ray(view, shape, at), view.up or up
        chosen = seen(loaded, chosen, view, shape)
    assert ray is not None
    report.say_compiling(loaded, chosen, tracing=True)
    followed = follow(loaded, chosen, *ray, pixel=at)
    report.say_notes(loaded, chosen)
    files.write_trace(followed, output, up, values_of(loaded, chosen).level)
    print(report.trace_line(followed))
    print(f"wrote {output}")


@app.command()
def statistics(
        scene: SceneName,
        output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="Numbers as .csv, plots as .svg.")],
        size: SizeText = DEFAULT_SIZE, camera: CameraTexts = None, preset: PresetName = DEFAULT_PRESET,
        set_: SetTexts = None, frame: Frame = None, threads: Threads = None) -> None:
    """Count how the rays of a picture ended, and what they took.

    End states, steps, cells or balls, surfels, times, and the errors where the exact surface is known.
    """
    typed.output(output, "--output", ".csv", ".svg")
    shape, chosen = typed.size(size), typed.settings(preset, set_ or [])
    loaded, chosen = files.open_scene(scene, frame, chosen, preset, set_)
    found = pictures.traced(loaded, chosen, typed.camera(camera or [], loaded, chosen, shape), shape, threads)

    from jaart.core.quality import quality

    errors = quality(found, loaded)
    pictures.say(found, loaded, chosen, errors)
    files.write_statistics(found, errors, output)


@app.command()
def isosurface(
        scene: SceneName, energy: meshes.EnergyName, output: meshes.MeshFile, level: meshes.LevelText = None,
        subdivide: meshes.Divisions = None, direction: meshes.DirectionText = None, camera: CameraTexts = None,
        preset: PresetName = DEFAULT_PRESET, set_: SetTexts = None, frame: Frame = None) -> None:
    """Write the surface where an energy has a level, as a mesh with normals."""
    meshes.check_output(output)
    chosen = meshes.asked(energy, level, subdivide, preset, set_ or [])
    loaded, chosen = files.open_scene(scene, frame, chosen, preset, set_, meshes.IMPLIED)
    along = meshes.direction_of(energy, direction, camera or [], loaded, chosen)
    report.say_compiling(loaded, chosen)
    with bars.counted("layers of cells") as progress:
        meshes.write(loaded, chosen, energy, along, output, progress)


@app.command()
def study(name: studies.StudyName, output: studies.Folder, quick: studies.Quick = False) -> int:
    """Let the program examine itself.

    stability: every stiff and extreme case, with what was expected and what came of it.
    """
    studies.check(name, output)
    with bars.counted("cases", alone=True) as progress:
        return studies.run_stability(output, quick, progress)


@app.command(hidden=True)
def preview(scene: SceneName,
            output: Annotated[Path, typer.Option("--output", metavar="FOLDER", help="Made when absent.")]) -> None:
    """Render a scene's picture, and the plots of the ray through its middle, to files in a folder."""
    from jaart.cli_preview import write_preview

    loaded = files.load(scene, None)
    report.say_compiling(loaded, typed.settings(DEFAULT_PRESET, []))
    output.mkdir(parents=True, exist_ok=True)
    for path in write_preview(loaded, output):
        print(f"wrote {path}")


def _main(command: Any, words: list[str]) -> Any:
    return command.main(words, prog_name="jaart", standalone_mode=False)


def _fail(message: str, status: int) -> int:
    print(f"jaart: {' '.join(message.split())}", file=sys.stderr)
    return status
