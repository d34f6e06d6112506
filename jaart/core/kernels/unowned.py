"""Arrays that are used without being counted.

Every use of an array in compiled code counts its users up and down with an atomic instruction; two threads
that share a scene's arrays then wait for each other at every step of every ray. A view without an owner is
not counted. It must not outlive the function that was handed the array.
"""

from __future__ import annotations

from typing import Any

from numba.core import cgutils
from numba.extending import intrinsic

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Cells, Empty, Sites


@intrinsic
def unowned(typing_context: Any, array: Any) -> Any:
    """The same array without its owner."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        view = context.make_array(array)(context, builder, arguments[0])
        view.meminfo = cgutils.get_null_value(view.meminfo.type)
        return view._getvalue()

    return array(array), generate


@kernel(STRICT)
def unowned_sites(sites: Sites) -> Sites:
    """Places, their arrays without owners."""
    return Sites(sites.shape, unowned(sites.centres), unowned(sites.slots), unowned(sites.pool))


@kernel(STRICT)
def unowned_empty(empty: Empty) -> Empty:
    """Distances, their arrays without owners."""
    return Empty(empty.shape, unowned(empty.bricks), unowned(empty.near))


@kernel(STRICT)
def unowned_cells(cells: Cells) -> Cells:
    """A lattice, its arrays without owners."""
    return Cells(unowned_sites(cells.sites), unowned_empty(cells.empty), cells.halo, cells.stretches, cells.uniform)
