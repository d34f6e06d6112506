"""A ray through a cloud: a tree walked along it, the balls it pierces in order, a search in each [A §5].

All that waits its turn lies in one heap, the nearest first: nodes of the tree and balls by where the ray enters
them, then what the balls promise: the ray's hit with the plane or polynomial kept at their centres. So the first
promise that comes up is the first hit, up to what two sheets closer than a quarter of h would hide.
"""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core.kernels import records as r
from jaart.core.kernels.address import floats_at, load
from jaart.core.kernels.blocks import FITTED, GATHERER, KEPT, MORE, fetch_surfels, is_short, kept_in, publish, take_back
from jaart.core.kernels.bundle import (
    ALONE,
    MOST,
    Cone,
    Listed,
    Room,
    cone_about,
    horizon,
    last_of,
    list_more,
    next_size,
    nothing_listed,
    push_pierced,
    unowned_room,
)
from jaart.core.kernels.call import evaluate_at, gather_at, search_from
from jaart.core.kernels.counts import forget_counts, write_counts
from jaart.core.kernels.guess import GUESS_WIDTH, STATE, is_near, meets, show_centre, write_guess
from jaart.core.kernels.heap import push
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.leaving import Leave, counting, leave
from jaart.core.kernels.log import end_log
from jaart.core.kernels.near import near_in, surfels_near
from jaart.core.kernels.packet import is_bad
from jaart.core.kernels.pierce import NOTHING, ROOM, Balls, chord, next_item, push_root, unowned_balls
from jaart.core.kernels.ray import added, no_hit, ray_of, visiting, write_end
from jaart.core.kernels.records import Array, End, Out, Plan, RayEnd, Sites, Start, Vector
from jaart.core.kernels.stretch import has_hit
from jaart.core.kernels.tree import Tree
from jaart.core.kernels.unowned import unowned
from jaart.core.kernels.vectors import along, dot, scaled

Ints = NDArray[np.int64]
#: Promises closer to a hit than this, in h, are of the same sheet.
_SAME_SHEET = 0.25
#: What a ray lacks for which more balls are to be listed.
MORE_BALLS, NO_MORE = 0, -1
_ZERO: Any = np.int64(0)
_NOT_ASKED: Any = np.int64(-1)
_NOTHING = (nan, nan, nan)
#: Farther than this from what is kept at a ball's centre, in h, no origin is on the surface.
_BESIDE = 0.4


@kernel(STRICT, inline=True)
def guess_at(sites: Sites, ball: int) -> int:
    """Address of what is kept at the centre of a ball that was made ready."""
    return kept_in(load(sites.slots, ball))


@kernel(STRICT)
def make_ready(sites: Sites, plan: Plan, ball: int, work: Array, fit: Array) -> bool:
    """Gather a ball's surfels and keep the surface at its centre; whether there was room for it."""
    pool, place = sites.pool, (ball, _ZERO, _ZERO)
    address = gather_at(pool[GATHERER], pool, place)
    if address == 0:
        return False
    near = near_in(pool, address)
    if pool[MORE] > 0:
        take_back(pool, address)
        return False
    if pool[KEPT] > 0:
        taken = fit[r.EIGENVECTORS]  # what is kept for all rays is none's
        v = evaluate_at(plan.how.evaluate, near, (0.0, 0.0, 0.0), plan.rule, r.QUICK, work, fit)
        fit[r.EIGENVECTORS] = taken
        write_guess(floats_at(kept_in(address), GUESS_WIDTH), v, fit)
    if publish(sites.slots, ball, address, pool) == address and pool[KEPT] > 0:
        pool[FITTED] += 1
    return True


@kernel(STRICT, inline=True)
def start_in(balls: Balls, plan: Plan, ball: int, o: Vector, d: Vector, begin: Leave, number: int) -> Start:
    """Where the search of a ball begins: at its promise, NaN for none, or at its near side for a stretch.

    The base is the ray's foot point on the centre; s counts from there. begin: how the ray leaves its origin. Where a
    sheet is seen close ahead from there, its promise may lie a little behind.
    """
    foot, half, _ = chord(balls, ball, o, d)
    c = (balls.sites.centres[ball, 0], balls.sites.centres[ball, 1], balls.sites.centres[ball, 2])
    base = along((o[0] - c[0], o[1] - c[1], o[2] - c[2]), d, foot)
    low, high = min(max(-half, begin.t - foot), half), half
    guess = floats_at(guess_at(balls.sites, ball), GUESS_WIDTH)
    s = low if balls.stretches == 1 else meets(guess, base, d, low, high, plan.rule.h)
    if s != s and -half < low and 0.0 < begin.ahead < _SAME_SHEET * plan.rule.h and plan.how.kind != r.CENTRES:
        back = max(-half, low - _SAME_SHEET * plan.rule.h)
        behind = meets(guess, base, d, back, low, plan.rule.h)
        s = low if behind == behind else s
    return Start((ball, _ZERO, _ZERO), base, foot, s, low, high, nan, number)


