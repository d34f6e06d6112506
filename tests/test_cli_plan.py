"""jaart plan, as a person and as a program read it."""

from __future__ import annotations

import json

import pytest

import jaart
from jaart.__main__ import main
from jaart.core.settings import parse, preset
from jaart.core.suited import suited


def said(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["plan", *arguments]) == 0
    return capsys.readouterr().out


def test_the_record_is_the_plan(capsys: pytest.CaptureFixture[str]) -> None:
    scene = jaart.load("bumpy")
    record = json.loads(said(capsys, "bumpy", "--preset", "adamson-alexa", "--set", "neighbourhood=knn", "--json"))
    made = jaart.plan(scene, suited(scene, parse(["neighbourhood=knn"], preset("adamson-alexa")))[0])
    assert (record["source"], record["kind"]) == ("bumpy", "cloud")
    assert [(s["name"], s["runs"], s["reason"]) for s in record["stages"]] == [
        (s.name, s.runs, s.reason) for s in made.stages]
    assert [(v["name"], v["value"], v["from"]) for v in record["values"]] == [
        (v.name, v.value, v.origin) for v in made.values]
    settings = {s["name"]: s["settings"] for s in record["stages"]}
    assert settings["balls"] == {"ball_k": "6", "neighbourhood": "knn", "k": "12"}


def test_no_bound_is_null(capsys: pytest.CaptureFixture[str]) -> None:
    text = said(capsys, "standard", "--json")
    values = {v["name"]: v["value"] for v in json.loads(text)["values"]}
    assert values["max_nearest"] is None and values["h"] == 0.8
    assert "Infinity" not in text


def test_the_table_has_every_stage_where_it_belongs(capsys: pytest.CaptureFixture[str]) -> None:
    text = said(capsys, "standard", "--set", "method=fill_level", "filter=median")
    before, values = text.split("\nvalues\n")
    runs, left_out = before.split("\nleft out\n")
    assert runs.startswith("standard (model)\nruns\n")
    scene = jaart.load("standard")
    made = jaart.plan(scene, suited(scene, parse(["method=fill_level", "filter=median"], preset("best")),
                                    ["method", "filter"])[0])
    for part, stages in ((runs.splitlines()[2:], made.runs), (left_out.splitlines(), made.left_out)):
        assert [line[2:].split("  ")[0] for line in part] == [s.name for s in stages]
    assert "filter                      median (filter = median)" in runs
    assert values.split() == ["level", "0.5", "(as", "the", "method", "needs", "it)"]


def test_what_makes_no_sense_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "bumpy", "--set", "placement=box"]) == 1
    out, err = capsys.readouterr()
    assert out == "" and "placement has no meaning in a cloud" in err
    assert main(["plan", "standard", "--nonsense"]) == 2
