"""Which settings make sense together and in which scene: everything that is refused is refused here, by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from jaart.core.chosen import Chosen, chosen
from jaart.core.errors import SettingsError
from jaart.core.groups.search import STEPPING, STRETCHES
from jaart.core.groups.surface import ENERGIES, FITTED, MESHES, evaluates
from jaart.core.parameter import shown
from jaart.core.scene import Scene
from jaart.core.settings import PARAMETERS, Settings

#: Searches that need to know on which side of the surface a point is.
SIDED = ("march", "safe")
#: What a proof of misses asks of the other settings.
PROVEN = {"method": "tangent", "normal": "surfel", "search": "safe"}
#: (name of the setting, whether it is refused, why and what was expected instead).
Refusal = tuple[str, Callable[[Scene, Settings, Chosen], bool], str | Callable[[Settings, Chosen], str]]


def _bare(scene: Scene) -> bool:
    return scene.kind == "cloud" and scene.normals is None


def _unproven(settings: Settings, values: Chosen) -> list[str]:
    """In words, what a proof of misses asks for and is not so."""
    found = [f"{name} = {word}, not {getattr(values, name)}" for name, word in PROVEN.items()
             if getattr(values, name) != word]
    found += ["traversal = exact, not uniform"] if settings.traversal == "uniform" else []
    return found + (["a neighbourhood other than knn"] if values.neighbourhood == "knn" else [])


REFUSED: tuple[Refusal, ...] = (
    ("neighbourhood", lambda scene, s, c: scene.kind == "cloud" and c.neighbourhood.startswith("cell_"),
     "a cloud has no cells; expected ball or knn"),
    ("method", lambda scene, s, c: scene.kind == "cloud" and c.method in MESHES,
     "needs a lattice; a cloud has no cells to make a mesh in"),
    ("search", lambda scene, s, c: c.method in ENERGIES and c.search != "minimise",
     "a least energy is found by minimising; expected minimise or auto"),
    ("search", lambda scene, s, c: c.method in FITTED and c.search == "minimise",
     "a fitted surface is no least energy; expected another search"),
    ("search", lambda scene, s, c: c.method == "projection" and c.search == "centres",
     "a projection has no plane that is kept; expected another search"),
    ("emphasise", lambda scene, s, c: s.emphasise and c.method != "isosurface"
     and (c.search != "minimise" or c.method == "angle"),
     "emphasises an energy that is minimised; expected search = minimise, and a method other than angle"),
    ("emphasise", lambda scene, s, c: s.emphasise and c.method == "isosurface" and s.energy == "angle",
     "emphasises another energy by the angle; expected an energy other than angle"),
    ("normal", lambda scene, s, c: _bare(scene) and s.orient == "none" and c.normal == "surfel",
     "the points have no normals and orient = none; expected covariance"),
    ("method", lambda scene, s, c: _bare(scene) and s.orient == "none" and c.method in ("mahalanobis", "cylinder"),
     "the points have no normals and orient = none; expected spanning_tree or a viewpoint"),
    ("search", lambda scene, s, c: _bare(scene) and s.orient == "none" and c.search in SIDED,
     "the points have no normals and orient = none; expected spanning_tree or a viewpoint"),
    ("proof", lambda scene, s, c: s.proof and bool(_unproven(s, c)),
     lambda s, c: "bounds are known for the tangent surface with the surfels' normals alone; expected "
     + ", and ".join(_unproven(s, c))),
    ("shading", lambda scene, s, c: _bare(scene) and s.orient == "none" and s.shading == "water",
     "the points have no normals and orient = none; expected spanning_tree or a viewpoint"),
)


def check(scene: Scene, settings: Settings) -> Chosen:
    """The settings' values in a scene. Raises SettingsError, naming the setting, for what makes no sense."""
    values = chosen(scene, settings)
    for name, refused, why in REFUSED:
        if refused(scene, settings, values):
            reason = why if isinstance(why, str) else why(settings, values)
            raise SettingsError(f"{name} = {_shown(settings, values, name)}: {reason}")
    return values


def check_names(names: Iterable[str], scene: Scene, settings: Settings) -> None:
    """Refuse settings that somebody gave and that mean nothing beside the others or in the scene, by name."""
    for name in names:
        about = PARAMETERS[name]
        if scene.kind not in about.scenes:
            raise SettingsError(f"{name} has no meaning in a {scene.kind}; it is for a {' or a '.join(about.scenes)}")
        if not about.matters(settings):
            raise SettingsError(f"{name} has no meaning beside the other settings; it needs {about.needs}")


def needs_normals(scene: Scene, settings: Settings, values: Chosen) -> bool:
    """Whether surfels' normals enter at all, so that bare points must be given some."""
    return (values.normal == "surfel" and weighs(values)) \
        or values.method in ("mahalanobis", "cylinder") or values.search in SIDED or settings.shading == "water"


def estimates_normals(scene: Scene, settings: Settings, values: Chosen) -> bool:
    """Whether bare points must be given normals."""
    return _bare(scene) and needs_normals(scene, settings, values)


def oriented(scene: Scene, settings: Settings, values: Chosen) -> bool:
    """Whether a covariance normal must be turned to the surfels' side."""
    if values.normal == "surfel":
        return False
    return values.search in SIDED or settings.shading == "water" or not _bare(scene)


def steps(values: Chosen) -> bool:
    """Whether the search steps from x to x."""
    return values.search in STEPPING


def stretches(values: Chosen) -> bool:
    """Whether cells or balls are searched from side to side, not from a start in them."""
    return values.search in STRETCHES or values.method == "cylinder"


def fits_centres(scene: Scene, settings: Settings, values: Chosen) -> bool:
    """Whether the surface at a place's centre is kept, which says where a search begins.

    In a lattice a plane is not: looking it up costs as much as the evaluations that it spares.
    """
    if scene.kind == "cloud":
        return not stretches(values)
    return values.method in FITTED and values.search in STEPPING and settings.traversal == "exact"


def weighs(values: Chosen) -> bool:
    """Whether rays or meshes need the average of surfels at points: the levels' mesh and a cylinder do not."""
    return evaluates(values) and values.method != "cylinder"


def shows_gradient(settings: Settings) -> bool:
    """Whether hits show the surface's own normal, not the averaged one."""
    return settings.shading_normal == "gradient"


def _shown(settings: Settings, values: Chosen, name: str) -> str:
    return shown(getattr(values, name, getattr(settings, name)))
