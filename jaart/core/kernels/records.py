"""What kernels are handed: tuples of arrays and of scalars."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]
Vector = tuple[float, float, float]
Cell = tuple[int, int, int]
#: np.uint64 to the compiler, which unlike numpy counts a loop up to one in its own type.
Unsigned: TypeAlias = Any


class Sites(NamedTuple):
    """Places with the surfels near each: the cells of a lattice, or balls of a cloud.

    shape: cells along each axis, (0, 0, 0) for balls; centres: (B, 3) of balls, (0, 3) for cells; slots: addresses of
    the places' blocks (see blocks.py), 0 where nobody asked for one yet: of each ball, or of the cells of each brick of
    4×4×4, C order, behind the numbers that say where in slots a brick begins, 0 for one that no surfel is near; pool:
    where this thread's next block goes and what it is gathered from.
    """

    shape: Cell
    centres: Array
    slots: Numbers
    pool: Numbers


class Near(NamedTuple):
    """The surfels near one place: as many as size in the columns from base on.

    wide: how long each column is; what follows the surfels in it counts nothing in a Gaussian's sums. The numbers are
    unsigned: a signed index would be checked for its sign, and the sums stay scalar.
    """

    columns: Array
    base: Unsigned
    size: Unsigned
    wide: Unsigned


class Rule(NamedTuple):
    """How a point is evaluated; lengths as in the scene.

    weight, normal: numbers of WEIGHTS and NORMALS; h: feature size; reach: surfels farther than this from x do
    not count; k: only so many nearest ones count, 0 = all; oriented: 1 to turn a covariance normal to the
    surfels' side; degree: of the polynomial; patch: variance of the patch that a surfel stands for, in h²,
    0 for the point alone; c: of the Mahalanobis energy.
    """

    weight: int
    normal: int
    h: float
    reach: float
    k: int
    oriented: int
    degree: int
    patch: float
    c: float


class Value(NamedTuple):
    """What a surface is at a point x.

    state: CONTINUE, or why there is nothing (f and n are NaN then); f: the implicit function; n: unit normal;
    off: a(x) - x; weight: Σθ, every weight divided by exp(shift); gradient: ∇f where it was asked for, else NaN;
    degree: of the polynomial that was fitted.
    """

    state: int
    f: float
    n: Vector
    off: Vector
    weight: float
    shift: float
    gradient: Vector
    degree: int


class Search(NamedTuple):
    """What a search along a ray needs to know; lengths as in the scene.

    kind: number of SEARCHES; proof: 1 where a miss must be proven; evaluate, approach, accept: addresses of the
    surface's evaluator, of what meets the ray with a fitted polynomial (0 for a plane), and of what a hit must pass;
    arrived: a shorter step ends it;
    by_value: 1 where |f| is compared in its place [A §4]; cap: steps a start; trust: how far from the start;
    growth: 1 to give up as soon as |f| grows; step: of march; energy, emphasise, level: of minimise;
    true_normal: 1 to give hits the normal -∇f.
    """

    kind: int
    proof: int
    evaluate: int
    approach: int
    accept: int
    arrived: float
    by_value: int
    cap: int
    trust: float
    growth: int
    step: float
    energy: int
    emphasise: int
    level: float
    true_normal: int


class Bounds(NamedTuple):
    """What a hit must keep [T §2.5]: infinite where nothing is asked.

    off_centre: largest |a(x) - x|; log_weight: least log Σθ; nearest: largest distance to the nearest surfel;
    angle: largest |<c/|c|, n>|; gap: least (λ1 - λ0)/λ2, which is measured when it is finite.
    """

    off_centre: float
    log_weight: float
    nearest: float
    angle: float
    gap: float


class Start(NamedTuple):
    """Where a search begins on a ray.

    cell: the cell, or the ball's number; base: the ray's point at t, relative to the place's centre; t: distance
    from the ray's origin; s: the first guess, from t on; low, high: the search stays within, from t on;
    before: f at the end of the stretch before, NaN when there is none; number: of this start on the ray.
    """

    cell: Cell
    base: Vector
    t: float
    s: float
    low: float
    high: float
    before: float
    number: int


class Spent(NamedTuple):
    """What a start took so far: iterations, evaluations, surfels summed over them, evaluations with fewer degrees."""

    steps: int
    evaluations: int
    used: int
    lowered: int


class Met(NamedTuple):
    """Where a search says that a ray meets the surface.

    state: CONVERGED or FLOOR; t: from the ray's origin; point: in the scene; cell, x: place and local point where v
    was evaluated; v: the surface there; to: from there to the hit; at_cell, at: place and local point of the hit;
    energy: the last step, or what is left of f; sided: 1 where f must fall along n; other_fit: 1 where the fit at hand
    is another point's.
    """

    state: int
    t: float
    point: Vector
    cell: Cell
    x: Vector
    v: Value
    to: Vector
    at_cell: Cell
    at: Vector
    energy: float
    sided: int
    other_fit: int


class End(NamedTuple):
    """How a start ended; point and n are NaN unless it hit.

    t: of the hit; energy: the last step, or the energy's minimum; off: off-centre value; steps: iterations;
    evaluations: of the surface; used: surfels summed over them; lowered: evaluations with fewer degrees than
    asked for; f: at the end of the stretch; gap: (λ1 - λ0)/λ2 where it was asked for.
    """

    state: int
    t: float
    point: Vector
    n: Vector
    energy: float
    off: float
    steps: int
    evaluations: int
    used: int
    lowered: int
    f: float
    gap: float


class Plan(NamedTuple):
    """All that a ray's search needs beside the scene; search: address of the kernel that searches."""

    rule: Rule
    how: Search
    bounds: Bounds
    search: int


