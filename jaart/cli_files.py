"""What the commands read and write: scenes with settings that fit them, and files of the kind that their name says."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from jaart import cli_arguments as typed
from jaart import cli_report as report
from jaart.cli_options import DEFAULT_PRESET
from jaart.core.errors import SettingsError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from jaart.core.colours import Bytes
    from jaart.core.records import Hits, Quality, Trace
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings


def load(source: str, frame: int | None) -> Scene:
    """The scene of a name; what was repaired on reading is said."""
    from jaart.core.io import BUILT_IN, load

    scene = load(source, frame)
    report.note(() if source in BUILT_IN else scene.notes)
    return scene


def open_scene(source: str, frame: int | None, chosen: Settings, preset: str, assignments: list[str] | None,
               implied: tuple[str, ...] = ()) -> tuple[Scene, Settings]:
    """A scene, and the settings as it can take them; implied: names of settings that other options gave."""
    scene = load(source, frame)
    fitting, notes = fitted(scene, chosen, preset, assignments, implied)
    report.note(notes)
    return scene, fitting


def fitted(scene: Scene, chosen: Settings, preset: str, assignments: list[str] | None,
           implied: tuple[str, ...] = ()) -> tuple[Settings, tuple[str, ...]]:
    """The settings as a scene can take them, and notes of what was left out of a preset that somebody named."""
    fitting, notes = typed.suit(scene, chosen, assignments or [], implied)
    return fitting, notes if preset != DEFAULT_PRESET else ()  # the default one is for every scene


def check_map(name: str, scene: Scene, settings: Settings) -> None:
    """Raise SettingsError for a map that there is not, or not of this scene with these settings."""
    from jaart.core.maps import lacks
    from jaart.core.quality import known

    if what := lacks(name, known(scene), settings):
        raise SettingsError(f"map {name}: needs {what} ({scene.source})")


def write_picture(colours: Bytes, found: Hits, scene: Scene, errors: Quality | None, map_: str, output: Path) -> None:
    """Write a picture and say so, with what its colours mean."""
    from jaart.core.export import save_picture

    save_picture(colours, output)
    print(f"wrote {output}{_meaning(found, scene, errors, map_)}")


def write_hits(found: Hits, path: Path) -> None:
    """Write the hits and say so."""
    from jaart.core.export import save_hits

    save_hits(found, path)
    print(f"wrote {path}")


def write_statistics(found: Hits, errors: Quality | None, output: Path) -> None:
    """Write the statistics of a picture as .csv or .svg, and say so."""
    from jaart.core.export import save_statistics_csv
    from jaart.core.statistics import statistics

    counted = statistics(found, errors)
    if output.suffix.lower() == ".csv":
        save_statistics_csv(counted, output)
    else:
        from jaart.plot.statistics import statistics_figure

        save_figure(statistics_figure(counted), output)
    print(f"wrote {output}")


def _meaning(found: Hits, scene: Scene, errors: Quality | None, map_: str) -> str:
    """Which normals a picture is shaded with, or what the ends of a map's colours stand for."""
    from jaart.core.maps import MAPS, scale

    if map_ == "shaded":
        return f", shading_normal = {found.settings.shading_normal}"
    if map_ == "status":
        return ""
    low, high = scale(map_, found, errors)
    unit = MAPS[map_].unit
    if unit == "cells" and scene.kind == "cloud":
        unit = "spacings" if map_ == "distance_error" else "cloud units"
    return f", colours from {low:g} to {high:g} {unit}".rstrip() + ", what lies beyond has the last colour"


def write_trace(followed: Trace, output: Path, up: tuple[float, float, float], level: float) -> None:
    """Write one ray as .json, .csv or .svg, whichever the name says; up: the camera's, for the plots; level: below
    which a minimum counts.
    """
    from jaart.core import export

    if output.suffix.lower() == ".json":
        export.save_trace_json(followed, output)
    elif output.suffix.lower() == ".csv":
        export.save_trace_csv(followed, output)
    else:
        from jaart.plot.trace import trace_figure

        save_figure(trace_figure(followed, up=up, level=level), output)


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure as SVG, the same bytes for the same figure."""
    import matplotlib

    from jaart.core.io.atomic import replacing

    with matplotlib.rc_context({"svg.hashsalt": "jaart"}), replacing(path) as part:
        figure.savefig(part, format="svg", metadata={"Date": None})
