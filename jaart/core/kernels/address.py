"""Arrays that begin at an address, and numbers that two threads share.

What stands at an address is not counted, so whoever hands the address out keeps the memory alive. A number that tells
others where something lies is written after all that lies there, and read before it, on every processor. What is
fetched ahead is read sooner; nothing else changes by it.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

#: Bytes of a number in the arrays that threads share.
_WIDE = 8


def _view(kind: Any) -> Any:
    """The lowering of an array of a kind over the memory that begins at an address."""
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(kind)(context, builder)
        width = context.get_abi_sizeof(context.get_data_type(kind.dtype))
        item, count = context.get_constant(types.intp, width), arguments[1]
        three, row = (context.get_constant(types.intp, n) for n in (3, 3 * width))
        shape, strides = ((count,), (item,)) if kind.ndim == 1 else ((count, three), (row, item))
        data = builder.inttoptr(arguments[0], array.data.type)
        populate_array(array, data=data, shape=cgutils.pack_array(builder, shape),
                       strides=cgutils.pack_array(builder, strides), itemsize=item, meminfo=None)
        return array._getvalue()

    return kind(types.int64, types.int64), generate


@intrinsic
def floats_at(typing_context: Any, address: Any, count: Any) -> Any:
    """So many float64 numbers."""
    return _view(types.Array(types.float64, 1, "C"))


@intrinsic
def wholes_at(typing_context: Any, address: Any, count: Any) -> Any:
    """So many int64 numbers."""
    return _view(types.Array(types.int64, 1, "C"))


@intrinsic
def ids_at(typing_context: Any, address: Any, count: Any) -> Any:
    """So many int32 numbers."""
    return _view(types.Array(types.int32, 1, "C"))


@intrinsic
def points_at(typing_context: Any, address: Any, count: Any) -> Any:
    """So many rows of three float64 numbers."""
    return _view(types.Array(types.float64, 2, "C"))


def _place(context: Any, builder: Any, kind: Any, array: Any, index: Any) -> Any:
    """Pointer to a number of an array."""
    return builder.gep(context.make_array(kind)(context, builder, array).data, [index])


@intrinsic
def load(typing_context: Any, numbers: Any, index: Any) -> Any:
    """A shared number; what was written before it can be read after it."""
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load_atomic(_place(context, builder, numbers, *arguments), "acquire", _WIDE)

    return types.int64(numbers, types.int64), generate


@intrinsic
def set_once(typing_context: Any, numbers: Any, index: Any, value: Any) -> Any:
    """Make a shared number that is 0 another; returns what it was, and where that was not 0 it stays."""
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array, at, new = arguments
        none = context.get_constant(types.int64, 0)
        return builder.extract_value(builder.cmpxchg(_place(context, builder, numbers, array, at), none, new,
                                                     "acq_rel", "acquire"), 0)

    return types.int64(numbers, types.int64, types.int64), generate


@intrinsic
def fetch(typing_context: Any, numbers: Any, index: Any) -> Any:
    """Have a number of an array, counted through all its rows, at hand soon; it may lie beyond the end."""
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        byte, word = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), (byte, word, word, word))
        ask = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        to_read, nearest, data = (ir.Constant(word, n) for n in (0, 3, 1))
        place = builder.bitcast(_place(context, builder, numbers, *arguments), byte)
        builder.call(ask, (place, to_read, nearest, data))
        return context.get_dummy_value()

    return types.void(numbers, types.int64), generate
