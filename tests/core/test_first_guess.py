"""A polynomial at each cell's centre says where a search begins: sooner to the same hits."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core import prepare
from jaart.core.addresses import address_of
from jaart.core.camera import Camera
from jaart.core.extents import bounds
from jaart.core.kernels import call
from jaart.core.kernels import records as r
from jaart.core.kernels.first_guess import guess, keeps_away
from jaart.core.kernels.guess import GUESS_WIDTH, write_guess
from jaart.core.kernels.records import FIT_SIZE, Out, Start, Value
from jaart.core.kernels.stepping import step_search
from jaart.core.render import render
from jaart.core.scene import Model, Scene
from jaart.core.settings import Settings
from jaart.core.shapes import Sphere, Torus
from jaart.core.tiles import columns_for
from jaart.core.tracers import LatticeTracer

SCENE = Scene("ball and ring", model=Model((Sphere((0.3, 0.35, 0.4), 0.2), Torus((0.6, 0.6, 0.6), (0.0, 0.6, 0.8), 0.2,
                                                                                0.08)), 32))
NAN = float("nan")


def both(settings: Settings) -> tuple[Out, Out, int]:
    """A picture with first guesses, the same where each search begins where the ray enters a cell, and the fits."""
    size = (80, 80)
    hits = render(SCENE, settings, Camera.fit(bounds(SCENE, settings), size=size), size)
    tracer = prepare.prepared(SCENE, settings).tracer
    assert isinstance(tracer, LatticeTracer) and tracer.centres is not None
    made, plain = columns_for(len(hits)), columns_for(len(hits))
    tracer.trace(hits.origin, hits.direction, np.arange(len(hits)), made)
    plan = tracer.plan._replace(search=address_of(step_search, call.SEARCH))
    LatticeTracer(lambda: tracer.cells, plan).trace(hits.origin, hits.direction, np.arange(len(hits)), plain)
    return made, plain, hits.fits


@pytest.mark.parametrize("search", ["iterate", "secant", "newton"])
@pytest.mark.parametrize("method", ["polynomial", "projection"])
def test_fewer_evaluations_lead_to_the_same_hits(method: str, search: str) -> None:
    made, plain, fits = both(Settings(method=method, search=search, tolerance=1e-6))
    one, other = made.status == r.CONVERGED, plain.status == r.CONVERGED
    assert one.sum() > 500 and (one != other).sum() <= 0.004 * one.sum()
    assert (other & ~one).sum() <= (one & ~other).sum() + 1  # what is lost at silhouettes beyond what is won there
    apart = np.abs(made.t - plain.t)[one & other]
    assert np.mean(apart > 0.05) < 0.01  # where a ray grazes the surface it meets it twice
    assert made.evaluations.sum() + fits < 0.75 * plain.evaluations.sum()
    assert made.starts.sum() < plain.starts.sum()


def row_of(n: tuple[float, float, float], height: float, state: int = r.CONTINUE) -> np.ndarray:
    """What is kept of a plane at a centre."""
    row = np.zeros(GUESS_WIDTH)
    write_guess(row, Value(state, height, n, (0.0, 0.0, 0.0), 1.0, 0.0, (NAN, NAN, NAN), 0), np.zeros(FIT_SIZE))
    return row


@pytest.mark.parametrize(("height", "direction", "expected"), [
    (0.2, (0.0, 0.0, -1.0), 0.3),  # from 0.5 down to the plane z = 0.2
    (0.9, (0.0, 0.0, -1.0), -0.4), (1.1, (0.0, 0.0, -1.0), NAN),  # behind where the ray enters, by no more than h/2
    (-1.9, (0.0, 0.0, -1.0), 2.4), (-2.1, (0.0, 0.0, -1.0), NAN),
    (0.45, (1.0, 0.0, 0.0), NAN), (0.5, (1.0, 0.0, 0.0), 0.0)])
def test_where_a_search_begins(height: float, direction: tuple[float, float, float], expected: float) -> None:
    start = Start((1, 1, 1), (0.0, 0.0, 0.5), 5.0, 0.0, -3.0, 3.0, NAN, 0)
    found = guess(row_of((0.0, 0.0, 1.0), height), start, direction, 1.0)
    assert found == pytest.approx(expected, abs=1e-12, nan_ok=True)


def test_where_no_surface_is_known_a_search_begins_at_the_border() -> None:
    start = Start((1, 1, 1), (0.0, 0.0, 0.5), 5.0, 0.0, -3.0, 3.0, NAN, 0)
    assert guess(row_of((0.0, 0.0, 1.0), 9.0, r.UNDEFINED_NORMAL), start, (0.0, 0.0, -1.0), 1.0) == 0.0


def test_what_keeps_away_is_on_one_side() -> None:
    row = row_of((0.0, 0.0, 1.0), 0.0)
    assert keeps_away(row, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), -5.0, 5.0)
    assert keeps_away(row, (0.0, 0.0, 1.0), (0.0, 0.6, -0.8), -5.0, 1.2)
    assert not keeps_away(row, (0.0, 0.0, 1.0), (0.0, 0.6, -0.8), -5.0, 1.3)
