"""What the commands say: a table of a scene, a line on a picture or a ray."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import jaart
from jaart.cli_options import DEFAULT_PRESET

if TYPE_CHECKING:
    from jaart.core.records import Hits, Quality, Trace
    from jaart.core.scene import Scene
    from jaart.core.settings import Settings


def versions() -> str:
    """The version, and those of what decides its results and its safety."""
    from importlib.metadata import version
    from pyexpat import EXPAT_VERSION

    return (f"jaart {jaart.__version__}\npython {platform.python_version()}, numpy {version('numpy')}, "
            f"numba {version('numba')}, {EXPAT_VERSION.replace('_', ' ')}")


def scene_record(scene: Scene) -> dict[str, Any]:
    """What a scene holds, in plain numbers and words; lengths in cells, spacing and origin as in the file."""
    from jaart.core.errors import SettingsError
    from jaart.core.notes import notes
    from jaart.core.settings import preset
    from jaart.core.suited import suited

    try:
        settings = suited(scene, preset(DEFAULT_PRESET))[0]
        said = notes(scene, settings)
    except SettingsError as error:  # a single point, which gives no length by default
        settings, said = preset(DEFAULT_PRESET), (str(error),)
    record = _cloud_record(scene) if scene.kind == "cloud" else _lattice_record(scene, settings)
    return record | {"notes": list(dict.fromkeys((*scene.notes, *said)))}


def _cloud_record(scene: Scene) -> dict[str, Any]:
    """Lengths in the cloud's own units; spacing: mean distance to the nearest point; h: what is proposed."""
    from jaart.core import cloud

    assert scene.points is not None
    low, high = cloud.bounds(scene)
    return {
        "source": scene.source, "kind": scene.kind, "points": len(scene.points), "normals": scene.normals is not None,
        "duplicates": scene.merged, "low": low.tolist(), "high": high.tolist(),
        "diagonal": cloud.diagonal(scene), "spacing": cloud.spacing(scene), "auto_h": cloud.auto_h(scene),
    }


def _lattice_record(scene: Scene, settings: Settings) -> dict[str, Any]:
    from jaart.core import filters, lattice, prepare

    levels = prepare.levels(scene, settings)
    surfels = prepare.surfels(scene, settings)
    interface = lattice.interface_cells(filters.filtered(levels, settings), settings.neighbours, settings.border)
    solids = None if scene.model is None else [_solid(s) for s in scene.model.solids]
    return {
        "source": scene.source, "kind": scene.kind, "size": list(levels.shape), "cells": int(levels.size),
        "interface_cells": len(interface), "surfels": len(surfels), "without_normal": surfels.without_normal,
        "levels": [float(levels.min()), float(levels.max())], "spacing": list(scene.spacing),
        "origin": list(scene.origin), "frame": scene.frame, "frames": scene.frames, "time": scene.time,
        "solids": solids,
    }


def scene_table(record: dict[str, Any]) -> str:
    """The same for people."""
    rows = (_cloud_rows if record["kind"] == "cloud" else _lattice_rows)(record)
    rows += [("note", note) for note in record["notes"]]
    return "\n".join([record["source"], *(f"  {name:<16} {value}" for name, value in rows)])


def _cloud_rows(record: dict[str, Any]) -> list[tuple[str, Any]]:
    size = " × ".join(f"{high - low:g}" for low, high in zip(record["low"], record["high"], strict=True))
    return [
        ("kind", record["kind"]),
        ("points", record["points"]),
        ("normals", "one for each point" if record["normals"] else "none"),
        ("size", f"{size}, diagonal {record['diagonal']:g}"),
        ("from", _words(record["low"])),
        ("to", _words(record["high"])),
        ("spacing", f"{record['spacing']:.4g}, mean distance to the nearest point"),
        ("proposed h", f"{record['auto_h']:.4g}"),
    ]


def _lattice_rows(record: dict[str, Any]) -> list[tuple[str, Any]]:
    time = "" if record["time"] is None else f", {record['time']:g} s"
    return [
        ("kind", record["kind"]),
        ("size", "×".join(str(n) for n in record["size"]) + f" = {record['cells']} cells"),
        ("interface cells", record["interface_cells"]),
        ("surfels", f"{record['surfels']}, {record['without_normal']} interface cells without a normal"),
        ("levels", "{:g} to {:g}".format(*record["levels"])),
        ("spacing", " × ".join(f"{v:g}" for v in record["spacing"])),
        ("origin", ", ".join(f"{v:g}" for v in record["origin"])),
        ("frame", f"{record['frame']} of 0 to {record['frames'] - 1}{time}"),
        *(("exact solid", " ".join(f"{k} {_words(v)}" for k, v in s.items())) for s in record["solids"] or ()),
    ]