class Empty(NamedTuple):
    """How far a lattice's cells are from the nearest with a surfel: in cells along the axis where that is most.

    Told cell by cell near surfels, for bricks of 4 × 4 × 4 cells elsewhere. shape: of the lattice; bricks: (B,) where
    in near the distances of a brick's cells begin, or -1 - d where none of them is nearer than d; near: distances,
    0 = has one, 64 for a brick.
    """

    shape: Cell
    bricks: NDArray[np.int32]
    near: NDArray[np.uint8]


class Cells(NamedTuple):
    """A lattice as rays cross it.

    sites: its cells; empty: how far each is from one with a surfel; halo: cells farther than this from one have no
    surfels near; stretches: 1 when every cell with surfels near is searched from face to face, 0 when a search starts
    where a cell with a surfel is entered; uniform: length of even steps through the cells, 0 for exact traversal.
    """

    sites: Sites
    empty: Empty
    halo: int
    stretches: int
    uniform: float


class RayEnd(NamedTuple):
    """How a ray ended; t, point and n are NaN without a hit, energy and off without a start.

    energy: length of the last step, or the minimum; off: off-centre value; iterations: of the hit's or last start;
    evaluations: of all starts; used: surfels summed over them; cells: cells or balls visited; lowered:
    evaluations with fewer degrees than asked for; gap: as of End; rows: written to the log; missing: 0 where
    more balls are to be listed first, else -1.
    """

    state: int
    t: float
    point: Vector
    n: Vector
    energy: float
    off: float
    iterations: int
    evaluations: int
    used: int
    cells: int
    lowered: int
    gap: float
    rows: int
    missing: int


class Out(NamedTuple):
    """Columns of Hits for R rays, written in place."""

    t: Array
    point: Array
    normal: Array
    energy: Array
    off_centre: Array
    iterations: NDArray[np.int32]
    evaluations: NDArray[np.int32]
    neighbours: NDArray[np.int32]
    cells: NDArray[np.int32]
    lowered: NDArray[np.int32]
    gap: Array
    status: NDArray[np.uint8]
    starts: NDArray[np.int32]
    eigenvectors: NDArray[np.int32]
    gradients: NDArray[np.int32]


#: Columns of a step's row in the log, and their number.
(START, T, X, Y, Z, AX, AY, AZ, NX, NY, NZ, STEP, WEIGHT, OFF, CELL_I, CELL_J, CELL_K, END, LOG_WIDTH) = range(19)

#: Numbers of the end states, in the order of STATUS_NAMES; CONTINUE while a search goes on.
(CONVERGED, BACKGROUND, CAP, LEFT_TRUST, PARALLEL, FEW_NEIGHBOURS, UNDEFINED_NORMAL, BOUNDED, FLOOR, UNDECIDED, BAD_RAY,
 BOUNDED_WEIGHT, BOUNDED_NEAREST, BOUNDED_ANGLE, BOUNDED_GAP) = range(15)
CONTINUE = 255

#: Numbers of weights, normals, searches and energies.
GAUSSIAN, HAT, SQUARED_HAT, WENDLAND = range(4)
SURFEL, COVARIANCE, COVARIANCE_AT_X = range(3)
ITERATE, SECANT, NEWTON, MINIMISE, MARCH, SAFE, CENTRES = range(7)
TANGENT_STEP, OFF_CENTRE, MAHALANOBIS, ANGLE, TANGENT = range(5)

#: Values of `want`: the gradient costs a pass of its own; a quick value may leave the weights unwritten; for a least
#: energy the barycentre alone may do, with no normal and no f.
VALUE_ONLY, WITH_GRADIENT, QUICK, BARYCENTRE = range(4)
#: Coefficients of a fitted polynomial, and room for them with what a ray took so far behind them, see `counts`.
COEFFICIENTS = 15
EIGENVECTORS, GRADIENTS, STARTS = range(COEFFICIENTS, COEFFICIENTS + 3)
FIT_SIZE = COEFFICIENTS + 3
