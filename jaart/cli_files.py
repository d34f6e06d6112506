"""Writes what the commands were asked for, in the kind of file that its name says."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from jaart.core.records import Hits, Quality, Trace


def write_render(found: Hits, errors: Quality | None, map_: str, output: Path | None, hits: Path | None) -> None:
    """Write the picture and the hits where a file is named for them, and say so."""
    from jaart.core.export import save_hits, save_picture

    if output is not None:
        from jaart.core.shade import shade

        save_picture(shade(found, map_, errors), output)
        print(f"wrote {output}{_range(found, errors, map_)}")
    if hits is not None:
        save_hits(found, hits)
        print(f"wrote {hits}")


def _range(found: Hits, errors: Quality | None, map_: str) -> str:
    """What the ends of a map's colours stand for."""
    from jaart.core.maps import MAPS, scale

    if map_ in ("shaded", "status"):
        return ""
    low, high = scale(map_, found, errors)
    unit = f" {MAPS[map_].unit}" if MAPS[map_].unit else ""
    return f", colours from {low:g} to {high:g}{unit}, what lies beyond has the last colour"


def write_trace(followed: Trace, output: Path, up: tuple[float, float, float]) -> None:
    """Write one ray as .json, .csv or .svg, whichever the name says; up: the camera's, for the plots."""
    from jaart.core import export

    if output.suffix.lower() == ".json":
        export.save_trace_json(followed, output)
    elif output.suffix.lower() == ".csv":
        export.save_trace_csv(followed, output)
    else:
        from jaart.plot.trace import trace_figure

        save_figure(trace_figure(followed, up=up), output)


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure as SVG, the same bytes for the same figure."""
    import matplotlib

    from jaart.core.io.atomic import replacing

    with matplotlib.rc_context({"svg.hashsalt": "jaart"}), replacing(path) as part:
        figure.savefig(part, format="svg", metadata={"Date": None})
