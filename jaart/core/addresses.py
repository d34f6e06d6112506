"""Where the machine code of a kernel begins, for calls by address."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any

_LOCK = Lock()


def compiled(function: Any) -> bool:
    """Whether a kernel is loaded, or its machine code lies in the user's cache."""
    if function.overloads:
        return True
    kept = function._cache
    return any(Path(kept.cache_path).glob(f"{kept._impl.filename_base}*.nbi"))


@cache
def address_of(function: Any, signature: Any) -> int:
    """Where the machine code of a kernel begins, compiled or loaded for exactly these types."""
    with _LOCK:
        function.compile(signature.args)
        made = function.overloads[signature.args]
        assert made.signature.return_type == signature.return_type, (function, made.signature)
        address: int = made.library.get_pointer_to_function(made.fndesc.llvm_func_name)
        return address

