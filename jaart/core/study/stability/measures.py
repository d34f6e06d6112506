"""Rows 67 to 70: what is measured where nothing can be, and solids below the resolution."""

from __future__ import annotations

import json
import math

import numpy as np

from jaart.core import prepare
from jaart.core.export import trace_record
from jaart.core.notes import notes
from jaart.core.quality import angles, quality, terms
from jaart.core.records import Hits
from jaart.core.scene import Array, Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Box, Solid, Sphere
from jaart.core.statistics import statistics, table
from jaart.core.study.stability.case import Outcome, case, counted
from jaart.core.study.stability.scenes import shot
from jaart.core.trace import trace

RASTER = 16


@case(67, "δ of rays that all show background, and should",
      "no relevant rays: no δ in a table, null for what is not defined in JSON")
def delta_of_no_relevant_ray() -> Outcome:
    """δ itself is in no JSON; one ray is, and its numbers that are not defined are null there."""
    scene, settings = _scene(Sphere((0.5, 0.5, 0.5), 0.25)), Settings()
    past = np.array([30.0, 8.0, 8.0]), np.array([0.0, 0.0, 1.0])
    hits = shot(scene, settings, *past)
    errors = quality(hits, scene)
    assert errors is not None
    rows = {name: value for name, _, value in table(statistics(hits, errors))}
    text = json.dumps(trace_record(trace(scene, settings, *past)), allow_nan=False)
    empty = [name for name in ("delta", "delta_p", "delta_n") if rows[name] == ""]
    return Outcome(f"{errors.relevant} relevant, {len(empty)} of 3 fields empty, t of the ray "
                   f"{json.loads(text)['ray']['t']}", errors.relevant == 0 and rows["relevant"] == 0
                   and len(empty) == 3 and json.loads(text)["ray"]["t"] is None and "NaN" not in text)


@case(68, "an angle of 1e-9 rad between two normals, and one of π - 1e-9", "1e-9 rad; 1 - <a, b> = 5e-19")
def nearly_equal_normals() -> Outcome:
    """atan2(|a × b|, <a, b>) for the angle, 2 sin²(α/2) for 1 - cos α [T 3.5]."""
    turn = 1e-9
    up, aside = np.array([[0.0, 0.0, 1.0]]), np.array([[math.sin(turn), 0.0, math.cos(turn)]])
    small, large = float(angles(up, aside)[0]), float(angles(up, -aside)[0])
    bent = float(terms(np.zeros(1), np.array([small]), np.zeros(1))[2][0])
    error = abs(math.radians(small) - turn), abs(math.pi - math.radians(large) - turn)
    return Outcome(f"{math.radians(small):.16g} rad, π - {math.pi - math.radians(large):.9g}; 1 - <a, b> = {bent:g}",
                   error[0] <= 1e-24 and error[1] <= 4.5e-16 and abs(bent - turn * turn / 2) <= 1e-33)


@case(69, "solids that overlap: boxes and spheres that share a part, and a sphere given twice",
      "what two of them hold counts once: the volume of the union")
def solids_that_overlap() -> Outcome:
    """By lengths each level is found to 1e-6; the vote of corners takes a second copy for no more than the first."""
    ball = Sphere((0.5, 0.5, 0.5), 0.25)
    boxes = _levels(Box((0.5, 0.5, 0.5), (0.4, 0.4, 0.4)), Box((0.6, 0.5, 0.5), (0.4, 0.4, 0.4)))
    balls = _levels(ball, Sphere((0.6, 0.5, 0.5), 0.25))
    exact = np.array((0.5 * 0.4 * 0.4, 2 * 4 / 3 * math.pi * 0.25 ** 3 - _lens(0.25, 0.1))) * RASTER ** 3
    errors = np.abs((boxes.sum(), balls.sum()) - exact)
    twice, votes = (float(np.abs(_levels(ball, ball, filling=how) - _levels(ball, filling=how)).max())
                    for how in ("accurate", "corners"))
    return Outcome(f"boxes: {errors[0]:.1e} cells off, spheres: {errors[1]:.1e} cells off; given twice a level changes "
                   f"by {twice:.1e} at most, a vote by {votes:g}",
                   bool(errors[0] <= 1e-9 and errors[1] <= 1e-4 and twice <= 1e-6 and votes == 0.0))


@case(70, "a sphere of diameter 0.3 cells, about a corner of 8 cells and within a cell",
      "a note; about the corner 8 surfels whose normals are those of the sphere, within a cell none and no hit")
def sphere_smaller_than_a_cell() -> Outcome:
    """The rule of [T fig. 2.22]: a bubble has normals only where it covers 8 cells."""
    corner, cell = (_scene(Sphere((middle / RASTER,) * 3, 0.15 / RASTER)) for middle in (8.0, 8.5))
    covered, within = (prepare.surfels(scene, Settings()) for scene in (corner, cell))
    outward = (covered.cells + 0.5 - 8) / math.sqrt(0.75)
    off = float(np.abs(covered.normal - outward).max())
    said = [text for scene in (corner, cell) for text in notes(scene, Settings()) if "thinner than a cell" in text]
    bubble = _down(corner, Settings(method="mahalanobis", level=0.2))
    nothing = _down(cell, Settings())
    return Outcome(f"{len(covered)} surfels, normals to {off:.0e}, {bubble.hit.sum()} hit at level 0.2; within a cell "
                   f"{len(within)} surfels, {counted(nothing.counts())}; note: {said[0]}",
                   bool(len(covered) == 8 and off <= 1e-12 and bubble.hit.all() and len(within) == 0
                        and nothing.counts() == {"background": 1} and len(said) == 2))


def _scene(*solids: Solid) -> Scene:
    return Scene("solids", model=Model(solids, RASTER))


def _levels(*solids: Solid, filling: str = "accurate") -> Array:
    return prepare.levels(_scene(*solids), Settings(filling=filling))


def _down(scene: Scene, settings: Settings) -> Hits:
    """A ray straight down, a tenth of a cell beside the middle of the lattice."""
    return shot(scene, settings, (8.1, 8.05, 30.0), (0.0, 0.0, -1.0))


def _lens(radius: float, apart: float) -> float:
    """The volume that two balls share."""
    return math.pi * (2 * radius - apart) ** 2 * (apart * apart + 4 * apart * radius) / (12 * apart)
