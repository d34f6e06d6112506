"""Results to files: pictures, hits, and one ray with all its steps."""

from __future__ import annotations

import csv
import json
import math
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import jaart
from jaart.core.cloud_surfels import Points
from jaart.core.io.atomic import replacing
from jaart.core.records import STATUS_NAMES, Hits, Trace
from jaart.core.settings import PARAMETERS, Settings
from jaart.core.statistics import Statistics, table
from jaart.core.surfels import Surfels
from jaart.core.telling import doing

Target = str | PathLike[str]

#: The vectors of a step, by the name of their columns.
_VECTORS = {"query": "query", "barycentre": "barycentre", "normal": "step_normal", "next": "next_point"}
_PER_RAY = ("origin", "direction", "hit", "t", "point", "normal", "status", "off_centre", "energy", "iterations",
            "evaluations", "neighbours", "cells", "lowered", "gap", "starts", "eigenvectors", "gradients")


@doing("writing the picture")
def save_picture(picture: NDArray[np.uint8], path: Target) -> None:
    """Write an (h, w, 3) picture as PNG."""
    from PIL import Image

    with replacing(Path(path)) as part:
        Image.fromarray(picture).save(part, format="PNG")


def hits_arrays(hits: Hits) -> dict[str, Any]:
    """Everything of the hits by name: one row a ray, then the names of the end states, prep_s, ray_s, gathered, fits
    and the text shading_normal, which says what `normal` holds.
    """
    return {**{name: getattr(hits, name) for name in _PER_RAY}, "status_names": np.array(STATUS_NAMES),
            "prep_s": hits.prep_s, "ray_s": hits.ray_s, "gathered": hits.gathered, "fits": hits.fits,
            "shading_normal": hits.settings.shading_normal}


@doing("writing the hits")
def save_hits(hits: Hits, path: Target) -> None:
    """Write the hits as .npz (see `hits_arrays`)."""
    with replacing(Path(path)) as part, part.open("wb") as file:
        np.savez(file, **hits_arrays(hits))


def trace_record(trace: Trace) -> dict[str, Any]:
    """One ray in plain lists and numbers: all of its Trace, with the surfels that it used; NaN becomes None.

    Neighbours are the numbers of surfels in the scene, as is surfels.index. A step on a lattice names its cell, one
    in a cloud its ball by the number in balls, None for one that rounding put beside the ray.
    """
    return {
        "jaart": jaart.__version__, "pixel": _plain(trace.pixel), "extent": _plain(trace.extent),
        "low": _plain(trace.low), "high": _plain(trace.high),
        "settings": settings_record(trace.settings),
        "ray": _fields(trace, "origin", "direction", "status", "t", "point", "normal"),
        "steps": [_step(trace, i) for i in range(trace.steps)],
        "cells": _fields(trace, "cells", "borders", "with_surfel"), "balls": _plain(trace.balls),
        "curves": _fields(trace.curves, "t", "tangent", "off_centre", "mahalanobis", "angle"),
        "surfels": _used_surfels(trace.surfels, trace.neighbours),
    }


def save_trace_json(trace: Trace, path: Target) -> None:
    """Write one ray as JSON (see `trace_record`)."""
    with replacing(Path(path)) as part:
        part.write_text(json.dumps(trace_record(trace), allow_nan=False) + "\n", encoding="utf-8")


def save_trace_csv(trace: Trace, path: Target) -> None:
    """Write one row for each step of a ray as CSV; an empty field is NaN."""
    with replacing(Path(path)) as part, part.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(trace_rows(trace))


def trace_rows(trace: Trace) -> list[list[Any]]:
    """The steps of a ray as rows, the header first; lengths in cells or cloud units, neighbours counted."""
    place = ["ball"] if _in_cloud(trace) else ["cell_i", "cell_j", "cell_k"]
    header = ["step", "start", "outcome", *place, "t_query", "t_next"]
    header += [f"{name}_{axis}" for name in _VECTORS for axis in "xyz"]
    return [[*header, "energy", "off_centre", "angle", "weight_sum", "neighbours"]] + [
        [i, trace.start[i], trace.outcome[i], *_number(_place(trace, i)),
         *("" if math.isnan(v) else repr(float(v)) for v in _numbers(trace, i)), len(trace.neighbours[i])]
        for i in range(trace.steps)]


def save_statistics_csv(statistics: Statistics, path: Target) -> None:
    """Write the statistics of a picture as CSV (see `statistics.table`)."""
    with replacing(Path(path)) as part, part.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(table(statistics))


def settings_record(settings: Settings) -> dict[str, Any]:
    """The settings by name as numbers, words and lists; a length is a text such as "0.8" or "2s"."""
    values = {name: getattr(settings, name) for name in PARAMETERS}
    return {name: str(value) if PARAMETERS[name].kind == "length" else _plain(value) for name, value in values.items()}


def _in_cloud(trace: Trace) -> bool:
    return isinstance(trace.surfels, Points)


def _place(trace: Trace, i: int) -> list[int] | int | None:
    """The cell of a step, or the number of its ball."""
    cell: list[int] = trace.step_cell[i].tolist()
    return (cell[0] if cell[0] >= 0 else None) if _in_cloud(trace) else cell


def _number(place: list[int] | int | None) -> list[Any]:
    return place if isinstance(place, list) else ["" if place is None else place]


def _angle(trace: Trace, i: int) -> float:
    """|<c/|c|, n>| of a step, c = a(x) - x [T 2.23]; NaN where c vanishes."""
    off = trace.barycentre[i] - trace.query[i]
    size = float(np.linalg.norm(off))
    return abs(float(off @ trace.step_normal[i])) / size if size > 0 else math.nan


def _numbers(trace: Trace, i: int) -> list[float]:
    vectors = [getattr(trace, field)[i] for field in _VECTORS.values()]
    return [trace.t_query[i], trace.t_next[i], *np.concatenate(vectors), trace.energy[i], trace.off_centre[i],
            _angle(trace, i), trace.weight_sum[i]]


def _step(trace: Trace, i: int) -> dict[str, Any]:
    fields = ("start", "outcome", "t_query", "t_next", "energy", "off_centre", "weight_sum", "neighbours", "weights")
    return {"step": i, "ball" if _in_cloud(trace) else "cell": _place(trace, i), "angle": _plain(_angle(trace, i))} | {
        name: _plain(getattr(trace, name)[i]) for name in fields} | {
        name: _plain(getattr(trace, field)[i]) for name, field in _VECTORS.items()}


def _used_surfels(surfels: Surfels | Points, neighbours: tuple[NDArray[np.int64], ...]) -> dict[str, Any]:
    index = np.unique(np.concatenate([np.empty(0, np.int64), *neighbours]))
    cells = {"cell": _plain(surfels.cells[index])} if isinstance(surfels, Surfels) else {}
    normal = surfels.normal[index]
    known = np.where(normal.any(axis=1, keepdims=True), normal, np.nan)
    return {"total": len(surfels), "index": _plain(index), **cells,
            "point": _plain(surfels.points[index]), "normal": _plain(known)}


def _fields(record: object, *names: str) -> dict[str, Any]:
    return {name: _plain(getattr(record, name)) for name in names}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
