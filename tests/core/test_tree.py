"""Bounding volume trees: each node holds what is below it, and no ray that meets a ball misses its boxes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.kernels.tree import Tree, span
from jaart.core.tree import ball_tree, box_tree

RNG = np.random.default_rng(6)


def checked(tree: Tree, low: np.ndarray, high: np.ndarray, leaf: int) -> int:
    """Assert what holds of every node; returns the tree's depth."""
    assert sorted(tree.order.tolist()) == list(range(len(low)))
    seen, deepest, stack = [], 0, [(0, 1)]
    while stack:
        node, depth = stack.pop()
        seen.append(node)
        deepest = max(deepest, depth)
        if tree.size[node]:
            items = tree.order[tree.first[node]:tree.first[node] + tree.size[node]]
            assert leaf / 2 <= len(items) <= leaf or len(low) < leaf / 2
            lows, highs = low[items], high[items]
        else:
            children = [node + 1, tree.first[node]]
            lows, highs = tree.low[children], tree.high[children]
            stack += [(child, depth + 1) for child in children]
        assert tree.low[node].tolist() == lows.min(axis=0).tolist()
        assert tree.high[node].tolist() == highs.max(axis=0).tolist()
    assert sorted(seen) == list(range(len(tree.low)))
    assert tree.size.sum() == len(low)
    return deepest


@pytest.mark.parametrize("leaf", [1, 2, 4, 6, 7])
@pytest.mark.parametrize("count", [1, 2, 3, 6, 7, 8, 13, 100, 1777])
def test_every_node_holds_what_is_below_it(count: int, leaf: int) -> None:
    low = RNG.normal(size=(count, 3))
    high = low + RNG.uniform(0, 0.3, (count, 3))
    assert checked(box_tree(low, high, leaf), low, high, leaf) <= max(1, np.ceil(np.log2(count / leaf)) + 1)


@pytest.mark.parametrize("points", [
    np.zeros((500, 3)), np.arange(1500.0).reshape(500, 3), np.arange(1500.0)[::-1].reshape(500, 3),
    np.repeat(np.arange(5.0), 300).reshape(500, 3), np.eye(3)[np.arange(500) % 3], np.full((500, 3), 1e99)])
def test_points_in_any_order_and_place(points: np.ndarray) -> None:
    checked(box_tree(points, points), points, points, 6)


def test_the_same_balls_give_the_same_tree() -> None:
    points, radii = RNG.normal(size=(1000, 3)), RNG.uniform(0.01, 0.1, 1000)
    first, again = ball_tree(points, radii), ball_tree(points.copy(), radii)
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert (first.low[0] <= (points - radii[:, None]).min(axis=0)).all()
    assert all(column.flags.c_contiguous for column in first)


def found(tree: Tree, o: np.ndarray, d: np.ndarray) -> set[int]:
    """The items of the leaves whose boxes a ray may meet."""
    with np.errstate(divide="ignore"):
        inverse = tuple((1 / d).tolist())
    items: set[int] = set()
    stack = [0]
    while stack:
        node = stack.pop()
        near, far = span(tree.low, tree.high, node, tuple(o.tolist()), inverse)
        if near <= far and far >= 0:
            if tree.size[node]:
                items |= set(tree.order[tree.first[node]:tree.first[node] + tree.size[node]].tolist())
            else:
                stack += [node + 1, int(tree.first[node])]
    return items


def test_no_ball_on_a_ray_is_missed() -> None:
    points, radii = RNG.normal(size=(2000, 3)), RNG.uniform(0.005, 0.05, 2000)
    tree, visited = ball_tree(points, radii), []
    for _ in range(60):
        o = RNG.normal(size=3) * 10.0 ** RNG.integers(0, 5)
        d = points[RNG.integers(2000)] + RNG.normal(size=3) * 0.02 - o
        d /= np.linalg.norm(d)
        along = (points - o) @ d
        aside = np.linalg.norm(points - o - along[:, None] * d, axis=1)
        met = set(np.flatnonzero((aside <= radii) & (along + radii >= 0)).tolist())
        items = found(tree, o, d)
        assert met <= items
        visited.append(len(items))
    assert np.mean(visited) < 200


@given(st.tuples(*[st.sampled_from([-1.0, 0.0, 1.0, 2.0])] * 3),
       st.tuples(*[st.sampled_from([-1.0, 0.0, -0.0, 1.0])] * 3))
def test_rays_along_faces_edges_and_through_corners_meet_the_box(o: tuple[float, ...], d: tuple[float, ...]) -> None:
    tree = box_tree(np.zeros((1, 3)), np.ones((1, 3)))
    with np.errstate(divide="ignore"):
        inverse = tuple((1 / np.array(d)).tolist())
    near, far = span(tree.low, tree.high, 0, o, inverse)
    steps = np.linspace(-3, 3, 25)[:, None]
    inside = ((steps * d + o >= 0) & (steps * d + o <= 1)).all(axis=1)
    if np.any(d):
        assert (near <= far) == bool(inside.any())


def test_the_interval_is_widened_by_rounding_only() -> None:
    tree = box_tree(np.array([[2.0, -1, -1]]), np.array([[5.0, 1, 1]]))
    near, far = span(tree.low, tree.high, 0, (0.0, 0.0, 0.0), (1.0, np.inf, np.inf))
    assert 2 * (1 - 1e-15) < near < 2 and 5 < far < 5 * (1 + 1e-15)
    near, far = span(tree.low, tree.high, 0, (7.0, 0.0, 0.0), (1.0, np.inf, np.inf))
    assert -5 * (1 + 1e-15) < near < -5 and -2 < far < -2 * (1 - 1e-15)
