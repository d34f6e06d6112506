"""What `jaart info` says of clouds."""

from __future__ import annotations

import json

import numpy as np
import pytest

from jaart.__main__ import main
from jaart.core import cloud
from jaart.core.samples import COUNT, bumpy_sphere


def test_info_of_the_built_in_cloud(capsys):
    assert main(["info", "bumpy", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    scene = bumpy_sphere()
    low, high = cloud.bounds(scene)
    assert (record["source"], record["kind"], record["points"], record["normals"]) == ("bumpy", "cloud", COUNT, False)
    assert (record["low"], record["high"]) == (low.tolist(), high.tolist())
    assert record["diagonal"] == cloud.diagonal(scene)
    assert record["spacing"] == cloud.spacing(scene)
    assert record["auto_h"] == pytest.approx(1.2 * record["spacing"], rel=0.1)
    assert (record["duplicates"], record["notes"]) == (0, [])


def test_info_says_in_words_what_was_repaired(tmp_path, capsys):
    normals = np.tile([0.0, 0, 2], (4, 1))
    np.savez(tmp_path / "x.npz", points=[[0.0, 0, 0], [3, 4, 0], [0, 0, 0], [6, 8, 0]], normals=normals, scan=[1])
    assert main(["info", str(tmp_path / "x.npz")]) == 0
    rows = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()[1:]]
    assert ["points", "3"] in rows and ["normals", "one for each point"] in rows
    assert ["size", "6 × 8 × 0, diagonal 10"] in rows
    assert ["from", "(0, 0, 0)"] in rows and ["to", "(6, 8, 0)"] in rows
    assert ["spacing", "5, mean distance to the nearest point"] in rows
    for note in ("array scan left out", "4 normals were scaled to length 1", "1 exact duplicate of points merged"):
        assert ["note", note] in rows


def test_info_of_a_single_point(tmp_path, capsys):
    np.savez(tmp_path / "x.npz", points=[[1.0, 2, 3]])
    assert main(["info", str(tmp_path / "x.npz"), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["points"], record["spacing"], record["auto_h"], record["diagonal"]) == (1, 0, 0, 0)