@kernel(STRICT, inline=True)
def may_be_left(balls: Balls, ball: int, o: Vector, h: float) -> bool:
    """Whether the ray's origin, which a ball must hold, may be on the surface: what is kept of it is not far."""
    x = (o[0] - balls.sites.centres[ball, 0], o[1] - balls.sites.centres[ball, 1], o[2] - balls.sites.centres[ball, 2])
    if dot(x, x) > balls.radii[ball] * balls.radii[ball]:
        return False
    guess = floats_at(guess_at(balls.sites, ball), GUESS_WIDTH)
    return balls.stretches == 1 or is_near(guess, x, _BESIDE * h)


@kernel(STRICT)
def leaving(balls: Balls, plan: Plan, ball: int, o: Vector, d: Vector, work: Array, fit: Array) -> Leave:
    """How a ray that starts in a ball leaves its origin."""
    x = (o[0] - balls.sites.centres[ball, 0], o[1] - balls.sites.centres[ball, 1], o[2] - balls.sites.centres[ball, 2])
    return leave(surfels_near(balls.sites, (ball, _ZERO, _ZERO)), x, o, d, plan, balls.blur, work, fit)


@kernel(STRICT)
def unit_of(tree: Tree, h: float) -> float:
    """The cloud's longest edge or h, whichever is longer: origins are judged in it."""
    unit = h
    for axis in range(3):
        unit = max(unit, tree.high[0, axis] - tree.low[0, axis])
    return unit


@kernel(STRICT, inline=True)
def search_ball(balls: Balls, plan: Plan, guess: Array, start: Start, d: Vector, rows: Array, end: RayEnd, work: Array,
                fit: Array) -> tuple[End, RayEnd]:
    """How the search from one more start ended, and the ray with it; guess: what is kept at the ball's centre."""
    if plan.how.kind == r.CENTRES:
        show_centre(guess, fit)
    one = search_from(plan.search, balls.sites, plan.rule, plan.how, plan.bounds, d, start, rows, end.rows, work, fit)
    if one.steps > 0 or one.state != r.BACKGROUND:
        end = added(end, one)
        end_log(rows, end.rows if one.steps > 0 else 0, one.state)
    return one, end


@kernel(STRICT, inline=True)
def trace_ball_ray(balls: Balls, plan: Plan, per_unit: float, o: Vector, d: Vector, room: Room, listed: Listed,
                   rows: Array, work: Array, fit: Array, keys: Array, items: Ints) -> RayEnd:
    """The first hit of a ray, or how its last start ended; it ends at once where the pool is short of room, or more
    balls are to be listed.

    per_unit: 1 over the unit that origins are judged in; o, d: origin and unit direction in the local frame; room,
    listed: its bundle's balls; keys, items: its heap.
    """
    if is_bad(scaled(o, per_unit), d):
        return no_hit(r.BAD_RAY)
    alone = listed.balls == ALONE
    inverse = (1.0 / d[0], 1.0 / d[1], 1.0 / d[2]) if alone else _NOTHING  # of no use to a bundle
    count = balls.sites.centres.shape[0]
    end, best, visited, number = no_hit(r.BACKGROUND), no_hit(r.BACKGROUND), 0, 0
    found, limit, first, slack = False, inf, inf, _SAME_SHEET * plan.rule.h
    begin = Leave(0.0, _NOT_ASKED, nan)
    size = (push_root(balls, o, inverse, keys, items) if alone
            else push_pierced(balls, room, listed, o, d, keys, items))
    known = horizon(room, listed)
    while True:
        size, item = next_item(balls, o, d, inverse, min(limit, known), keys, items, size)
        if item == NOTHING and known < limit:
            return unfinished(end)
        if item == NOTHING:
            break
        ball = item if item < count else item - count
        if item == ROOM or (load(balls.sites.slots, ball) == 0 and not make_ready(balls.sites, plan, ball, work, fit)):
            return end
        guess = floats_at(guess_at(balls.sites, ball), GUESS_WIDTH)
        if begin.used < 0 and begin.t == 0.0 and may_be_left(balls, ball, o, plan.rule.h):
            begin = leaving(balls, plan, ball, o, d, work, fit)
            end = counting(end, begin)
        start = start_in(balls, plan, ball, o, d, begin, number)
        visited += 1 if item < count else 0
        if balls.stretches == 0 and not start.t + start.s >= 0.0:
            end = unpromising(end, int(guess[STATE]))
            continue
        if item < count and balls.stretches == 0 and balls.any_hit == 0:
            size = push(keys, items, size, start.t + start.s, count + ball)
            continue
        fetch_surfels(load(balls.sites.slots, ball))
        one, end = search_ball(balls, plan, guess, start, d, rows, end, work, fit)
        number += 1
        order = one.t if one.f != one.f else one.f  # of a mean of points what it was placed by
        if has_hit(one.state) and (not found or order < first):
            found, best, first, limit = True, end, order, order if balls.stretches == 1 else order - slack
            if balls.any_hit == 1:
                break
    return visiting(end, visited) if not found else finished(best, end, visited)


