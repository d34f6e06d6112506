"""The program's hits against 200 rays that were traced to 50 digits; `make.py` makes what is read here."""

from __future__ import annotations

import itertools
import json
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest

from jaart.core.render import render
from tests.reference import make, scenes
from tests.reference.rays import Ray, rays
from tests.reference.tangent import Array, mpf
from tests.reference.tracer import Tracer

KEPT = json.loads(make.FILE.read_text())
ROWS: list[dict[str, Any]] = KEPT["rays"]
STORED = scenes.stored(KEPT["scenes"])
SEARCHES = ("safe", "newton", "secant", "iterate")
TOLERANCES = (1e-14, 0.0)
EPS = 2.0**-52
#: A hit farther off than this, in h, is another root.
OTHER = 1e-3


def vector(texts: str) -> Array:
    return np.array([float(mpf(text)) for text in texts.split()])


@dataclass
class Answers:
    """The program's answers to all rays, in the file's order; lengths in h.

    hit, expected: whether a ray hit, and had to; error: of t; rounding: what float64 leaves of t; turned: sine of the
    angle between normals; ulps: error of the point in units of its last place, beyond that of t.
    """

    hit: Array
    expected: Array
    error: Array
    rounding: Array
    turned: Array
    ulps: Array

    @property
    def same(self) -> Array:
        """The rays whose hit is the reference's root."""
        result: Array = self.hit & self.expected & (self.error < OTHER)
        return result


def stratum(*names: str) -> Array:
    return np.array([row["stratum"] in names for row in ROWS])


@cache
def answers(search: str, tolerance: float) -> Answers:
    columns = np.full((6, len(ROWS)), np.nan)
    for name, normal in itertools.product(scenes.NAMES, scenes.NORMALS):
        numbers = [i for i, row in enumerate(ROWS) if (row["scene"], row["normal"]) == (name, normal)]
        scene, settings = scenes.program(name, STORED[name], normal)
        o, d = (scenes.read([ROWS[i][key] for i in numbers]) for key in ("origin", "direction"))
        hits = render(scene, settings.replace(search=search, tolerance=tolerance), rays=(o, d))
        assert (hits.direction == d).all()
        h, middle = STORED[name].surface(name, normal).h, STORED[name].points.mean(axis=0)
        for at, i in enumerate(numbers):
            answer = (hits.hit[at], hits.t[at], hits.normal[at], hits.point[at])
            columns[:, i] = compared(ROWS[i], o[at], d[at], answer, h, middle)
    return Answers(columns[0] == 1, columns[1] == 1, *columns[2:])


def compared(row: dict[str, Any], o: Array, d: Array, answer: Any, h: float, middle: Array) -> tuple[float, ...]:
    """One column of `answers`."""
    hit, t, n, point = answer
    kept = row["hit"]
    if kept is None or not hit:
        return float(hit), float(kept is not None), np.nan, np.nan, np.nan, np.nan
    exact, slope = mpf(kept["t"]), abs(float(mpf(kept["slope"])))
    error = float(abs(mpf(float(t)) - exact))
    rounding = EPS * (np.abs(o - middle).max() + abs(t) + h) / slope
    places = [mpf(float(p)) + exact * mpf(float(q)) for p, q in zip(o, d, strict=True)]
    off = [float(abs(mpf(float(p)) - c)) - 2 * error - rounding for p, c in zip(point, places, strict=True)]
    return (1.0, 1.0, error / h, rounding / h, float(np.linalg.norm(np.cross(vector(kept["n"]), n))),
            float(max(np.array(off) / np.spacing(np.abs(point)))))


