"""Finds the files that come with Jaart."""

from __future__ import annotations

from pathlib import Path

from jaart.core.errors import FileError

_PACKAGE = Path(__file__).resolve().parents[1]


def resource(name: str) -> Path:
    """The file of this name in resources/: in the installed package, or beside it in a checkout.

    Raises FileError when there is none.
    """
    for folder in (_PACKAGE / "resources", _PACKAGE.parent / "resources"):
        if (folder / name).is_file():
            return folder / name
    raise FileError(name, "not among the files that come with Jaart; the installation is incomplete")
