"""Room that is taken as it is used, and numbers of bytes in words."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.footprint import MIB, peak
from jaart.core import memory
from jaart.core.errors import SettingsError


@pytest.mark.parametrize(("rows", "columns"), [(0, 26), (1, 1), (70_000, 3)])
def test_sparse_room_holds_zeros_until_something_is_written(rows: int, columns: int) -> None:
    room = memory.sparse((rows, columns), "rows")
    assert memory.sparse((rows,), "rows", np.int64).dtype == np.int64
    assert room.shape == (rows, columns) and room.flags.writeable and room.flags.c_contiguous and not room.any()
    room[rows // 2:] = 7.0
    assert (room[rows // 2:] == 7.0).all() and not room[:rows // 2].any()


def test_only_pages_that_are_used_take_memory() -> None:
    room, each = memory.sparse((1 << 13, 1 << 10), "rows"), 1 << 6

    def use() -> None:
        room[::each, 0] = 1.0  # one page in 64 rows of two

    grown = peak(use)[1]
    if grown is None:
        pytest.skip("this system does not say how much memory is taken")
    assert room.nbytes == 64 * MIB and grown < 4


@pytest.mark.parametrize(("count", "size"), [(0, 4), (1, 4), (4, 4), (9, 4)])
def test_pieces_are_all_items_once(count: int, size: int) -> None:
    pieces = list(memory.pieces(count, size))
    assert [i for piece in pieces for i in range(piece.start, piece.stop)] == list(range(count))
    assert all(piece.stop - piece.start <= size for piece in pieces)


def test_room_that_the_system_refuses_is_told() -> None:
    with pytest.raises(SettingsError, match=r"^many rows: the system gives no room of 8.19e\+03 PiB$"):
        memory.sparse((1 << 60,), "many rows")
