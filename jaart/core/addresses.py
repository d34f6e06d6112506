"""Where the machine code of a kernel begins, for calls by address."""

from __future__ import annotations

from functools import cache
from threading import Lock
from typing import Any

_LOCK = Lock()


@cache
def address_of(function: Any, signature: Any) -> int:
    """Where the machine code of a kernel begins, compiled or loaded for exactly these types."""
    with _LOCK:
        function.compile(signature.args)
        compiled = function.overloads[signature.args]
        assert compiled.signature.return_type == signature.return_type, (function, compiled.signature)
        address: int = compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name)
        return address

