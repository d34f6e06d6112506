"""What must hold of a VTI file before VTK is given it: VTK ends the process where a packed block claims too much."""

from __future__ import annotations

import base64
import binascii
import mmap
import re
import struct
from collections.abc import Iterator
from pathlib import Path

from jaart.core.errors import FileError
from jaart.core.io.values import check_ratio

_ARRAY = re.compile(rb"<DataArray\b[^>]*>")
_APPENDED = re.compile(rb"<AppendedData\b[^>]*>\s*_")


def check(path: Path) -> None:
    """Raise FileError for what is no plain XML, has a document type, or claims packed blocks it cannot hold."""
    if path.stat().st_size == 0:
        raise FileError(path, "is empty; expected a VTI file")
    with path.open("rb") as stream, mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as text:
        if text[:64].removeprefix(b"\xef\xbb\xbf").lstrip()[:5] not in (b"<?xml", b"<VTKF"):
            raise FileError(path, "does not begin as XML in ASCII or UTF-8; expected a VTI file")
        for word in (b"<!DOCTYPE", b"<!ENTITY"):
            if (at := text.find(word)) >= 0:
                raise FileError(path, "declares a document type or an entity; these are refused", f"byte {at}")
        for start, count, size in _packed(text):
            if count > len(text):
                raise FileError(path, f"claims {count} packed blocks in {len(text)} bytes", f"byte {start}")
            check_ratio(path, count * size, len(text))


def _packed(text: mmap.mmap) -> Iterator[tuple[int, int, int]]:
    """Where each packed array starts, how many blocks it claims and how many bytes each would unpack to."""
    appended = _APPENDED.search(text)
    root = text[text.find(b"<VTKFile"):][:4096].partition(b">")[0]
    if not _attribute(root, b"compressor"):
        return
    code = "Q" if _attribute(root, b"header_type") == b"UInt64" else "I"
    head = struct.Struct((">" if _attribute(root, b"byte_order") == b"BigEndian" else "<") + 2 * code)
    for array in _ARRAY.finditer(text, 0, appended.start() if appended else len(text)):
        form, offset = _attribute(array[0], b"format"), _attribute(array[0], b"offset")
        if form == b"ascii" or (form == b"appended" and not (appended and offset.isdigit())):
            continue
        start = array.end() if appended is None or form == b"binary" else appended.end() + int(offset)
        raw = form == b"appended" and appended is not None and _attribute(appended[0], b"encoding") == b"raw"
        found = text[start:start + head.size] if raw else _decoded(text[start:start + 4096])[:head.size]
        if len(found) == head.size:
            yield start, *head.unpack(found)


def _attribute(tag: bytes, name: bytes) -> bytes:
    """The value of an attribute, b"" when there is none."""
    match = re.search(rb"\s" + name + rb"""\s*=\s*["']([^"']*)["']""", tag)
    return match[1].strip() if match else b""


def _decoded(text: bytes) -> bytes:
    """The first bytes of a base64 text."""
    try:
        return base64.b64decode(text.lstrip()[:32])
    except binascii.Error:
        return b""
