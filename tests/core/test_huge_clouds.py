"""Lengths of clouds as large as float64 takes them."""

from __future__ import annotations

import numpy as np
import pytest

from jaart.core.errors import SettingsError
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Scene
from jaart.core.settings import Settings


@pytest.mark.parametrize("scale", [2.0**60, 2.0**300])
def test_shares_of_a_huge_cloud_are_lengths(scale: float) -> None:
    around = fibonacci(200)
    settings = Settings(h="0.12d", radius="0.5d", max_nearest="0.2d", max_off_centre="1s")
    one, huge = (render(Scene("ball", points=around * s, normals=around), settings, rays=(3 * s * around, -around))
                 for s in (1.0, scale))
    assert one.hit.any() and np.array_equal(one.t * scale, huge.t, equal_nan=True)


def test_a_share_that_is_no_length_is_refused() -> None:
    single = Scene("single", points=np.zeros((1, 3)), normals=np.array([[0, 0, 1.0]]))
    with pytest.raises(SettingsError, match="h = 0"):
        render(single, Settings(h="0.1d"), rays=(np.array([[0, 0, 5.0]]), np.array([[0, 0, -1.0]])))
