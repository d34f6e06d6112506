"""Writes files whole or not at all."""

from __future__ import annotations

import os
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from jaart.core.errors import FileError

#: What is being written, and who may begin or finish a file.
_PARTS: set[Path] = set()
_TURN = threading.Lock()


@contextmanager
def replacing(path: str | PathLike[str]) -> Iterator[Path]:
    """A temporary path beside a file, moved onto it when the block succeeds, removed when it fails.

    The temporary name keeps the suffix, by which many writers choose the format. Raises FileError
    when the folder cannot be written to; errors of the block pass through, those of the system as FileError.
    """
    target = Path(path)
    temporary: Path | None = None
    try:
        with _TURN:
            handle, name = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent)
            temporary = Path(name)
            _PARTS.add(temporary)
        os.close(handle)
        yield temporary
        temporary.chmod(_mode(target))
        with _TURN:
            temporary.replace(target)
    except OSError as error:
        raise FileError(target, f"cannot be written: {error.strerror or error}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
            _PARTS.discard(temporary)


@contextmanager
def none_written() -> Iterator[None]:
    """Remove what is being written; no file is begun or finished in the block. For a process that ends in it."""
    with _TURN:
        for part in list(_PARTS):
            part.unlink(missing_ok=True)
        yield


def _mode(target: Path) -> int:
    """The permissions of the file that is replaced, or those of a new file."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
