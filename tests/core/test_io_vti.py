"""The VTI reader: its own files in each coding, real ones, and each kind of bad one."""

from __future__ import annotations

import base64
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

from jaart.core import memory
from jaart.core.errors import FileError
from jaart.core.io import load

LEVELS = np.random.default_rng(3).uniform(0.01, 0.99, (3, 4, 5))
EXTENT = "0 3 0 4 0 5"


def coded(values: np.ndarray, coding: str) -> str:
    raw = values.astype("<f8").tobytes(order="F")
    if coding == "ascii":
        return " ".join(repr(float(v)) for v in values.ravel(order="F"))
    if coding == "zlib":
        packed = zlib.compress(raw)
        head = struct.pack("<4I", 1, len(raw), 0, len(packed))
        return base64.b64encode(head).decode() + base64.b64encode(packed).decode()
    return base64.b64encode(struct.pack("<I", len(raw)) + raw).decode()


def array(name: str, values: np.ndarray, coding: str = "binary", components: int = 1) -> str:
    form = "ascii" if coding == "ascii" else "binary"
    return (f'<DataArray type="Float64" Name="{name}" NumberOfComponents="{components}" format="{form}">'
            f"{coded(values, coding)}</DataArray>")


def image(cells: str = "", points: str = "", extent: str = EXTENT, about: str = 'Origin="0 0 0" Spacing="1 1 1"',
          coding: str = "binary", before: str = "") -> str:
    packed = ' compressor="vtkZLibDataCompressor"' if coding == "zlib" else ""
    return (f'<?xml version="1.0"?>{before}<VTKFile type="ImageData" version="0.1" byte_order="LittleEndian" '
            f'header_type="UInt32"{packed}><ImageData WholeExtent="{extent}" {about}><Piece Extent="{extent}">'
            f"<PointData>{points}</PointData><CellData>{cells}</CellData></Piece></ImageData></VTKFile>")


def written(folder: Path, text: str) -> Path:
    path = folder / "x.vti"
    path.write_text(text)
    return path


def problem(path: Path, capfd: pytest.CaptureFixture[str]) -> str:
    with pytest.raises(FileError) as caught:
        load(path)
    assert str(path) in str(caught.value) and "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")
    return str(caught.value)


@pytest.mark.parametrize("coding", ["ascii", "binary", "zlib"])
def test_levels_of_cells(tmp_path: Path, coding: str) -> None:
    text = image(array("anything", LEVELS, coding), about='Origin="1 2 3" Spacing="0.5 0.5 0.5"', coding=coding)
    scene = load(written(tmp_path, text))
    assert scene.levels is not None and np.array_equal(scene.levels, LEVELS)
    assert scene.levels.flags.c_contiguous and not scene.levels.flags.writeable
    assert (scene.spacing, scene.origin) == ((0.5, 0.5, 0.5), (1, 2, 3))


def test_levels_at_points_become_the_middles_of_cells(tmp_path: Path) -> None:
    text = image(points=array("fill", LEVELS), extent="0 2 0 3 0 4", about='Origin="1 1 1" Spacing="2 2 2"')
    scene = load(written(tmp_path, text))
    assert scene.levels is not None and np.array_equal(scene.levels, LEVELS)
    assert scene.origin == (0, 0, 0)


def test_an_extent_that_does_not_begin_at_zero(tmp_path: Path) -> None:
    scene = load(written(tmp_path, image(array("fill", LEVELS), extent="10 13 -4 0 5 10")))
    assert scene.levels is not None and np.array_equal(scene.levels, LEVELS)
    assert scene.origin == (10, -4, 5)


def test_the_array_is_chosen_by_name(tmp_path: Path) -> None:
    others = array("a", 1 - LEVELS) + array("levels", LEVELS) + array("fill", 1 - LEVELS)
    scene = load(written(tmp_path, image(others)))
    assert scene.levels is not None and np.array_equal(scene.levels, LEVELS)


