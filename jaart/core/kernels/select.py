"""The k-th smallest of some numbers."""

from __future__ import annotations

import numpy as np

from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Unsigned

_ONE: Unsigned = np.uint64(1)


@kernel(STRICT)
def kth_smallest(a: Array, n: Unsigned, k: int) -> tuple[float, int]:
    """The k-th smallest (1 = least) of the numbers a[n … 2n), and how many equal to it are among the k least.

    They are reordered in place, by partition around the middle one.
    """
    first, low, high = n, n, n + n - _ONE
    wanted = n + np.uint64(k) - _ONE
    while low < high:
        pivot = a[low + (high - low) // np.uint64(2)]
        i, j = low, high
        while i <= j:
            while a[i] < pivot:
                i += _ONE
            while a[j] > pivot:
                j -= _ONE
            if i <= j:
                a[i], a[j] = a[j], a[i]
                i += _ONE
                j -= _ONE
        if wanted <= j:
            high = j
        elif wanted >= i:
            low = i
        else:
            break
    bound, below = a[wanted], 0
    for at in range(first, first + n):
        below += 1 if a[at] < bound else 0
    return bound, k - below
