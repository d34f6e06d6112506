"""What a ray took that no evaluation hands back: counted behind the coefficients of its fit, where every kernel can.

EIGENVECTORS: of covariances, for the normal; GRADIENTS: passes over the surfels for ∇f in closed form; STARTS: searches
begun.
"""

from __future__ import annotations

from jaart.core.kernels import records as r
from jaart.core.kernels.jit import STRICT, kernel
from jaart.core.kernels.records import Array, Out


@kernel(STRICT)
def write_counts(out: Out, to: int, fit: Array) -> None:
    """Write what a ray took into its row of the columns, and count from 0 again."""
    out.starts[to] = int(fit[r.STARTS])
    out.eigenvectors[to] = int(fit[r.EIGENVECTORS])
    out.gradients[to] = int(fit[r.GRADIENTS])
    forget_counts(fit)


@kernel(STRICT)
def forget_counts(fit: Array) -> None:
    """Count from 0 again."""
    fit[r.STARTS] = fit[r.EIGENVECTORS] = fit[r.GRADIENTS] = 0.0
