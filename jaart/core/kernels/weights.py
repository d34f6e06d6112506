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
#: Of the polynomial that is nearest to exp over -ln 2 / 2 … ln 2 / 2.
_C = (1.0, 1.0, 0.5000000000000019, 0.1666666666666668, 0.04166666666648809, 0.008333333333319601,
      0.0013888888952314812, 0.00019841269890047143, 2.480148548228773e-05, 2.7557240918547625e-06,
      2.763263965412376e-07, 2.511003761756205e-08)


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

    -y = k ln 2 + r with |r| <= ln 2 / 2; the Chebyshev polynomial of degree 11 leaves 4e-18. Its terms are added in
    pairs and pairs of pairs [Estrin 1960], which wait less for each other than one after the other.
    """
    y = _LARGEST if y > _LARGEST else y
    rounded = _ROUND - y * _LOG2_E
    k = rounded - _ROUND
    r = (-y - k * _LN2_HIGH) - k * _LN2_LOW
    r2 = r * r
    r4 = r2 * r2
    low = (_C[0] + r * _C[1]) + r2 * (_C[2] + r * _C[3])
    middle = (_C[4] + r * _C[5]) + r2 * (_C[6] + r * _C[7])
    high = (_C[8] + r * _C[9]) + r2 * (_C[10] + r * _C[11])
    p = low + r4 * (middle + r4 * high)
    return p * _float((_bits(rounded) + 1023) << 52)
