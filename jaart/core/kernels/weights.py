"""The Gaussian weight [T 2.7], in a form that vectorises on every machine."""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic

from jaart.core.kernels.jit import STRICT, kernel

_LOG2_E = 1.4426950408889634
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
#: Adding it rounds to a whole number, which then stands in the low bits of the sum.
_ROUND = 6755399441055744.0
#: exp(-708) is the smallest power that is still normal; farther surfels get its weight, 3e-308.
_LARGEST = 708.0


@intrinsic
def _bits(typing_context: Any, number: Any) -> Any:
    """The bits of a float as an integer."""
    from llvmlite import ir

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), generate


@intrinsic
def _float(typing_context: Any, bits: Any) -> Any:
    """The float that has these bits."""
    from llvmlite import ir

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), generate


@kernel(STRICT)
def exp_minus(y: float) -> float:
    """exp(-y) for y >= 0 within 2 units in the last place; NaN stays NaN.

    -y = k ln 2 + r with |r| <= ln 2 / 2; the Taylor polynomial of degree 13 leaves 4e-18.
    """
    y = _LARGEST if y > _LARGEST else y
    rounded = _ROUND - y * _LOG2_E
    k = rounded - _ROUND
    r = (-y - k * _LN2_HIGH) - k * _LN2_LOW
    p = 1 / 479001600 + r * (1 / 6227020800)
    p = 1 / 3628800 + r * (1 / 39916800 + r * p)
    p = 1 / 40320 + r * (1 / 362880 + r * p)
    p = 1 / 720 + r * (1 / 5040 + r * p)
    p = 1 / 24 + r * (1 / 120 + r * p)
    p = 0.5 + r * (1 / 6 + r * p)
    p = 1.0 + r * (1.0 + r * p)
    return p * _float((_bits(rounded) + 1023) << 52)