def hits_line(hits: Hits, scene: Scene, quality: Quality | None = None) -> str:
    """One line on a picture or a list of rays, how the rays ended, and what they took of a cloud."""
    evaluations = hits.evaluations.sum() / max(1, len(hits))
    shape = f"{hits.size[0]}x{hits.size[1]}: " if hits.size else ""
    lines = [f"{shape}{int(hits.hit.sum())} of {len(hits)} rays hit, {evaluations:.2f} evaluations a ray, "
             f"prepared in {1000 * hits.prep_s:.0f} ms, traced in {1000 * hits.ray_s:.0f} ms",
             ", ".join(f"{count} {name}" for name, count in hits.counts().items()) or "no rays"]
    lines += _taken(hits) + _chosen(hits, scene)
    if quality is not None and not quality.relevant:
        lines.append("against the exact surface: no relevant rays, all show background and should")
    elif quality is not None:
        unit = "spacings" if scene.kind == "cloud" else "cells"
        lines.append(f"against the exact surface: delta {quality.delta:.4g}, delta_p {quality.delta_p:.4g} {unit}, "
                     f"delta_n {quality.delta_n:.4g}")
    return "\n  ".join(lines)


def _taken(hits: Hits) -> list[str]:
    """What a ray took on average, and what all of them took together."""
    mean = 1 / max(1, len(hits))
    each = [f"{mean * float(column.sum()):.2f} {noun}" for noun, column in (
        ("cells or balls", hits.cells), ("searches", hits.starts), ("surfels weighed", hits.neighbours))]
    parts = [_count(int(column.sum()), noun) for noun, column in (
        ("eigenvector", hits.eigenvectors), ("gradient", hits.gradients))]
    if hits.gathered:
        fits = f", {_count(hits.fits, 'fit')} at their centres beside the evaluations" if hits.fits else ""
        parts.append(f"{_count(hits.gathered, 'place')} gathered{fits}")
    if lowered := int(hits.lowered.sum()):
        parts.append(f"{_count(lowered, 'evaluation')} of a lower degree than {hits.settings.degree}")
    return [f"{', '.join(each)} a ray; {', '.join(parts)}"]


def _chosen(hits: Hits, scene: Scene) -> list[str]:
    """What a radius and a tolerance of `auto` came to, and why."""
    from jaart.core.chosen import chosen, explained, tolerance_unit
    from jaart.core.settings import PARAMETERS
    from jaart.core.visible import for_picture, of_hits

    auto = [name for name in ("radius", "tolerance")
            if getattr(hits.settings, name) == "auto" and PARAMETERS[name].matters(hits.settings)]
    parts = []
    if "radius" in auto:
        radius, why = explained(scene, of_hits(scene, hits))["radius"]
        parts.append(f"radius {radius:.4g}{'' if scene.kind == 'cloud' else ' cells'}, {why}")
    if "tolerance" in auto:
        number, why = for_picture(scene, hits.settings, hits.camera, hits.size)
        parts.append(f"tolerance {number:g} {tolerance_unit(chosen(scene, hits.settings))}, {why}")
    return ["auto: " + "; ".join(parts)] if parts else []


def say_notes(scene: Scene, settings: Settings, hits: Hits | None = None) -> None:
    """Say on stderr what a person should know of the scene with these settings, and of how its rays ended."""
    from jaart.core.notes import notes, of_hits

    note(notes(scene, settings))
    note(() if hits is None else of_hits(scene, hits))


def note(texts: Iterable[str]) -> None:
    """Say on stderr what is no error, a line each."""
    for text in texts:
        print(f"jaart: note: {text}", file=sys.stderr)


def trace_line(trace: Trace) -> str:
    """One line on a picked ray."""
    s = trace.summary()
    name = "ray" if trace.pixel is None else f"pixel {trace.pixel[0]},{trace.pixel[1]}"
    at = f" at t = {s['t']:.6g}, point {_words(trace.point)}" if trace.hit else ""
    balls = len(trace.balls)
    passed = f"{_count(balls, 'ball')} pierced" if balls else f"{_count(s['cells'], 'cell')} crossed"
    return f"{name}: {s['status']}{at}; {_count(s['steps'], 'step')} from {_count(s['starts'], 'start')}, " \
           f"{passed}"


def say_compiling(scene: Scene, settings: Settings, tracing: bool = False) -> None:
    """Say on stderr, the first time that kernels are needed on a machine, why nothing happens for some seconds.

    tracing: a single ray is to be followed.
    """
    from jaart.core.warm import needs_compile

    if needs_compile(scene, settings, tracing):
        print("Compiling kernels that are needed for the first time on this machine; this takes some seconds, once.",
              file=sys.stderr)


def _solid(solid: Any) -> dict[str, Any]:
    import dataclasses

    return {"shape": type(solid).__name__, **{k: _plain(v) for k, v in dataclasses.asdict(solid).items()}}


def _plain(value: Any) -> Any:
    return float(value) if isinstance(value, int | float) else [float(v) for v in value]


def _words(value: Any) -> str:
    if isinstance(value, str):
        return value
    return f"{value:g}" if isinstance(value, float) else "(" + ", ".join(f"{v:g}" for v in value) + ")"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
