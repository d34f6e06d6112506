"""How surfels come out of fill levels, fill levels out of solids, and normals out of bare points."""

from __future__ import annotations

from dataclasses import dataclass

from jaart.core.parameter import parameter

LATTICES = ("lattice", "model")


@dataclass(frozen=True, kw_only=True)
class LatticeSettings:
    """From fill levels to surfels."""

    placement: str = parameter(
        "choice", "box", choices=("box", "sphere", "sphere_half", "interpolated", "exact", "exact_centroid"),
        group="Lattice", label="Placement", stage="surfels", scenes=LATTICES, source="[T 3.3, fig. 3.5–3.7]",
        help="Where a cell's surfel lies along its normal. box maps the level linearly. sphere, sphere_half: as a cap "
             "of the inscribed sphere, or of radius ½. interpolated: between the axis-aligned and the diagonal map. "
             "exact: on the plane that cuts off just this volume; exact_centroid: in the middle of that cut.")
    gradient: str = parameter(
        "choice", "central", choices=("central", "youngs", "smooth"), group="Lattice", label="Gradient",
        stage="surfels", scenes=LATTICES, source="[T 3.1, 3.2]",
        help="How a cell's normal is found. central: differences of its neighbours. youngs: of all 27 cells around. "
             "smooth: central differences after a Gauss filter of width σ.")
    smoothing: float = parameter(
        "number", 0.8, low=0, open_low=True, high=10, step=0.05, unit="cells", group="Lattice", label="Smoothing σ",
        stage="surfels", scenes=LATTICES, when=lambda s: s.gradient == "smooth", needs="gradient = smooth",
        help="Width of the Gauss filter before the gradient.")
    neighbours: str = parameter(
        "choice", "6", choices=("6", "26"), group="Lattice", label="Interface rule", stage="surfels",
        scenes=LATTICES, source="[T §3.1]",
        help="Among how many neighbours an empty cell makes a full one an interface cell.")
    border: str = parameter(
        "choice", "open", choices=("open", "closed"), group="Lattice", label="Border", stage="surfels",
        scenes=LATTICES,
        help="open: outside the lattice is unknown, a basin has no surface at its walls; closed: it is empty.")
    filter: str = parameter(
        "choice", "none", choices=("none", "thesis", "median", "gauss"), group="Lattice", label="Filter",
        stage="surfels", scenes=LATTICES, source="[T Algorithm 2]",
        help="thesis: levels below 0.1, then cells without a neighbour above 0.25 become empty. median, gauss: of "
             "the 3×3×3 cells around each.")


@dataclass(frozen=True, kw_only=True)
class ModelSettings:
    """From exact solids to fill levels."""

    raster: int | str = parameter(
        "integer", "file", choices=("file",), low=2, high=2048, step=1, unit="cells", group="Model",
        label="Raster", stage="levels", scenes=("model",), source="[T §3.3.3]",
        help="Cells along each edge of a model scene; by default as its file says.")
    filling: str = parameter(
        "choice", "accurate", choices=("accurate", "corners"), group="Model", label="Filling", stage="levels",
        scenes=("model",), source="[T Algorithms 3, 4]",
        help="How a model's fill levels are found. accurate: the volume in each cell; corners: a vote of 8 corners a "
             "sub-cell.")
    subdivision: int = parameter(
        "integer", 20, low=1, high=100, step=1, group="Model", label="Sub-cells", stage="levels", scenes=("model",),
        source="[T §3.3.3]", when=lambda s: s.filling == "corners",
        needs="filling = corners",
        help="Sub-cells along each edge of an interface cell when a model is filled by corners.")


@dataclass(frozen=True, kw_only=True)
class CloudSettings:
    """What bare points get."""

    orient: tuple[float, float, float] | str = parameter(
        "vector", "spanning_tree", choices=("spanning_tree", "none"), group="Cloud", label="Orient normals",
        stage="surfels", scenes=("cloud",), source="[A §3.2]",
        help="Where bare points need normals with a sense: spanning_tree turns each like its neighbours, outwards at "
             "the top; x,y,z towards a viewpoint; none refuses what needs them.")
