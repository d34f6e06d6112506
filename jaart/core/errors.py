"""The errors that a person may see: each says what, where, and what was expected."""

from __future__ import annotations

from os import PathLike


class JaartError(Exception):
    """Anything Jaart cannot do; the message is one clear line."""


class FileError(JaartError):
    """A file that cannot be read or written.

    path: the file; place: line, byte, element or array in it ("" for the whole file);
    problem: what is wrong and what was expected.
    """

    def __init__(self, path: str | PathLike[str], problem: str, place: str = "") -> None:
        self.path, self.place, self.problem = str(path), place, problem
        where = f"{path}: {place}" if place else str(path)
        super().__init__(f"{where}: {problem}")


class SettingsError(JaartError):
    """A parameter with a value it cannot take, or one that has no meaning here."""


class NoRoom(SettingsError):
    """What rays ask for does not fit into memory. room: where it was to be kept."""

    def __init__(self, message: str, room: object) -> None:
        super().__init__(message)
        self.room = room


class RayError(JaartError):
    """A ray or a camera that cannot be traced."""


class Cancelled(JaartError):
    """The work was stopped because newer work replaced it."""
