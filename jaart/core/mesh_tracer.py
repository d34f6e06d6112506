"""A scene that is a mesh before rays meet it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from threading import Event

import numpy as np

from jaart.core.chosen import Chosen
from jaart.core.contour import Mesh, contour
from jaart.core.extents import edges
from jaart.core.field import Energy, energy_field, energy_gradients
from jaart.core.kernels import mesh as kernels
from jaart.core.kernels.mesh import Faces
from jaart.core.kernels.records import Cells, Out, Plan
from jaart.core.meaning import shows_gradient
from jaart.core.meshes import energy_mesh, level_mesh
from jaart.core.scene import Array, Scene
from jaart.core.settings import Settings
from jaart.core.telling import tell
from jaart.core.tiles import Pixels, columns_for
from jaart.core.tracers import NO_BEGINS, NO_LOG, OnLattice
from jaart.core.tree import box_tree

#: A hit on the edge of a triangle may be rounded out of its box: boxes are larger by this, in cells.
MARGIN = 1e-9


@dataclass(frozen=True, eq=False)
class MeshTracer(OnLattice):
    """A mesh that rays meet; the cells are those of the energies along a picked ray, which a picture does without.

    mesh: its triangles; faces: the same with a tree over them.
    """

    mesh: Mesh
    faces: Faces

    def trace(self, origins: Array, directions: Array, pixels: Pixels, out: Out, log: Array = NO_LOG,
              any_hit: bool = False, begins: Array = NO_BEGINS) -> int:
        """Trace some rays into their rows of the columns, see `Tracer`: no steps; cells: nodes of the tree visited."""
        kernels.trace_rays(self.faces, int(any_hit), origins, directions, pixels, out)
        return 0


def faces_of(mesh: Mesh, flat: bool) -> Faces:
    """A mesh with a tree over its triangles; flat: its normals are those of the triangles, not of the vertices."""
    corners = mesh.vertices[mesh.triangles]
    tree = box_tree(corners.min(axis=1) - MARGIN, corners.max(axis=1) + MARGIN)
    return Faces(mesh.vertices, mesh.triangles, mesh.normals, tree, int(flat))


def mesh_tracer(scene: Scene, settings: Settings, values: Chosen, table: Callable[[], Cells], plan: Plan,
                levels: Array, cancel: Event | None = None) -> MeshTracer:
    """What rays are sent through where the method is one of MESHES; the mesh is kept in the scene.

    table: makes the neighbourhoods; plan: how a point is evaluated; levels: fill levels. Raises what `energy_mesh`
    and `level_mesh` do.
    """
    def make() -> Mesh:
        if values.method == "fill_level":
            return level_mesh(levels, settings, values.level, edges(scene))
        energy = Energy(table(), plan, settings.energy, settings.emphasise)
        return energy_mesh(energy, settings.subdivide, values.level, cancel=cancel, progress=tell)

    key, flat = (settings.key("rays"), values), shows_gradient(settings)
    mesh = scene.once("mesh", key, make)
    return MeshTracer(table, plan, mesh, scene.once("faces", (key, flat), lambda: faces_of(mesh, flat)))


def warm_up(method: str, cells: Cells, plan: Plan) -> None:
    """Load or compile what a mesh of that method needs: to be made, of some small cells, and to be met by rays."""
    if method == "isosurface":
        energy_field(Energy(cells, plan), 1)
        energy_gradients(Energy(cells, plan), np.zeros((1, 3)))
    values = np.ones((2, 2, 2))
    values[0, 0, 0] = 0.0
    faces = faces_of(contour(values, 0.5), flat=False)
    kernels.trace_rays(faces, 0, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.zeros(1, np.int64), columns_for(1))
