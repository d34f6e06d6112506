"""The documents: what they link to is there, and what they say to type works."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import jaart
from jaart.core.camera import Camera
from jaart.core.suited import suited

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
    rays = Camera.fit(scene).rays((512, 512))
    for name, (x, y), outcome in (("thesis", (161, 245), "cap"), ("best", (181, 320), "converged")):
        settings, _ = suited(scene, jaart.preset(name))
        origin, direction = (parts[y * 512 + x] for parts in rays)
        assert jaart.trace(scene, settings, origin, direction).outcome[-1] == outcome
