"""How kernels are compiled: without the interpreter's lock, NaN kept, cached by their sources."""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

F = TypeVar("F", bound=Callable[..., Any])

#: Sums may be regrouped so that they vectorise; NaN and infinity keep their meaning.
VECTOR = {"reassoc", "contract", "nsz", "arcp"}
#: Nothing may be regrouped: for code that relies on the order of its operations.
STRICT = {"contract"}
#: Not even a product and a sum are rounded as one: the same bits wherever the code is put.
EXACT: set[str] = set()


#: Whether every kernel can be called from outside: tests look into them.
CALLABLE = "JAART_CALL_KERNELS" in os.environ


def _sources_hash() -> str:
    """A hash of every kernel's source: numba does not notice a change in a function that is called."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.read_bytes())
    digest.update(f"{CALLABLE} {numba.__version__} {sys.version_info[:2]}".encode())
    return digest.hexdigest()[:16]


def _user_cache() -> Path:
    from platformdirs import user_cache_path

    return Path(os.environ.get("JAART_CACHE") or user_cache_path("jaart"))


def _usable(folder: Path) -> bool:
    """Whether the folder is there, or could be made, for us to write."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


#: Where the machine code of these sources is kept, if it can be: else each process compiles them anew.
CACHE = _user_cache() / f"kernels-{_sources_hash()}"
_CACHED = _usable(CACHE)


def kept() -> bool:
    """Whether compiled kernels can be kept for the next process."""
    return _CACHED


def kernel(flags: set[str] = VECTOR, inline: bool = False, entry: bool = False,
           allocates: bool = False) -> Callable[[F], F]:
    """Compile a function to machine code that releases the interpreter's lock.

    flags: floating-point freedoms, VECTOR or STRICT; inline: also where the compiler would rather call; entry: it
    can be called from outside, which the others can where JAART_CALL_KERNELS is set, for a third more compile time;
    allocates: it makes arrays. The others do not count who uses an array, which would cost two atomic instructions for
    each that is handed on.
    Division by zero gives infinity or NaN.
    """

    def compile_into_cache(function: F) -> F:
        before = numba.config.CACHE_DIR
        numba.config.CACHE_DIR = str(CACHE)
        try:
            return numba.njit(function, nogil=True, cache=_CACHED, fastmath=flags, error_model="numpy",
                              forceinline=inline, no_cfunc_wrapper=True, _nrt=allocates,
                              no_cpython_wrapper=not (entry or CALLABLE))
        finally:
            numba.config.CACHE_DIR = before

    return compile_into_cache
