"""Hits and rays as files hold them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from jaart.core.cloud_surfels import Points
from jaart.core.export import hits_arrays, save_statistics_csv, save_trace_json, trace_record, trace_rows
from jaart.core.io import load
from jaart.core.render import render
from jaart.core.samples import fibonacci
from jaart.core.scene import Scene
from jaart.core.settings import Settings
from jaart.core.statistics import statistics
from jaart.core.trace import trace

CLOUD = Scene("ball", points=fibonacci(800))


def test_hits_hold_what_their_normals_are() -> None:
    hits = render(CLOUD, Settings(shading_normal="gradient"), size=(8, 8))
    arrays = hits_arrays(hits)
    assert arrays["shading_normal"] == "gradient"
    assert arrays["lowered"] is hits.lowered
    assert {len(arrays[name]) for name in ("t", "hit", "cells", "lowered", "status")} == {64}


@pytest.mark.parametrize("bare", [True, False])
def test_a_ray_in_a_cloud_in_plain_numbers(tmp_path: Path, bare: bool) -> None:
    scene = CLOUD if bare else Scene("ball", points=CLOUD.points, normals=CLOUD.points)
    followed = trace(scene, Settings(), (0.1, 0.2, 5), (0, 0, -1))
    save_trace_json(followed, tmp_path / "t.json")
    record = json.loads((tmp_path / "t.json").read_text(), parse_constant=pytest.fail)
    assert record == json.loads(json.dumps(trace_record(followed)))
    assert (record["low"], record["high"]) == (followed.low.tolist(), followed.high.tolist())
    assert isinstance(followed.surfels, Points)
    for index, normal in zip(record["surfels"]["index"], record["surfels"]["normal"], strict=True):
        assert normal == ([None] * 3 if bare else followed.surfels.normal[index].tolist())
    for i, step in enumerate(record["steps"]):
        assert len(record["balls"][step["ball"]]) == 4 and "cell" not in step
        assert trace_rows(followed)[1 + i][3] == step["ball"]


def test_rows_of_a_lattice_and_a_cloud_have_as_many_columns_as_their_header() -> None:
    for scene, ray in ((CLOUD, ((0.1, 0.2, 5), (0, 0, -1))), (load("standard"), ((-3, 8.1, 6.2), (1, 0, 0)))):
        rows = trace_rows(trace(scene, Settings(), *ray))
        assert len(rows) > 1 and len({len(row) for row in rows}) == 1
        assert ("ball" in rows[0]) == (scene is CLOUD) != ("cell_i" in rows[0])


def test_statistics_as_a_table(tmp_path: Path) -> None:
    hits = render(CLOUD, size=(8, 8))
    save_statistics_csv(statistics(hits), tmp_path / "s.csv")
    lines = (tmp_path / "s.csv").read_text().splitlines()
    assert lines[:3] == ["statistic,bin,value", "rays,,64", f"hits,,{int(np.sum(hits.hit))}"]
