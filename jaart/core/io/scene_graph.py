"""Reads model scenes from XML: `<SceneGraph raster="16">` with spheres and boxes [T §3.3.3], and the other solids."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from xml.sax import SAXException, SAXParseException
from xml.sax.handler import ContentHandler

import defusedxml.sax
from defusedxml.common import DefusedXmlException

from jaart.core.errors import FileError, SettingsError
from jaart.core.io.values import check_frame
from jaart.core.scene import Model, Scene
from jaart.core.shapes import AXES, Box, Cylinder, Ellipsoid, Solid, Sphere, Torus, Vector

MAX_BYTES = 16 << 20
MAX_SOLIDS = 10_000
#: Sizes and coordinates are in units of the cube; squares of larger ones would lose the cube's digits.
LARGEST = 1e6
RASTER = (2, 2048)

_NUMBER = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]{1,3})?")
_WHOLE = re.compile(r"[0-9]{1,18}")

#: The attributes each element must have.
SOLIDS = {"Sphere": ("radius",), "Box": ("width", "height", "depth"), "Torus": ("major", "minor", "axis"),
          "Cylinder": ("radius", "height", "axis"), "Ellipsoid": ("width", "height", "depth")}
ATTRIBUTES = {"SceneGraph": ("raster",), **SOLIDS, "location": ("x", "y", "z")}
#: What may stand in what.
CHILDREN: dict[str, tuple[str, ...]] = {"": ("SceneGraph",), "SceneGraph": tuple(SOLIDS), "location": (),
                                        **dict.fromkeys(SOLIDS, ("location",))}


def read(path: Path, frame: int | None = None) -> Scene:
    """The model in an XML scene graph. Raises FileError that names element and line.

    Document types and entities are refused, and so is whatever the format does not know.
    """
    size = path.stat().st_size
    if size > MAX_BYTES:
        raise FileError(path, f"has {size} bytes; expected at most {MAX_BYTES} for a scene graph")
    frame = check_frame(path, frame, 1)
    handler = _SceneGraph(path)
    try:
        with path.open("rb") as stream:
            defusedxml.sax.parse(stream, handler, forbid_dtd=True)
    except DefusedXmlException:
        raise handler.error("declares a document type or an entity; these are refused") from None
    except SAXParseException as error:
        raise FileError(path, f"is no well-formed XML: {error.getMessage()}", f"line {error.getLineNumber()}") from None
    except (SAXException, ValueError, LookupError) as error:
        raise handler.error(f"cannot be read as XML: {error}") from None
    return Scene(str(path), model=handler.model(), notes=tuple(handler.notes))


class _SceneGraph(ContentHandler):
    """Takes the elements as they come, so that each error knows its line."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        self.open: list[str] = [""]
        self.raster = 0
        self.solids: list[Solid] = []
        self.notes: list[str] = []
        self.sizes: dict[str, float] = {}
        self.axis: Vector = AXES["z"]
        self.location: Vector | None = None
        self.locator: Any = None

    def setDocumentLocator(self, locator: Any) -> None:
        self.locator = locator

    def error(self, problem: str, element: str = "") -> FileError:
        """The error to raise here."""
        line = f"line {self.locator.getLineNumber()}" if self.locator else ""
        return FileError(self.path, problem, ", ".join(part for part in (line, element and f"<{element}>") if part))

    def model(self) -> Model:
        """The model, once the whole file is read."""
        return Model(tuple(self.solids), self.raster)

    def startElement(self, name: str, attrs: Any) -> None:
        allowed = CHILDREN[self.open[-1]]
        if name not in allowed:
            raise self.error(f"is unknown here; expected {' or '.join(allowed) or 'nothing inside ' + self.open[-1]}",
                             name)
        self.open.append(name)
        values = self._attributes(name, dict(attrs))
        if name == "SceneGraph":
            self.raster = self._raster(values[0])
        elif name == "location":
            if self.location is not None:
                raise self.error("stands here twice; expected one", name)
            x, y, z = (self._number(name, *pair) for pair in zip(ATTRIBUTES[name], values, strict=True))
            self.location = x, y, z
        else:
            texts = dict(zip(ATTRIBUTES[name], values, strict=True))
            self.axis = self._axis(name, texts.pop("axis", "z"))
            self.sizes = {key: self._size(name, key, text) for key, text in texts.items()}

    def endElement(self, name: str) -> None:
        self.open.pop()
        if name in SOLIDS:
            self._add(name)
        elif name == "SceneGraph" and not self.solids:
            raise self.error(f"holds no {' and no '.join(SOLIDS)}", name)

    def characters(self, content: str) -> None:
        if content.strip():
            raise self.error(f"has text {content.strip()[:20]!r} inside; expected elements only", self.open[-1])

    def _add(self, name: str) -> None:
        if self.location is None:
            raise self.error("has no <location x= y= z=>", name)
        if len(self.solids) >= MAX_SOLIDS:
            raise self.error(f"comes after {MAX_SOLIDS} others, which is the limit", name)
        try:
            self.solids.append(_solid(name, self.location, self.sizes, self.axis))
        except SettingsError as error:
            raise self.error(str(error), name) from None
        low, high = self.solids[-1].bounds
        if low.min() < -1e-9 or high.max() > 1 + 1e-9:
            self.notes.append(f"<{name}> in line {self.locator.getLineNumber()} reaches out of the unit cube, "
                              "which cuts it off")
        self.location = None

    def _axis(self, name: str, text: str) -> Vector:
        if text in AXES:
            return AXES[text]
        parts = text.split(" ")
        if len(parts) != 3 or not all(_NUMBER.fullmatch(part) and abs(float(part)) <= LARGEST for part in parts):
            raise self.error(f"axis = {text[:40]!r}; expected x, y, z or a direction of three numbers", name)
        return float(parts[0]), float(parts[1]), float(parts[2])

    def _attributes(self, name: str, attributes: dict[str, str]) -> list[str]:
        wanted = ATTRIBUTES[name]
        for key in attributes:
            if key not in wanted:
                raise self.error(f"has an unknown attribute {key!r}; expected {', '.join(wanted)}", name)
        for key in wanted:
            if key not in attributes:
                raise self.error(f"has no attribute {key!r}", name)
        return [attributes[key] for key in wanted]

    def _raster(self, text: str) -> int:
        low, high = RASTER
        if not _WHOLE.fullmatch(text) or not low <= int(text) <= high:
            raise self.error(f"raster = {text[:40]!r}; expected a whole number from {low} to {high}", "SceneGraph")
        return int(text)

    def _number(self, name: str, key: str, text: str) -> float:
        if not _NUMBER.fullmatch(text) or not abs(float(text)) <= LARGEST:
            raise self.error(f"{key} = {text[:40]!r}; expected a number within {LARGEST:g}", name)
        return float(text)

    def _size(self, name: str, key: str, text: str) -> float:
        number = self._number(name, key, text)
        if number <= 0:
            raise self.error(f"{key} = {text[:40]!r}; expected a number above 0", name)
        return number


def _solid(name: str, centre: Vector, sizes: dict[str, float], axis: Vector) -> Solid:
    """The solid of an element. Raises SettingsError where its sizes do not fit together."""
    if name == "Sphere":
        return Sphere(centre, sizes["radius"])
    if name == "Torus":
        return Torus(centre, axis, sizes["major"], sizes["minor"])
    if name == "Cylinder":
        return Cylinder(centre, axis, sizes["radius"], sizes["height"])
    width, height, depth = sizes["width"], sizes["height"], sizes["depth"]
    if name == "Ellipsoid":
        return Ellipsoid(centre, (width / 2, height / 2, depth / 2))
    return Box(centre, (width, height, depth))
