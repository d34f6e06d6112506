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
from jaart.core.io.atomic import replacing
from jaart.core.records import STATUS_NAMES, Hits, Trace
from jaart.core.settings import PARAMETERS, Settings
from jaart.core.surfels import Surfels

Target = str | PathLike[str]

#: The vectors of a step, by the name of their columns.
_VECTORS = {"query": "query", "barycentre": "barycentre", "normal": "step_normal", "next": "next_point"}
_PER_RAY = ("origin", "direction", "hit", "t", "point", "normal", "status", "off_centre", "energy", "iterations",
            "evaluations", "neighbours", "cells")


def save_picture(picture: NDArray[np.uint8], path: Target) -> None:
    """Write an (h, w, 3) picture as PNG."""
    from PIL import Image

    with replacing(Path(path)) as part:
        Image.fromarray(picture).save(part, format="PNG")


def hits_arrays(hits: Hits) -> dict[str, Any]:
    """Everything of the hits by name: one row a ray, the names of the end states, prep_s and ray_s."""
    return {**{name: getattr(hits, name) for name in _PER_RAY}, "status_names": np.array(STATUS_NAMES),
            "prep_s": hits.prep_s, "ray_s": hits.ray_s}


def save_hits(hits: Hits, path: Target) -> None:
    """Write the hits as .npz (see `hits_arrays`)."""
    with replacing(Path(path)) as part, part.open("wb") as file:
        np.savez(file, **hits_arrays(hits))


def trace_record(trace: Trace) -> dict[str, Any]:
    """One ray in plain lists and numbers: all of its Trace, with the surfels that it used; NaN becomes None.

    Neighbours are the numbers of surfels in the scene, as is surfels.index.
    """
    return {
        "jaart": jaart.__version__, "pixel": _plain(trace.pixel), "extent": _plain(trace.extent),
        "settings": settings_record(trace.settings),
        "ray": _fields(trace, "origin", "direction", "status", "t", "point", "normal"),
        "steps": [_step(trace, i) for i in range(trace.steps)],
        "cells": _fields(trace, "cells", "borders", "with_surfel"),
        "curves": _fields(trace.curves, "t", "tangent", "off_centre", "mahalanobis"),
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
    """The steps of a ray as rows, the header first; lengths in cells, neighbours counted."""
    header = ["step", "start", "outcome", "cell_i", "cell_j", "cell_k", "t_query", "t_next"]
    header += [f"{name}_{axis}" for name in _VECTORS for axis in "xyz"]
    return [[*header, "energy", "off_centre", "weight_sum", "neighbours"]] + [
        [i, trace.start[i], trace.outcome[i], *trace.step_cell[i],
         *("" if math.isnan(v) else repr(float(v)) for v in _numbers(trace, i)), len(trace.neighbours[i])]
        for i in range(trace.steps)]


def settings_record(settings: Settings) -> dict[str, Any]:
    """The settings by name as numbers, words and lists; a length is a text such as "0.8" or "2s"."""
    values = {name: getattr(settings, name) for name in PARAMETERS}
    return {name: str(value) if PARAMETERS[name].kind == "length" else _plain(value) for name, value in values.items()}


def _numbers(trace: Trace, i: int) -> list[float]:
    vectors = [getattr(trace, field)[i] for field in _VECTORS.values()]
    return [trace.t_query[i], trace.t_next[i], *np.concatenate(vectors),
            trace.energy[i], trace.off_centre[i], trace.weight_sum[i]]


def _step(trace: Trace, i: int) -> dict[str, Any]:
    fields = ("start", "outcome", "t_query", "t_next", "energy", "off_centre", "weight_sum", "neighbours", "weights")
    return {"step": i, "cell": _plain(trace.step_cell[i])} | {
        name: _plain(getattr(trace, name)[i]) for name in fields} | {
        name: _plain(getattr(trace, field)[i]) for name, field in _VECTORS.items()}


def _used_surfels(surfels: Surfels, neighbours: tuple[NDArray[np.int64], ...]) -> dict[str, Any]:
    index = np.unique(np.concatenate([np.empty(0, np.int64), *neighbours]))
    return {"total": len(surfels), "index": _plain(index), "cell": _plain(surfels.cells[index]),
            "point": _plain(surfels.points[index]), "normal": _plain(surfels.normal[index])}


def _fields(record: object, *names: str) -> dict[str, Any]:
    return {name: _plain(getattr(record, name)) for name in names}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