@kernel(STRICT, inline=True)
def unpromising(end: RayEnd, kept: int) -> RayEnd:
    """A ray's end after a ball that promises no hit: it is said where that has no normal. kept: the state at its
    centre.
    """
    state = r.UNDEFINED_NORMAL if kept == r.UNDEFINED_NORMAL else end.state
    return RayEnd(state, end.t, end.point, end.n, end.energy, end.off, end.iterations, end.evaluations, end.used,
                  end.cells, end.lowered, end.gap, end.rows, end.missing)


@kernel(STRICT, inline=True)
def unfinished(end: RayEnd) -> RayEnd:
    """The end of a ray for which more balls are to be listed."""
    return RayEnd(end.state, end.t, end.point, end.n, end.energy, end.off, end.iterations, end.evaluations, end.used,
                  end.cells, end.lowered, end.gap, end.rows, MORE_BALLS)


@kernel(STRICT, inline=True)
def finished(best: RayEnd, last: RayEnd, visited: int) -> RayEnd:
    """The best hit with the work that all starts took."""
    return RayEnd(best.state, best.t, best.point, best.n, best.energy, best.off, best.iterations, last.evaluations,
                  last.used, visited, last.lowered, best.gap, last.rows, NO_MORE)


@kernel(STRICT, inline=True)
def trace_listed(balls: Balls, plan: Plan, per_unit: float, o: Vector, d: Vector, cone: Cone, room: Room,
                 listed: Listed, rows: Array, work: Array, fit: Array, keys: Array, items: Ints
                 ) -> tuple[RayEnd, Listed]:
    """A ray's end, and what its bundle has listed then."""
    while True:
        end = trace_ball_ray(balls, plan, per_unit, o, d, room, listed, rows, work, fit, keys, items)
        if end.missing != MORE_BALLS:
            return end, listed
        forget_counts(fit)
        listed = list_more(balls, cone, room, listed)


@kernel(STRICT, entry=True)
def trace_ball_rays(balls: Balls, plan: Plan, origins: Array, directions: Array, pixels: Ints, begin: int, out: Out,
                    rows: Array, room: Room, work: Array, fit: Array, keys: Array, items: Ints) -> tuple[int, int]:
    """Trace rays and write each into its row of the columns; returns how many are done, those before one for which
    the pool was short, and the rows of the log.

    origins, directions: (R, 3) in the cloud's own coordinates; pixels: rows to trace, from begin on; the others as of
    `trace_ball_ray`.
    """
    balls, room, log, scratch = unowned_balls(balls), unowned_room(room), unowned(rows), unowned(work)
    fitted, waiting, entries, rays = unowned(fit), unowned(keys), unowned(items), unowned(pixels)
    at, size, written, per_unit = begin, MOST, 0, 1.0 / unit_of(balls.tree, plan.rule.h)
    while at < rays.shape[0]:
        last = last_of(size, at, rays.shape[0])
        cone = cone_about(origins, directions, rays[at:last], balls.offset)
        listed = nothing_listed(balls, cone, min(size, last - at), room, waiting)
        for i in range(at, last):
            to = rays[i]
            o, d = ray_of(origins, directions, to)
            end, listed = trace_listed(balls, plan, per_unit, along(o, balls.offset, -1.0), d, cone, room, listed, log,
                                       scratch, fitted, waiting, entries)
            if is_short(balls.sites.pool):
                forget_counts(fitted)
                return i, 0
            write_end(out, to, end)
            for axis in range(3):
                out.point[to, axis] += balls.offset[axis]
            write_counts(out, to, fitted)
            written = end.rows
        at, size = last, next_size(size, listed.balls)
    return rays.shape[0], written
