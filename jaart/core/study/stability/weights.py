"""Rows 30 and 31: sums that are empty, and an energy where it is 0/0."""

from __future__ import annotations

import numpy as np

from jaart.core.records import STATUS
from jaart.core.settings import Settings
from jaart.core.study.stability.case import Outcome, case
from jaart.core.study.stability.looks import thesis_sphere
from jaart.core.study.stability.rays import SEARCHES
from jaart.core.study.stability.scenes import plane, shot
from jaart.core.trace import trace

#: No bound that would refuse a hit where nothing weighs anything.
FREE = Settings(h="1.0", max_nearest="none", max_off_centre="none", tolerance=1e-9)


@case(30, "weights that end, and rays where they are all 0, in a cloud and a lattice",
      "no surface there: background, and no NaN in a hit")
def weights_that_sum_to_nothing() -> Outcome:
    """Beside the plane and the sphere nothing is in reach; the last ray of each shows that the scene is there."""
    missed, hits = 0, []
    for weight in ("hat", "squared_hat", "wendland"):
        for search in SEARCHES:
            settings = FREE.replace(weight=weight, search=search)
            flat = shot(plane(), settings, [[20, 0, 5], [7, 7, 5], [0.3, 0.2, 5]], [[0, 0, -1]] * 3)
            ball = shot(thesis_sphere(), settings.replace(h=0.6), [[1, 1, 20], [8, 1, 20], [8.2, 8.3, 20]],
                        [[0, 0, -1]] * 3)
            missed += sum(int((found.status[:2] == STATUS["background"]).sum()) for found in (flat, ball))
            hits += [found for found in (flat, ball) if found.hit[2]]
    finite = all(np.isfinite([h.t[2], *h.point[2], *h.normal[2]]).all() for h in hits)
    return Outcome(f"{missed} of 84 rays background; {len(hits)} of 42 others hit, "
                   f"{'all finite' if finite else 'not all finite'}", missed == 84 and len(hits) == 42 and finite)


@case(31, "e_angle at x = a(x), where it is the angle of a vector of length 0",
      "0, as it is everywhere on the surface; no hit refused by a bound on it")
def angle_with_a_vector_of_length_zero() -> Outcome:
    """Along the plane's normal through a point of even symmetry e_angle is 1 beside x = a(x), and 0 at it."""
    at = float(trace(plane(), FREE, (0, 0, 0), (0, 0, 1)).curves.angle[0])
    beside = float(trace(plane(), FREE, (0, 0, 1e-9), (0, 0, 1)).curves.angle[0])
    bounded = shot(plane(), FREE.replace(max_angle=0.0), [[0, 0, 3], [0, 0, 3]], [[0, 0, -1], [0, 1, -1]])
    return Outcome(f"{at:g} at a(x), {beside:g} above it; {int(bounded.hit.sum())} of 2 hits at an angle of 0 or less",
                   at == 0 and abs(beside - 1) < 1e-12 and bool(bounded.hit.all()))
