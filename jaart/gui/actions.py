"""Menus and toolbar: every action of the window, kept in step with the model."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from qtpy.QtCore import QSignalBlocker, Qt
from qtpy.QtGui import QAction, QActionGroup, QKeySequence, QStandardItemModel
from qtpy.QtWidgets import QComboBox, QLabel, QMenu, QSizePolicy, QSpinBox, QToolBar, QToolButton, QWidget

from jaart.core.maps import MAPS, lacks
from jaart.gui.navigation import VIEWS

if TYPE_CHECKING:
    from jaart.gui.main_window import MainWindow

SAMPLES = {"Splash": "splash", "Standard model": "standard", "Bumpy sphere (points)": "bumpy"}
SIZES = (256, 512, 768, 1024)
ABOUT = ("Jaart shows point-based surfaces of fill levels and of point clouds by ray tracing, without a mesh. "
         "Click a pixel to see, step by step, how its ray found the surface.")
KEYS = """<table cellspacing="6">
<tr><td>left drag</td><td>turn the scene</td></tr><tr><td>middle or Shift + drag</td><td>move it</td></tr>
<tr><td>wheel, + and -</td><td>nearer and farther</td></tr><tr><td>click</td><td>pick the ray of a pixel</td></tr>
<tr><td>arrow keys</td><td>move the picked pixel; with Shift by ten</td></tr>
<tr><td>F</td><td>see the whole scene</td></tr><tr><td>Esc</td><td>forget the picked ray</td></tr>
<tr><td>in the ray's panels</td><td>arrow keys, Home and End: its steps; wheel and drag: zoom and move</td></tr>
<tr><td>Ctrl + O, S, D, Q</td><td>open, save the picture, dark theme, quit</td></tr></table>"""


class Actions:
    """Builds the menus and the toolbar of a window and follows its model."""

    def __init__(self, window: MainWindow) -> None:
        self.window, self.model = window, window.model
        self.frame = QSpinBox(toolTip="Frame of the series", prefix="frame ", minimum=0)
        self.maps, self.sizes = QComboBox(), QComboBox()
        self.dark = self._action("Dark theme", self._toggle_theme, "Ctrl+D", checkable=True)
        self.map_actions = {name: self._map_action(name) for name in MAPS}
        self.views = self._view_menu()
        self._file_menu()
        self._show_menu()
        self._help_menu()
        self._toolbar()
        for signal in (self.model.map_changed, self.model.theme_changed, self.model.scene_changed,
                       self.model.settings_changed):
            signal.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the model's map, theme and frame, and which maps the scene allows."""
        scene = self.model.scene
        exact = scene is not None and scene.known
        self.map_actions[self.model.map].setChecked(True)
        items = self.maps.model()
        for row, name in enumerate(MAPS):
            allowed = not lacks(name, exact, self.model.settings)
            self.map_actions[name].setEnabled(allowed)
            assert isinstance(items, QStandardItemModel)
            items.item(row).setEnabled(allowed)
        with QSignalBlocker(self.maps), QSignalBlocker(self.dark), QSignalBlocker(self.frame):
            self.maps.setCurrentIndex(list(MAPS).index(self.model.map))
            self.dark.setChecked(self.model.theme == "dark")
            self.frame.setMaximum(scene.frames - 1 if scene is not None else 0)
            self.frame.setSuffix(f"  (0 to {scene.frames - 1})" if scene is not None else "")
            self.frame.setValue(scene.frame if scene is not None else 0)
        self.frame_action.setVisible(scene is not None and scene.frames > 1)
        if scene is not None and lacks(self.model.map, exact, self.model.settings):
            self.model.set_map("shaded")

    def _file_menu(self) -> None:
        menu = self.window.menuBar().addMenu("&File")
        self.open = self._action("&Open …", self.window.open, QKeySequence.StandardKey.Open)
        menu.addAction(self.open)
        samples = menu.addMenu("Open &sample")
        for label, name in SAMPLES.items():
            samples.addAction(self._action(label, partial(self.model.open, name)))
        menu.addAction(self._action("&Save picture …", self.window.ask_picture, QKeySequence.StandardKey.Save))
        menu.addSeparator()
        menu.addAction(self._action("&Quit", self.window.close, "Ctrl+Q"))

    def _view_menu(self) -> QMenu:
        views = QMenu("&Look from", self.window)
        for name in VIEWS:
            views.addAction(self._action(name, partial(self.window.view.look_from, name)))
        return views

    def _show_menu(self) -> None:
        menu = self.window.menuBar().addMenu("&View")
        maps = menu.addMenu("&Map")
        maps.addActions(list(self.map_actions.values()))
        menu.addMenu(self.views)
        menu.addAction(self._action("&Fit the scene", self.window.view.fit, "Ctrl+F"))
        menu.addAction(self.dark)
        panels = menu.addMenu("&Panels")
        for dock in self.window.docks.values():
            panels.addAction(dock.toggleViewAction())

    def _help_menu(self) -> None:
        menu = self.window.menuBar().addMenu("&Help")
        menu.addAction(self._action("&Mouse and keys", partial(self.window.tell, "Mouse and keys", KEYS), "F1"))
        menu.addAction(self._action("&About Jaart", partial(self.window.tell, "About Jaart", ABOUT)))

    def _toolbar(self) -> None:
        bar = QToolBar("Toolbar", movable=False)
        bar.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        self.window.addToolBar(bar)
        bar.addAction(self.open)
        look = QToolButton(text="Look from", popupMode=QToolButton.ToolButtonPopupMode.InstantPopup)
        look.setMenu(self.views)
        bar.addWidget(look)
        bar.addSeparator()
        self._fill_combos()
        for text, widget in (("Map", self.maps), ("Size", self.sizes)):
            bar.addWidget(QLabel(f" {text} "))
            bar.addWidget(widget)
        self.frame_action = bar.addWidget(self.frame)
        self.frame.valueChanged.connect(self._choose_frame)
        gap = QWidget()
        gap.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        bar.addWidget(gap)
        bar.addAction(self.dark)

    def _fill_combos(self) -> None:
        for about in MAPS.values():
            self.maps.addItem(about.label, about.name)
        self.maps.setToolTip("What the picture shows")
        self.maps.activated.connect(lambda row: self.model.set_map(list(MAPS)[row]))
        for size in SIZES:
            self.sizes.addItem(f"{size} × {size}", size)
        self.sizes.setToolTip("Rays of the picture")
        self.sizes.setCurrentIndex(SIZES.index(512))
        self.sizes.activated.connect(lambda row: self.model.set_size(SIZES[row], SIZES[row]))

    def _choose_frame(self, frame: int) -> None:
        if self.model.scene is not None:
            self.model.open(self.model.scene.source, frame)

    def _toggle_theme(self, dark: bool) -> None:
        self.model.set_theme("dark" if dark else "light")

    def _map_action(self, name: str) -> QAction:
        action = self._action(MAPS[name].label, lambda _=False: self.model.set_map(name), checkable=True)
        if not hasattr(self, "_maps"):
            self._maps = QActionGroup(self.window)
        self._maps.addAction(action)
        return action

    def _action(self, text: str, slot: object, key: object = None, checkable: bool = False) -> QAction:
        action = QAction(text, self.window, checkable=checkable)
        if checkable:
            action.triggered.connect(slot)
        else:
            action.triggered.connect(lambda _=False: slot())  # type: ignore[operator]
        if key is not None:
            action.setShortcut(QKeySequence(key))
        return action
