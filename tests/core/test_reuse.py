"""Memory of what was let go, used again."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import jaart
from jaart.core import memory, reuse
from jaart.core.reuse import LEAST, Shelf, lent

#: Floats of an array that is just large enough to be kept.
FLOATS = LEAST // 8
#: A picture all of whose columns of numbers are.
SIZE = (384, 384)


@pytest.fixture(autouse=True)
def shelf(monkeypatch: pytest.MonkeyPatch) -> Shelf:
    made = Shelf()
    monkeypatch.setattr(reuse, "SHELF", made)
    return made


def place(array: np.ndarray) -> int:
    return int(array.ctypes.data)


@pytest.mark.parametrize(("shape", "kind"), [((FLOATS,), float), ((2, FLOATS), float), ((8, FLOATS), np.int32)])
def test_what_was_let_go_is_used_again(shelf: Shelf, shape: tuple[int, ...], kind: type[Any]) -> None:
    first = lent(shape, kind)
    at, size = place(first), first.nbytes
    assert first.shape == shape and first.dtype == kind and first.flags.writeable and first.flags.c_contiguous
    assert shelf.kept == 0
    del first
    assert shelf.kept == size
    again = lent(shape, kind)
    assert place(again) == at and shelf.kept == 0


def test_nothing_is_used_that_somebody_still_sees(shelf: Shelf) -> None:
    first = lent((3, FLOATS))
    first[:] = 7.0
    row, turned = first[1], first.T[5:9]
    row.flags.writeable = False
    del first
    other = lent((3, FLOATS))
    other[:] = 0.0
    assert shelf.kept == 0 and (row == 7.0).all() and (turned == 7.0).all()
    del row
    assert shelf.kept == 0
    del turned
    assert shelf.kept == 3 * LEAST


def test_only_the_same_size_is_used(shelf: Shelf) -> None:
    first = lent((2 * FLOATS,))
    at = place(first)
    del first
    assert shelf.kept == 2 * LEAST
    assert lent((FLOATS,)).nbytes == LEAST
    assert shelf.kept == 3 * LEAST
    assert place(lent((4 * FLOATS,), np.float32)) == at


def test_small_arrays_are_made_anew(shelf: Shelf) -> None:
    small = lent((FLOATS - 1,))
    assert small.base is None and lent((0,)).size == 0
    del small
    assert shelf.kept == 0


def test_no_more_is_kept_than_a_share_of_what_an_array_may_take(shelf: Shelf, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "limit", lambda: int(3.5 * LEAST / reuse.SHARE))
    some = [lent((FLOATS,)) for _ in range(5)]
    places = [place(one) for one in some]
    while some:
        some.pop(0)
    assert shelf.kept == 3 * LEAST  # those let go last
    assert {place(lent((FLOATS,))) for _ in range(3)} <= set(places[2:])
    huge = lent((4, FLOATS))
    del huge
    assert shelf.kept == 0


def test_threads_never_share_a_room(shelf: Shelf) -> None:
    def use(number: int) -> bool:
        one = lent((FLOATS,))
        one[:] = number
        return bool((one == number).all())

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(use, range(200)))
    assert 0 < shelf.kept <= 4 * LEAST


@pytest.mark.parametrize("scene", ["standard", "bumpy"])
def test_a_picture_in_used_memory_is_that_in_new_memory(shelf: Shelf, scene: str) -> None:
    loaded = jaart.load(scene)
    first = jaart.render(loaded, size=SIZE)
    columns = [name for name, value in vars(first).items() if isinstance(value, np.ndarray)]
    kept = {name: getattr(first, name).copy() for name in columns}
    at = place(first.t)
    second = jaart.render(loaded, size=SIZE)
    assert place(second.t) != at
    del first
    for room in shelf._free.values():
        room[:] = 0xFF  # no number
    third = jaart.render(loaded, size=SIZE)
    assert place(third.t) == at
    for name, column in kept.items():
        np.testing.assert_array_equal(getattr(third, name), column)
        np.testing.assert_array_equal(getattr(second, name), column)
