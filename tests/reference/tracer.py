"""The first hit of a ray to 50 digits: looked for everywhere in float64, then a root of mpmath's f, proved by signs.

A ray is x(t) = o + t·d with o and d the exact numbers that the floats are, so t counts in |d|. A root is a hit where f
falls along n, the off-centre value is at most h and the nearest surfel at most 1.5 h away: the program's own bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.reference.tangent import MP, Array, Exact, Place, Quick, Tangent, dot, mpf

#: Bounds of a hit, in h.
OFF_CENTRE, NEAREST = 1.0, 1.5
#: Length of the steps of the first look, in h, parts of each finer one, and how often a dip is looked into.
STEP, PARTS, DEPTH = 1 / 32, 24, 6
#: A dip that stays this close to 0, in h, could be either in float64.
DOUBTFUL = 1e-11
#: Half a bracket that proves a root, in h, and the width of its difference quotients.
PROOF, WIDTH = mpf("1e-45"), mpf("1e-20")
#: f of a float64 root is this close to 0 at most, in h, else f jumps there.
JUMP = 1e-9


class Doubtful(Exception):
    """A ray that float64 cannot tell a hit or a miss."""


@dataclass(frozen=True)
class Hit:
    """A hit: t, the unit normal n, the off-centre value, and f's slope along the ray."""

    t: Any
    n: Exact
    off: Any
    slope: Any


class Tracer:
    """Rays against one surface."""

    def __init__(self, surface: Tangent) -> None:
        self.surface, self.quick = surface, Quick(surface)
        self.reach = float(np.linalg.norm(self.quick.points, axis=1).max()) + NEAREST * surface.h

    def hit(self, o: Array, d: Array) -> Hit | None:
        """The first hit of a ray with t > 0, None for none."""
        found = self.guess(o, d)
        return None if found is None else self.refined(o, d, found)

    def guess(self, o: Array, d: Array) -> float | None:
        """The same t in float64, good to about 1e-12 h where the ray does not graze."""
        start = o - self.quick.middle
        foot = -float(start @ d) / float(d @ d)
        aside = float(np.linalg.norm(start + foot * d))
        if aside > self.reach:
            return None
        base, half = start + foot * d, float(np.sqrt(self.reach**2 - aside**2))
        low = max(-half, -foot)
        count = max(round((half - low) / (STEP * self.surface.h)), 2) if low < half else 0
        s = self._first(base, d, low, half, count, DEPTH) if count else None
        return None if s is None else foot + s

    def _first(self, base: Array, d: Array, low: float, high: float, count: int, depth: int) -> float | None:
        """The first hit in a stretch of base + s·d, by a look at count steps and a closer one into each dip."""
        s = np.linspace(low, high, count + 1)
        f, n, _, nearest = self.quick.at(base + s[:, None] * d)
        near = nearest <= NEAREST * self.surface.h * (1 + 2 * STEP)
        for k in range(count):
            smooth = near[k] and near[k + 1] and n[k] @ n[k + 1] > 0
            if smooth and (f[k] > 0) != (f[k + 1] > 0):
                root = self._bisected(base, d, s[k], s[k + 1], f[k])
                if self._is_hit(base + root * d):
                    return root
            elif k > 0 and near[k] and abs(f[k]) <= min(abs(f[k - 1]), abs(f[k + 1])) and (f[k - 1] > 0) == (f[k] > 0):
                inner = self._dip(base, d, s[k - 1], s[k + 1], f[k], depth)
                if inner is not None:
                    return inner
        return None

    def _dip(self, base: Array, d: Array, low: float, high: float, least: float, depth: int) -> float | None:
        """The first hit where |f| is least between two places of one sign; refuses what float64 cannot tell."""
        if depth > 0:
            return self._first(base, d, low, high, PARTS, depth - 1)
        if abs(least) < DOUBTFUL * self.surface.h:
            raise Doubtful(f"f comes as close to 0 as {least / self.surface.h:.1e} h: no ray for a reference")
        return None

    def _bisected(self, base: Array, d: Array, low: float, high: float, f_low: float) -> float:
        while low < (middle := (low + high) / 2) < high:
            same = (self.quick.at((base + middle * d)[None])[0][0] > 0) == (f_low > 0)
            low, high = (middle, high) if same else (low, middle)
        return float(low)

    def _is_hit(self, x: Array) -> bool:
        """Whether a root is on a sheet, within the bounds."""
        h = self.surface.h
        f, n, off, nearest = (values[0] for values in self.quick.at(x[None]))
        beside, turned, _, _ = self.quick.at(np.stack((x + 1e-6 * h * n, x - 1e-6 * h * n)))
        falls = beside[0] < beside[1] and (turned @ n > 0).all()
        return bool(falls and abs(f) < JUMP * h and off <= OFF_CENTRE * h and nearest <= NEAREST * h)

    def refined(self, o: Array, d: Array, t: float) -> Hit:
        """The root near t to all digits: secant steps, then a change of sign that proves it."""
        h = mpf(self.surface.h)
        a, b = mpf(t), mpf(t) + h * mpf("1e-9")
        f_a, f_b = self.place(o, d, a).f, self.place(o, d, b).f
        for _ in range(60):
            a, b, f_a = b, b - f_b * (b - a) / (f_b - f_a), f_b
            f_b = self.place(o, d, b).f
            if abs(b - a) < h * PROOF * mpf("1e-3"):
                break
        before, after = (self.place(o, d, b + side * h * PROOF).f for side in (-1, 1))
        if (before > 0) == (after > 0) or abs(b - mpf(t)) > h * mpf("1e-4"):
            raise Doubtful(f"no root is proved near t = {t!r}")
        width = h * WIDTH
        slope = (self.place(o, d, b + width).f - self.place(o, d, b - width).f) / (2 * width)
        here = self.place(o, d, b)
        return Hit(b, here.n, MP.sqrt(dot(here.off, here.off)), slope)

    def place(self, o: Array, d: Array, t: Any) -> Place:
        """The surface at o + t·d."""
        return self.surface.at([mpf(float(p)) + t * mpf(float(q)) for p, q in zip(o, d, strict=True)])
