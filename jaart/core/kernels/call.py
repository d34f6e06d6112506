"""Calls of kernels by their address, so that a search is compiled once for every surface it may search.

A function that is passed as an argument would be compiled anew for each other function, in every process; an
address is only a number. The caller's and the callee's types must agree: the signatures here are what both are
compiled for.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from jaart.core.kernels import records as r

_VECTOR = types.UniTuple(types.float64, 3)
_CELL = types.UniTuple(types.int64, 3)
_FLOATS = types.Array(types.float64, 1, "C")
_ROWS = types.Array(types.float64, 2, "C")
_NEAR = types.NamedTuple((_FLOATS, types.uint64, types.uint64, types.uint64), r.Near)
_RULE = types.NamedTuple((types.int64, types.int64, types.float64, types.float64, types.int64, types.int64,
                          types.int64, types.float64, types.float64), r.Rule)
_VALUE = types.NamedTuple((types.int64, types.float64, _VECTOR, _VECTOR, types.float64, types.float64, _VECTOR,
                           types.int64), r.Value)
_NUMBERS = types.Array(types.int64, 1, "C")
_SITES = types.NamedTuple((_CELL, _ROWS, _NUMBERS, _NUMBERS), r.Sites)
_SEARCH = types.NamedTuple((types.int64,) * 5 + (types.float64, types.int64, types.int64, types.float64, types.int64,
                                                 types.float64, types.int64, types.int64, types.float64,
                                                 types.int64), r.Search)
_BOUNDS = types.NamedUniTuple(types.float64, 5, r.Bounds)
_START = types.NamedTuple((_CELL, _VECTOR) + (types.float64,) * 5 + (types.int64,), r.Start)
_END = types.NamedTuple((types.int64, types.float64, _VECTOR, _VECTOR, types.float64, types.float64) +
                        (types.int64,) * 4 + (types.float64,) * 2, r.End)
_SPENT = types.NamedUniTuple(types.int64, 4, r.Spent)
_MET = types.NamedTuple((types.int64, types.float64, _VECTOR, _CELL, _VECTOR, _VALUE, _VECTOR, _CELL, _VECTOR,
                         types.float64, types.int64, types.int64), r.Met)

#: evaluate(near, x, rule, want, work, fit) -> Value.
EVALUATE = _VALUE(_NEAR, _VECTOR, _RULE, types.int64, _FLOATS, _FLOATS)
#: search(sites, rule, how, bounds, direction, start, rows, row, work, fit) -> End.
SEARCH = _END(_SITES, _RULE, _SEARCH, _BOUNDS, _VECTOR, _START, _ROWS, types.int64, _FLOATS, _FLOATS)
#: approach(value, direction, slope, reach, rule, fit) -> step.
APPROACH = types.float64(_VALUE, _VECTOR, types.float64, types.float64, _RULE, _FLOATS)
#: accept(sites, rule, how, bounds, met, spent, work, fit) -> End.
ACCEPT = _END(_SITES, _RULE, _SEARCH, _BOUNDS, _MET, _SPENT, _FLOATS, _FLOATS)
#: gather(pool, place) -> address of its block, 0 where there is no room.
GATHER = types.int64(_NUMBERS, _CELL)


def _caller(signature: Any) -> Any:
    """The lowering of a call through an address with a fixed signature."""
    def generate(context: Any, builder: Any, typed: Any, arguments: Any) -> Any:
        kind = context.call_conv.get_function_type(signature.return_type, signature.args)
        pointer = builder.inttoptr(arguments[0], kind.as_pointer())
        status, result = context.call_conv.call_function(builder, pointer, signature.return_type, signature.args,
                                                         arguments[1:])
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return result

    return generate


@intrinsic
def evaluate_at(typing_context: Any, address: Any, near: Any, x: Any, rule: Any, want: Any, work: Any,
                fit: Any) -> Any:
    """Evaluate the surface whose evaluator stands at an address."""
    return EVALUATE.return_type(types.int64, *EVALUATE.args), _caller(EVALUATE)


@intrinsic
def search_from(typing_context: Any, address: Any, sites: Any, rule: Any, how: Any, bounds: Any, d: Any, start: Any,
                rows: Any, row: Any, work: Any, fit: Any) -> Any:
    """Run the search that stands at an address from a start on a ray."""
    return SEARCH.return_type(types.int64, *SEARCH.args), _caller(SEARCH)


@intrinsic
def approach_at(typing_context: Any, address: Any, v: Any, d: Any, slope: Any, reach: Any, rule: Any,
                fit: Any) -> Any:
    """Step to the fitted surface, by what stands at an address."""
    return APPROACH.return_type(types.int64, *APPROACH.args), _caller(APPROACH)


@intrinsic
def accept_at(typing_context: Any, address: Any, sites: Any, rule: Any, how: Any, bounds: Any, met: Any, spent: Any,
              work: Any, fit: Any) -> Any:
    """Let what stands at an address say what becomes of a hit."""
    return ACCEPT.return_type(types.int64, *ACCEPT.args), _caller(ACCEPT)


@intrinsic
def gather_at(typing_context: Any, address: Any, pool: Any, place: Any) -> Any:
    """Gather what is near a place, by what stands at an address."""
    return GATHER.return_type(types.int64, *GATHER.args), _caller(GATHER)
