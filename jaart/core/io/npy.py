"""Arrays inside an .npz: what they claim is known before any memory is taken, and nothing in them is run."""

from __future__ import annotations

import lzma
import math
import re
import struct
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from jaart.core import memory
from jaart.core.errors import FileError
from jaart.core.io.values import check_memory, check_ratio

_DESCR = re.compile(r"""['"]descr['"]\s*:\s*['"]([^'"]*)['"]""")
_ORDER = re.compile(r"""['"]fortran_order['"]\s*:\s*(True|False)""")
_SHAPE = re.compile(r"""['"]shape['"]\s*:\s*\(([0-9,\s]*)\)""")
_PLAIN = re.compile(r"[<>=|]?(b1|[iu][1248]|f[248])")

#: What a damaged archive raises, from the archive or from what unpacks it.
DAMAGE = (zipfile.BadZipFile, zlib.error, EOFError, struct.error, RuntimeError, ValueError, OverflowError,
          lzma.LZMAError)


@dataclass(frozen=True)
class Header:
    """What an array says of itself. start: bytes before its first value."""

    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    fortran: bool
    start: int

    @property
    def nbytes(self) -> int:
        """Bytes of its values."""
        return math.prod(self.shape) * self.dtype.itemsize


class Archive:
    """The arrays of an open .npz, by name. Errors are FileErrors that name the array."""

    def __init__(self, path: Path, zipped: zipfile.ZipFile) -> None:
        self.path, self.zipped = path, zipped
        members = zipped.infolist()
        check_ratio(path, sum(m.file_size for m in members), path.stat().st_size)
        self.members = {m.filename.removesuffix(".npy"): m for m in members}

    def __contains__(self, name: str) -> bool:
        return name in self.members

    def header(self, name: str) -> Header:
        """Type and shape of an array of plain numbers, checked against the bytes it has."""
        with self.zipped.open(self.members[name]) as stream:
            header = self._parsed(name, stream)
        if header.start + header.nbytes != self.members[name].file_size:
            has = self.members[name].file_size - header.start
            raise self.error(name, f"claims shape {header.shape}, which needs {memory.words(header.nbytes)} of memory, "
                                   f"but has {has} of {header.nbytes} bytes; is the file whole?")
        return header

    def read(self, name: str, frame: int | None = None) -> NDArray[Any]:
        """The array, or only one entry along its first axis."""
        header = self.header(name)
        whole = frame is None or header.fortran  # entries lie one after the other in C order only
        count = 1 if whole else header.shape[0]
        check_memory(self.path, math.prod(header.shape) // count, f"array {name!r}")
        wanted = header.nbytes // count
        with self.zipped.open(self.members[name]) as stream:
            stream.read(header.start)
            for _ in range(0 if whole else frame or 0):
                stream.read(wanted)
            data = stream.read(wanted)
            while stream.read(1 << 20):  # to the end, where the archive checks its sum
                pass
        array = np.frombuffer(data, header.dtype)
        if not whole:
            return array.reshape(header.shape[1:])
        array = array.reshape(header.shape, order="F" if header.fortran else "C")
        return array if frame is None else array[frame]

    def error(self, name: str, problem: str) -> FileError:
        """The error to raise for an array."""
        return FileError(self.path, problem, f"array {name!r}")

    def _parsed(self, name: str, stream: Any) -> Header:
        magic = stream.read(8)
        if len(magic) < 8 or magic[:6] != b"\x93NUMPY" or magic[6] not in (1, 2, 3):
            raise self.error(name, "is no .npy array")
        width = 2 if magic[6] == 1 else 4
        length = int.from_bytes(stream.read(width), "little")
        if length > 1 << 16:
            raise self.error(name, f"has a header of {length} bytes; expected at most {1 << 16}")
        text = stream.read(length).decode("latin-1")
        descr, order, shape = (pattern.search(text) for pattern in (_DESCR, _ORDER, _SHAPE))
        if descr is None or not _PLAIN.fullmatch(descr[1]):
            raise self.error(name, f"has type {descr[1] if descr else 'unknown'!r}; expected plain numbers")
        if order is None or shape is None:
            raise self.error(name, "has no shape in its header; expected one array of numbers")
        numbers = tuple(int(n) for n in re.findall(r"[0-9]{1,18}", shape[1]))
        return Header(np.dtype(descr[1]), numbers, order[1] == "True", 8 + width + length)
