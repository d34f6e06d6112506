"""The statistics panel's export."""

from __future__ import annotations

import csv
import xml.etree.ElementTree as ET

import pytest
from panel_calls import shown
from patience import PATIENCE

from jaart.core.errors import FileError
from jaart.gui.statistics import StatisticsPanel
from jaart.plot.style import THEMES


def test_statistics_are_written_as_svg_and_csv(qtbot, standard, tmp_path):
    panel = shown(qtbot, StatisticsPanel(standard), 800, 240)
    qtbot.waitUntil(lambda: not panel.picture.pixmap().isNull(), timeout=PATIENCE)
    assert panel.picture.pixmap().size() == panel.size() * panel.devicePixelRatioF()
    said = []
    standard.said.connect(said.append)
    panel.export(tmp_path / "numbers.csv")
    panel.export(tmp_path / "picture.svg")
    with (tmp_path / "numbers.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["statistic", "bin", "value"]
    assert ["hits", "", str(int(standard.hits.hit.sum()))] in rows
    assert any(row[0] == "delta" and float(row[2]) == standard.quality.delta for row in rows)
    assert ET.parse(tmp_path / "picture.svg").getroot().tag.endswith("svg")
    assert len(said) == 2


def test_an_export_that_cannot_be_done_says_why(qtbot, standard, tmp_path):
    panel = shown(qtbot, StatisticsPanel(standard), 800, 240)
    with pytest.raises(FileError, match=r"\.svg or \.csv"):
        panel.export(tmp_path / "numbers.txt")
    with pytest.raises(FileError, match="cannot be written"):
        panel.export(tmp_path / "absent" / "numbers.csv")
    assert list(tmp_path.iterdir()) == []


def test_without_a_picture_there_is_nothing_to_export(qtbot, model, tmp_path):
    panel = shown(qtbot, StatisticsPanel(model), 800, 240)
    assert not any(button.isEnabled() for button in panel.buttons)
    with pytest.raises(FileError, match="no picture"):
        panel.export(tmp_path / "numbers.csv")


@pytest.mark.parametrize("size", [(800, 240), (290, 590)])
def test_buttons_lie_over_no_plot(qtbot, standard, size):
    panel = shown(qtbot, StatisticsPanel(standard), *size)
    qtbot.waitUntil(lambda: not panel.picture.pixmap().isNull(), timeout=PATIENCE)
    image = panel.picture.pixmap().toImage()
    for button in panel.buttons:
        box = button.geometry()
        colours = {image.pixelColor(x, y).name() for x in range(box.left(), box.right() + 1)
                   for y in range(box.top(), box.bottom() + 1)}
        assert colours == {THEMES["light"].face}
