"""What the window needs from the system, checked before Qt starts: Qt itself would abort without a word."""

from __future__ import annotations

import ctypes
import os
import sys

from jaart.core.errors import JaartError

#: Shared libraries that Qt and VTK load, and the Debian packages that bring them.
NEEDED = {
    "libglib-2.0.so.0": "libglib2.0-0", "libGL.so.1": "libgl1", "libEGL.so.1": "libegl1",
    "libfontconfig.so.1": "libfontconfig1", "libdbus-1.so.3": "libdbus-1-3", "libxkbcommon.so.0": "libxkbcommon0"}
NEEDED_X11 = {
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0", "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4", "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-shape.so.0": "libxcb-shape0"}


def check() -> None:
    """Raise JaartError, in one line, when there is no display or a system library is missing."""
    if not sys.platform.startswith("linux"):
        return
    os.environ.setdefault("QT_API", "pyside6")
    platform = os.environ.get("QT_QPA_PLATFORM", "")
    x11 = platform.startswith("xcb") or (not platform and bool(os.environ.get("DISPLAY")))
    packages = missing({**NEEDED, **(NEEDED_X11 if x11 else {})})
    if packages:
        raise JaartError("the window needs system libraries that are missing; as root: apt-get install "
                         + " ".join(packages))
    if x11:
        _check_display()
    elif not platform and not os.environ.get("WAYLAND_DISPLAY"):
        raise JaartError("no display: DISPLAY is not set; the commands render, trace and info work without one")


def missing(needed: dict[str, str]) -> list[str]:
    """The packages of those libraries that cannot be loaded."""
    return [package for library, package in needed.items() if not _loads(library)]


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _check_display() -> None:
    xcb = ctypes.CDLL("libxcb.so.1")
    xcb.xcb_connect.restype = ctypes.c_void_p
    connection = ctypes.c_void_p(xcb.xcb_connect(None, None))
    broken = xcb.xcb_connection_has_error(connection)
    xcb.xcb_disconnect(connection)
    if broken:
        raise JaartError(f"no display: cannot connect to DISPLAY={os.environ.get('DISPLAY', '')!r}; "
                         "the commands render, trace and info work without one")
