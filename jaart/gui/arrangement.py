"""How the docks stand around the picture: side by side in a large window, as tabs in a small one."""

from __future__ import annotations

from qtpy.QtCore import QObject, Qt
from qtpy.QtWidgets import QMainWindow, QWidget

from jaart.gui.docks import LATE, Area, PanelDock

#: A window smaller than this in either direction has tabs [pixels].
ROOM = (1280, 800)
#: Widths of the docks on the left and on the right, in a large and in a small window [pixels].
WIDTHS = {False: (300, 470), True: (288, 345)}
#: What stands behind the first of each in a small window.
TABS = {"Parameters": ("Statistics", "Messages"), "3D ray analyzer": ("2D projector", "Energy along the ray")}
#: What some are called where there is little room for it.
SHORT = {"3D ray analyzer": "3D analyzer", "Energy along the ray": "Energy"}

#: A line of text more that the bar of steps takes where it is narrow [pixels].
LINE = 22


class Arrangement(QObject):
    """Follows the size of the window, until somebody moves a dock: then everything stays where it was put."""

    def __init__(self, window: QMainWindow, docks: dict[str, PanelDock]) -> None:
        super().__init__(window)
        self.window, self.docks = window, docks
        self.tabbed, self.moved, self._busy = False, False, True
        for dock in docks.values():
            dock.topLevelChanged.connect(self._note)
            dock.dockLocationChanged.connect(self._note)
        for title in ("Steps", "Statistics", "Messages"):
            docks[title].setTitleBarWidget(QWidget())
        self._side_by_side()
        docks["Steps"].setMaximumHeight(LATE[0].height)
        self._busy = False

    def fit(self, anew: bool = False) -> None:
        """Arrange the docks for the window's size; anew: even if they are arranged for it already."""
        tabbed = self.window.width() < ROOM[0] or self.window.height() < ROOM[1]
        if self.moved or (tabbed == self.tabbed and not anew):
            return
        self._busy = True
        if tabbed != self.tabbed:
            self.tabbed = tabbed
            (self._in_tabs if tabbed else self._side_by_side)()
            for title, short in SHORT.items():
                self.docks[title].setWindowTitle(short if tabbed else title)
        self._give_sizes()
        self._busy = False

    def _note(self) -> None:
        self.moved = self.moved or not self._busy

    def _side_by_side(self) -> None:
        self.window.addDockWidget(Area.LeftDockWidgetArea, self.docks["Parameters"])
        for late in LATE:
            self.window.addDockWidget(late.area, self.docks[late.title])
        self.window.addDockWidget(Area.BottomDockWidgetArea, self.docks["Messages"])
        self.window.tabifyDockWidget(self.docks["Statistics"], self.docks["Messages"])
        self.docks["Statistics"].raise_()

    def _in_tabs(self) -> None:
        for front, behind in TABS.items():
            for title in behind:
                self.window.addDockWidget(self.window.dockWidgetArea(self.docks[front]), self.docks[title])
                self.window.tabifyDockWidget(self.docks[front], self.docks[title])
            self.docks[front].raise_()

    def _give_sizes(self) -> None:
        self.docks["Steps"].setMaximumHeight(LATE[0].height + LINE * self.tabbed)
        side = [self.docks["Parameters"], self.docks["3D ray analyzer"]]
        self.window.resizeDocks(side, list(WIDTHS[self.tabbed]), Qt.Orientation.Horizontal)
        if not self.tabbed:
            columns = [self.docks[late.title] for late in LATE[1:4]]
            self.window.resizeDocks(columns, [late.height for late in LATE[1:4]], Qt.Orientation.Vertical)
            self.window.resizeDocks([self.docks["Statistics"]], [LATE[4].height], Qt.Orientation.Vertical)
