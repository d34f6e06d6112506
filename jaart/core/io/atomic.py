"""Writes files whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from jaart.core.errors import FileError
from jaart.core.unfinished import PARTS, TURN


@contextmanager
def replacing(path: str | PathLike[str]) -> Iterator[Path]:
    """A temporary path beside a file, moved onto it when the block succeeds, removed when it fails.

    The temporary name keeps the suffix, by which many writers choose the format. Raises FileError
    when the folder cannot be written to; errors of the block pass through, those of the system as FileError.
    """
    target = Path(path)
    temporary: Path | None = None
    try:
        with TURN:
            handle, name = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent)
            temporary = Path(name)
            PARTS.add(temporary)
        os.close(handle)
        yield temporary
        temporary.chmod(_mode(target))
        with TURN:
            temporary.replace(target)
    except OSError as error:
        raise FileError(target, f"cannot be written: {error.strerror or error}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
            PARTS.discard(temporary)


def _mode(target: Path) -> int:
    """The permissions of the file that is replaced, or those of a new file."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
