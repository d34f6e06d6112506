"""The documents: what they link to is there, and what they say to type works."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import jaart

ROOT = Path(__file__).resolve().parent.parent
PAGES = ["README.md", "CHANGELOG.md", "resources/README.md", *(f"docs/{p.name}" for p in (ROOT / "docs").glob("*.md"))]


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page: str) -> None:
    folder = (ROOT / page).parent
    links = re.findall(r"\]\(([^)#:]+)\)", (ROOT / page).read_text(encoding="utf-8"))
    assert [link for link in links if not (folder / link).exists()] == []


def test_the_lines_of_python_in_the_readme_run(capsys: pytest.CaptureFixture[str]) -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    block = re.search(r"and in Python:\n\n((?:    .*\n)+)", text)
    assert block is not None
    exec(re.sub(r"^    ", "", block[1], flags=re.M), {})
    assert capsys.readouterr().out.startswith("converged")


def test_the_model_in_the_readme_is_the_standard_one(tmp_path: Path) -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    block = re.search(r"<SceneGraph.*</SceneGraph>", text, flags=re.S)
    assert block is not None
    (tmp_path / "model.xml").write_text(block[0], encoding="utf-8")
    assert jaart.load(tmp_path / "model.xml").model == jaart.load("standard").model


def test_the_rays_of_the_tour_end_as_it_says() -> None:
    scene = jaart.load("splash")
    hits = jaart.render(scene)
    names = [jaart.trace(scene, hits.settings, hits.origin[y * 512 + x], hits.direction[y * 512 + x]).outcome[-1]
             for x, y in ((161, 245), (181, 320))]
    assert names == ["cap", "converged"]
