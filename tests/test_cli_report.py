"""What the commands say of a picture's errors."""

from __future__ import annotations

import numpy as np

from jaart.cli_report import hits_line
from jaart.core.io import load
from jaart.core.quality import quality
from jaart.core.render import render
from jaart.core.statistics import statistics
from jaart.plot.statistics import statistics_figure


def test_no_relevant_ray_is_said_in_the_place_of_nan() -> None:
    scene = load("standard")
    past = render(scene, rays=(np.array([[99.0, 0, 0], [0, 99.0, 0]]), np.array([[0.0, 0, 1], [0, 0, 1]])))
    line = hits_line(past, scene, quality(past, scene))
    assert "no relevant rays" in line and "nan" not in line
    met = render(scene, rays=(np.array([[11.2, 11.2, 40.0]]), np.array([[0.0, 0, -1]])))
    line = hits_line(met, scene, quality(met, scene))
    assert "delta_p" in line and "no relevant rays" not in line and "nan" not in line


def test_nor_does_the_figure_hold_nan() -> None:
    scene = load("standard")
    past = render(scene, rays=(np.array([[99.0, 0, 0]]), np.array([[0.0, 0, 1]])))
    figure = statistics_figure(statistics(past, quality(past, scene)))
    texts = " ".join(text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_title(loc="left")))
    assert "no relevant rays" in texts and "nan" not in texts
