"""Exact solids filled into a lattice: by the sources' corner vote, or accurately."""

from __future__ import annotations

from jaart.core import memory
from jaart.core.errors import SettingsError
from jaart.core.fill_accurate import accurate
from jaart.core.fill_corners import corners
from jaart.core.scene import Array, Model

FILLINGS = ("accurate", "corners")


def fill(model: Model, raster: int, filling: str, subdivision: int) -> Array:
    """Fill levels (raster, raster, raster) of a model's solids, in [0, 1].

    filling: "accurate", each level to 1e-6, or "corners", the 8-corner vote [T Algorithms 3, 4];
    subdivision: sub-cells along each edge of an interface cell, for "corners". Solids are united: what
    two of them hold counts once. Raises SettingsError for another filling and for a raster that does not
    fit into memory.
    """
    if filling not in FILLINGS:
        raise SettingsError(f"filling = {filling!r}: expected {' or '.join(FILLINGS)}")
    needed = 16 * (raster + 1) ** 3
    if needed > memory.limit():
        raise SettingsError(f"raster = {raster}: needs {memory.words(needed)} of memory, "
                            f"more than the {memory.words(memory.limit())} it may take")
    solids = [solid.scaled(raster) for solid in model.solids]
    return accurate(solids, raster) if filling == "accurate" else corners(solids, raster, subdivision)