def test_arrays_that_cannot_be_chosen(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    two = array("a", LEVELS) + array("b", LEVELS)
    assert "holds arrays a, b; expected one" in problem(written(tmp_path, image(two)), capfd)
    assert "holds no array" in problem(written(tmp_path, image()), capfd)
    vectors = array("v", np.zeros((3, 60)), components=3)
    assert "array 'v': is no array of single numbers" in problem(written(tmp_path, image(vectors)), capfd)


@pytest.mark.parametrize("value, what", [(np.nan, "not finite"), (1.5, "outside [0, 1]")])
def test_bad_values(tmp_path: Path, capfd: pytest.CaptureFixture[str], value: float, what: str) -> None:
    values = LEVELS.copy()
    values[1, 2, 3] = value
    text = problem(written(tmp_path, image(array("fill", values))), capfd)
    assert f"array 'fill': 1 value {what}" in text and "[1, 2, 3]" in text


@pytest.mark.parametrize(("about", "spacing", "origin"), [
    ('Origin="1 2 3" Spacing="0.5 1 1.5"', (0.5, 1, 1.5), (6, -2, 10.5)),
    ('Origin="1 2 3" Spacing="0.5 0.50000001 0.5"', (0.5, 0.5, 0.5), (6, 0, 5.5))])
def test_each_edge_of_a_cell_is_kept_but_not_its_rounding(tmp_path: Path, about: str, spacing: tuple[float, ...],
                                                          origin: tuple[float, ...]) -> None:
    scene = load(written(tmp_path, image(array("fill", LEVELS), extent="10 13 -4 0 5 10", about=about)))
    assert (scene.spacing, scene.origin) == (spacing, origin)


@pytest.mark.parametrize("about, place", [
    ('Origin="0 0 0" Spacing="1 1 150"', "Spacing: is (1.0, 1.0, 150.0); expected edges above 0, the longest up"),
    ('Origin="0 0 0" Spacing="0 0 0"', "Spacing"),
    ('Origin="0 0 0" Spacing="1 1 1" Direction="0 1 0 1 0 0 0 0 1"', "Direction: is rotated")])
def test_lattices_that_cannot_be(tmp_path: Path, capfd: pytest.CaptureFixture[str], about: str, place: str) -> None:
    assert place in problem(written(tmp_path, image(array("fill", LEVELS), about=about)), capfd)


@pytest.mark.parametrize("before", ['<!DOCTYPE VTKFile [<!ENTITY a "b">]>', '<!DOCTYPE VTKFile SYSTEM "http://a/b">',
                                    "<!-- <VTKFile> --><!DOCTYPE VTKFile>"])
def test_document_types_are_refused(tmp_path: Path, capfd: pytest.CaptureFixture[str], before: str) -> None:
    text = image(array("fill", LEVELS), before=before)
    assert "declares a document type or an entity" in problem(written(tmp_path, text), capfd)


@pytest.mark.parametrize("extent, expected", [
    ("0 1000000 0 1000000 0 1000000", "WholeExtent: claims 1000000000000000000 cells"),
    ("0 700 0 700 0 700", "expected at most 200 times its size"), ("0 3 0 4 0 6", "is the file whole?")])
def test_extents_larger_than_the_file(tmp_path: Path, capfd: pytest.CaptureFixture[str],
                                      monkeypatch: pytest.MonkeyPatch, extent: str, expected: str) -> None:
    monkeypatch.setattr(memory, "limit", lambda: 8 << 30)
    assert expected in problem(written(tmp_path, image(array("fill", LEVELS), extent=extent)), capfd)


@pytest.mark.parametrize("head, expected", [
    ((1 << 30, 480, 0, 9), "claims 1073741824 packed blocks"), ((1, 1 << 31, 0, 9), "expected at most 200 times"),
    ((1, 480, 0, 1 << 31), "is the file whole?"), ((1, 479, 0, 9), "is the file whole?")])
@pytest.mark.parametrize("form", ["binary", "base64", "raw"])
def test_packed_blocks_that_claim_too_much(tmp_path: Path, capfd: pytest.CaptureFixture[str],
                                           head: tuple[int, ...], expected: str, form: str) -> None:
    block, packed = struct.pack("<4I", *head), zlib.compress(bytes(480))
    content = block + packed if form == "raw" else base64.b64encode(block) + base64.b64encode(packed)
    text = image('<DataArray type="Float64" Name="fill" format="binary">DATA</DataArray>', coding="zlib").encode()
    if form != "binary":
        appended = b'<AppendedData encoding="%s">_DATA</AppendedData></VTKFile>' % form.encode()
        text = text.replace(b'"binary">DATA', b'"appended" offset="0">').replace(b"</VTKFile>", appended)
    path = tmp_path / "x.vti"
    path.write_bytes(text.replace(b"DATA", content))
    assert expected in problem(path, capfd)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.3, 0.6, 0.9, 0.99])
@pytest.mark.parametrize("coding", ["ascii", "binary", "zlib"])
def test_truncated_files(tmp_path: Path, capfd: pytest.CaptureFixture[str], share: float, coding: str) -> None:
    text = image(array("fill", LEVELS, coding), coding=coding)
    problem(written(tmp_path, text[:int(share * len(text))]), capfd)


def test_what_is_no_image(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert "does not begin as XML" in problem(written(tmp_path, "hello"), capfd)
    assert "cannot be read as VTI" in problem(written(tmp_path, "<?xml version='1.0'?><a/>"), capfd)
    polydata = image(array("fill", LEVELS)).replace("ImageData", "PolyData")
    assert "cannot be read as VTI" in problem(written(tmp_path, polydata), capfd)


def test_real_images_of_labels_are_no_fill_levels(data, capfd: pytest.CaptureFixture[str]) -> None:
    text = problem(data("volumes/channels.vti"), capfd)
    assert "array 'facies'" in text and "expected fill levels" in text
    assert "array 'MetaImage'" in problem(data("volumes/frog_tissues.vti"), capfd)
