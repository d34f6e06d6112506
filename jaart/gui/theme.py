"""The look of the window: explicit Fusion palettes and one style sheet, light and dark."""

from __future__ import annotations

from qtpy.QtGui import QColor, QFont, QPalette
from qtpy.QtWidgets import QApplication

Role = QPalette.ColorRole

#: Colours by theme; "view" is the ground of the picture, "edge" separates, "alarm" is for errors.
COLOURS = {
    "light": {"window": "#f3f4f6", "base": "#ffffff", "text": "#1c2128", "weak": "#667080", "button": "#fbfcfd",
              "accent": "#0072b2", "on_accent": "#ffffff", "edge": "#d3d8df", "alarm": "#b3261e",
              "alarm_ground": "#fde7e4", "tip": "#ffffff", "view": "#edf0f5", "hover": "#e4ebf2"},
    "dark": {"window": "#23262b", "base": "#1e2126", "text": "#e6e9ed", "weak": "#9aa4b1", "button": "#2d3137",
             "accent": "#3d9bd6", "on_accent": "#0b0d0f", "edge": "#3a4048", "alarm": "#ffb4a9",
             "alarm_ground": "#4a1f1b", "tip": "#2d3137", "view": "#1f2126", "hover": "#343a42"},
}


def colour(theme: str, name: str) -> QColor:
    """A colour of COLOURS."""
    return QColor(COLOURS[theme][name])


def apply(app: QApplication, theme: str) -> None:
    """Give the whole program a theme."""
    if app.style().objectName() != "fusion":
        app.setStyle("Fusion")
    app.setPalette(_palette(COLOURS[theme]))
    app.setStyleSheet(_sheet(COLOURS[theme]))


def tabular(font: QFont) -> QFont:
    """The font with digits of one width, so that numbers do not jitter."""
    font = QFont(font)
    font.setFeature(QFont.Tag("tnum"), 1)
    return font


def _palette(c: dict[str, str]) -> QPalette:
    palette = QPalette()
    for role, name in ((Role.Window, "window"), (Role.WindowText, "text"), (Role.Base, "base"),
                       (Role.AlternateBase, "window"), (Role.Text, "text"), (Role.Button, "button"),
                       (Role.ButtonText, "text"), (Role.Highlight, "accent"), (Role.HighlightedText, "on_accent"),
                       (Role.ToolTipBase, "tip"), (Role.ToolTipText, "text"), (Role.PlaceholderText, "weak"),
                       (Role.Link, "accent"), (Role.BrightText, "alarm"), (Role.Accent, "accent")):
        palette.setColor(role, QColor(c[name]))
    for role in (Role.WindowText, Role.Text, Role.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, role, QColor(c["weak"]))
    shades = {Role.Light: 130, Role.Midlight: 115, Role.Mid: 85, Role.Dark: 70, Role.Shadow: 50}
    for role, percent in shades.items():
        palette.setColor(role, QColor(c["edge"]).lighter(percent))
    return palette


def _sheet(c: dict[str, str]) -> str:
    return f"""
    QToolTip {{ color: {c['text']}; background: {c['tip']}; border: 1px solid {c['edge']}; padding: 4px; }}
    QMainWindow::separator {{ background: {c['window']}; width: 5px; height: 5px; }}
    QMainWindow::separator:hover {{ background: {c['accent']}; }}
    QToolBar {{ background: {c['window']}; border: none; border-bottom: 1px solid {c['edge']}; spacing: 6px;
                padding: 4px 8px; }}
    QMenuBar {{ background: {c['window']}; }}
    QStatusBar {{ background: {c['window']}; border-top: 1px solid {c['edge']}; }}
    QStatusBar::item {{ border: none; }}
    QDockWidget {{ font-weight: 600; }}
    QDockWidget::title {{ background: {c['window']}; padding: 5px 8px; border-bottom: 1px solid {c['edge']}; }}
    QScrollArea {{ border: none; }}
    #weak {{ color: {c['weak']}; }}
    #fault {{ color: {c['alarm']}; }}
    #section {{ border: none; font-weight: 600; text-align: left; padding: 5px 4px; background: transparent; }}
    #section:hover {{ background: {c['hover']}; }}
    #reset {{ border: none; background: transparent; color: {c['accent']}; }}
    #messages {{ background: {c['alarm_ground']}; border-bottom: 1px solid {c['alarm']}; }}
    #messages QLabel {{ color: {c['alarm']}; font-weight: 600; }}
    #messages QToolButton {{ color: {c['alarm']}; border: none; background: transparent; }}
    #notes {{ background: {c['window']}; border-bottom: 1px solid {c['edge']}; }}
    #notes QLabel {{ color: {c['weak']}; }}
    #notes QToolButton {{ color: {c['weak']}; border: none; background: transparent; }}
    QLineEdit[fault="true"] {{ color: {c['alarm']}; }}
    """
