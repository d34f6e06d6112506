"""The reader of XML scene graphs: the format's own rules, and each kind of bad file."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jaart.core.errors import FileError
from jaart.core.io import load
from jaart.core.scene import Model, Scene
from jaart.core.shapes import Box, Cylinder, Ellipsoid, Sphere, Torus

VALID = """<?xml version="1.0"?>
<!-- a comment -->
<SceneGraph raster="16">
<Sphere radius="0.25"><location x=".7" y="7e-1" z="0.7"/></Sphere>
<Box width="0.2" height="0.4" depth="0.3">
<location x="0.3" y="0.5" z="0.4"/>
</Box>
</SceneGraph>
"""


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "x.xml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def problem(path: Path) -> str:
    with pytest.raises(FileError) as caught:
        load(path)
    assert str(path) in str(caught.value) and "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("coding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_valid_file(tmp_path: Path, coding: str) -> None:
    scene = load(written(tmp_path, VALID.encode(coding)))
    assert scene.model == Model((Sphere((0.7, 0.7, 0.7), 0.25), Box((0.3, 0.5, 0.4), (0.2, 0.4, 0.3))), 16)
    assert (scene.kind, scene.levels, scene.notes) == ("model", None, ())


BEYOND = """<SceneGraph raster="8">
<Torus major="0.3" minor="0.1" axis="x"><location x="0.5" y="0.5" z="0.5"/></Torus>
<Cylinder radius="0.1" height="0.4" axis="0 3 4"><location x="0.5" y="0.5" z="0.5"/></Cylinder>
<Ellipsoid width="0.2" height="0.4" depth="0.6"><location x="0.5" y="0.5" z="0.5"/></Ellipsoid>
</SceneGraph>
"""


def test_the_solids_beyond_the_sources(tmp_path: Path) -> None:
    centre = (0.5, 0.5, 0.5)
    assert load(written(tmp_path, BEYOND)).model == Model((
        Torus(centre, (1, 0, 0), 0.3, 0.1), Cylinder(centre, (0, 0.6, 0.8), 0.1, 0.4),
        Ellipsoid(centre, (0.1, 0.2, 0.3))), 8)


@pytest.mark.parametrize("old, new, expected", [
    ('axis="x"', "", "line 2, <Torus>: has no attribute 'axis'"),
    ('axis="x"', 'axis="w"', "line 2, <Torus>: axis = 'w'; expected x, y, z or a direction of three numbers"),
    ('"0 3 4"', '"0 3"', "line 3, <Cylinder>: axis = '0 3'; expected"),
    ('"0 3 4"', '"0 nan 4"', "line 3, <Cylinder>: axis = '0 nan 4'; expected"),
    ('"0 3 4"', '"0 0 0"', "line 3, <Cylinder>: cylinder axis = (0.0, 0.0, 0.0): expected a direction"),
    ('minor="0.1"', 'minor="0.3"', "line 2, <Torus>: torus minor radius = 0.3: expected it below the major, 0.3"),
    ('minor="0.1"', 'minor="0"', "line 2, <Torus>: minor = '0'; expected a number above 0"),
    ('depth="0.6"', 'depth="-1"', "line 4, <Ellipsoid>: depth = '-1'; expected a number above 0"),
])
def test_their_errors(tmp_path: Path, old: str, new: str, expected: str) -> None:
    assert expected in problem(written(tmp_path, BEYOND.replace(old, new)))


def test_the_standard_scene_is_built_in(tmp_path: Path) -> None:
    assert load("standard").model == load(written(tmp_path, VALID)).model
    assert load("standard").source == "standard"


@pytest.mark.parametrize("raster", ["0", "1", "2049", "1000000000", "-16", "16.0", "1e2", "1_6", " 16", "nan", "", "٣"])
def test_raster_out_of_range(tmp_path: Path, raster: str) -> None:
    text = problem(written(tmp_path, VALID.replace('raster="16"', f'raster="{raster}"')))
    assert "line 3, <SceneGraph>: raster" in text and "from 2 to 2048" in text


@pytest.mark.parametrize("number", ["nan", "inf", "-inf", "1e999", "0,5", "1_0", " 1 ", "0x1", "", "1e7", "abc"])
def test_coordinates_must_be_plain_numbers(tmp_path: Path, number: str) -> None:
    text = problem(written(tmp_path, VALID.replace('x="0.3"', f'x="{number}"')))
    assert "line 6, <location>: x = " in text


@pytest.mark.parametrize("number", ["0", "-0.25", "1e-999", "nan", "1e7"])
@pytest.mark.parametrize("name, was", [("radius", "0.25"), ("width", "0.2"), ("height", "0.4"), ("depth", "0.3")])
def test_sizes_must_be_positive(tmp_path: Path, name: str, was: str, number: str) -> None:
    text = problem(written(tmp_path, VALID.replace(f'{name}="{was}"', f'{name}="{number}"')))
    assert f"{name} = {number!r}; expected a number" in text


@pytest.mark.parametrize("old, new, expected", [
    ('raster="16"', "", "<SceneGraph>: has no attribute 'raster'"),
    ('radius="0.25"', 'raduis="0.25"', "line 4, <Sphere>: has an unknown attribute 'raduis'; expected radius"),
    ('z="0.4"', "", "line 6, <location>: has no attribute 'z'"),
    ('<location x="0.3" y="0.5" z="0.4"/>', "", "line 7, <Box>: has no <location"),
    ('<location x="0.3" y="0.5" z="0.4"/>', '<location x="0" y="0" z="0"/>' * 2, "<location>: stands here twice"),
    ("Sphere", "Cone", "line 4, <Cone>: is unknown here; expected Sphere or Box or Torus or Cylinder or Ellipsoid"),
    ("SceneGraph", "Scene", "line 3, <Scene>: is unknown here; expected SceneGraph"),
    ("</Box>", "<Box/></Box>", "line 7, <Box>: is unknown here; expected location"),
    ("</Box>", "text</Box>", "<Box>: has text 'text' inside"),
    ("</SceneGraph>", "", "line 9: is no well-formed XML"),
])
def test_the_element_and_line_are_named(tmp_path: Path, old: str, new: str, expected: str) -> None:
    assert expected in problem(written(tmp_path, VALID.replace(old, new)))


@pytest.mark.parametrize("declaration", [
    '<!DOCTYPE SceneGraph [<!ENTITY r "16">]>', '<!DOCTYPE SceneGraph SYSTEM "file:///etc/passwd">',
    '<!DOCTYPE SceneGraph [<!ENTITY r SYSTEM "file:///etc/hostname">]>', "<!DOCTYPE SceneGraph>"])
def test_document_types_and_entities_are_refused(tmp_path: Path, declaration: str) -> None:
    text = VALID.replace("<!-- a comment -->", declaration).replace('"16"', '"&r;"')
    assert "line 2: declares a document type or an entity" in problem(written(tmp_path, text))


def test_a_deep_file_is_left_at_its_second_step(tmp_path: Path) -> None:
    text = '<SceneGraph raster="16">' + "<Box>" * 100_000
    assert "<Box>: has no attribute 'width'" in problem(written(tmp_path, text))


def test_a_long_file_is_not_read(tmp_path: Path) -> None:
    assert "expected at most 16777216" in problem(written(tmp_path, VALID + " " * (16 << 20)))


@pytest.mark.parametrize("content", [b"", b"\0" * 100, b"PK\3\4", VALID.encode()[:120],
                                     VALID.replace('?>', ' encoding="utf-99"?>').encode(),
                                     VALID.replace('?>', ' encoding="utf-32"?>').encode(), b"\xff\xfe<"])
def test_what_is_no_xml(tmp_path: Path, content: bytes) -> None:
    assert "XML" in problem(written(tmp_path, content))


def test_an_empty_graph(tmp_path: Path) -> None:
    text = problem(written(tmp_path, '<SceneGraph raster="4"/>'))
    assert "line 1, <SceneGraph>: holds no Sphere and no Box and no Torus" in text


def test_what_the_cube_cuts_off_is_said(tmp_path: Path) -> None:
    scene = load(written(tmp_path, VALID.replace('radius="0.25"', 'radius="0.5"')))
    assert scene.notes == ("<Sphere> in line 4 reaches out of the unit cube, which cuts it off",)


@given(st.lists(st.tuples(st.integers(0, len(VALID) - 1), st.integers(0, 255)), min_size=1, max_size=3),
       st.integers(0, len(VALID)))
def test_damage_gives_a_scene_or_an_error(tmp_path_factory: pytest.TempPathFactory,
                                          changes: list[tuple[int, int]], end: int) -> None:
    content = bytearray(VALID.encode())
    for at, value in changes:
        content[at] = value
    path = written(tmp_path_factory.getbasetemp(), bytes(content if end % 2 else content[:end]))
    try:
        assert isinstance(load(path), Scene)
    except FileError as error:
        assert str(path) in str(error)