def test_the_rays_are_stratified_as_they_say() -> None:
    names = [row["stratum"] for row in ROWS]
    assert {name: names.count(name) for name in set(names)} == {"uniform": 100, "grazing": 50, "aligned": 25, "far": 25}
    margins = np.array([float(row["margin"]) for row in ROWS if row["margin"]])
    hit = np.array([row["hit"] is not None for row in ROWS if row["margin"]])
    assert len(margins) == 50
    assert ((margins < 0) == hit).all()
    assert 24 <= hit.sum() <= 26
    assert 1e-6 <= np.abs(margins).min() < 1e-5
    assert 0.3 < np.abs(margins).max() <= 1
    for name in set(names):
        assert {row["hit"] is None for row in ROWS if row["stratum"] == name} == {True, False}


def test_the_scenes_are_those_of_the_script() -> None:
    lattice = scenes.made("lattice")
    assert np.array_equal(lattice.points, STORED["lattice"].points)
    assert np.array_equal(lattice.normals, STORED["lattice"].normals)
    for name in ("cloud", "moved"):  # whose points take a sine and an exponential from the machine
        np.testing.assert_allclose(scenes.made(name).points, STORED[name].points, rtol=1e-15, atol=1e-14)


def test_the_script_makes_these_rays_and_answers() -> None:
    for ray, kept in zip(itertools.islice(rays(STORED), 3), ROWS, strict=False):
        assert make.row(ray, STORED) == kept


@pytest.mark.parametrize("name", ["grazing", "far"])
def test_the_script_gives_kept_rays_these_answers(name: str) -> None:
    kept = [row for row in ROWS if row["stratum"] == name and row["hit"]][-1]
    o, d = scenes.read([kept["origin"], kept["direction"]])
    tracer = Tracer(STORED[kept["scene"]].surface(kept["scene"], kept["normal"]))
    assert make.answer(tracer, Ray(name, kept["scene"], kept["normal"], np.nan, o, d)) == kept["hit"]


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_the_safe_search_hits_and_misses_with_the_reference(tolerance: float) -> None:
    found = answers("safe", tolerance)
    assert np.array_equal(found.hit, found.expected)
    assert np.array_equal(found.same, found.expected)


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("search", ["newton", "secant"])
def test_newton_and_secant_do_so_away_from_silhouettes(search: str, tolerance: float) -> None:
    """A plane kept at a ball's centre may pass by a ray that grazes the surface elsewhere in the ball."""
    found, away = answers(search, tolerance), ~stratum("grazing")
    assert not (found.hit & ~found.expected).any() and (found.expected & ~found.hit).sum() <= 1
    assert np.array_equal(found.same[away], found.expected[away])


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_iterate_finds_another_root_for_one_ray_and_loses_grazing_ones(tolerance: float) -> None:
    """At a silhouette the iteration is Newton's method for t² + c² = 0: it may end on the rear side, or not at all."""
    found, grazing = answers("iterate", tolerance), stratum("grazing")
    assert not (found.hit & ~found.expected).any()
    assert (found.expected & ~found.same)[~grazing].sum() <= 1
    assert 1 <= (found.expected & ~found.same)[grazing].sum() <= 15


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("search", SEARCHES)
def test_t_is_right_to_what_float64_leaves_of_it(search: str, tolerance: float) -> None:
    """Whatever the cloud's place: its own frame takes the offset away."""
    found = answers(search, tolerance)
    same = found.same
    assert same.sum() >= 100
    assert (found.error[same] <= found.rounding[same] + tolerance).all()


@pytest.mark.parametrize("search", SEARCHES)
def test_uniform_rays_reach_the_floor(search: str) -> None:
    found = answers(search, 1e-14)
    same = found.same & stratum("uniform")
    assert same.sum() >= 66
    assert found.error[same].max() <= 1e-14


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("search", SEARCHES)
def test_normals_are_right_to_rounding_and_to_what_t_is_off(search: str, tolerance: float) -> None:
    found = answers(search, tolerance)
    same = found.same
    assert (found.turned[same] <= 30 * (1e-15 + found.error[same])).all()


@pytest.mark.parametrize("search", SEARCHES)
def test_a_point_is_off_by_half_of_its_last_place_beyond_t(search: str) -> None:
    found = answers(search, 1e-14)
    assert found.ulps[found.same].max() <= 0.51
