"""The window: docks around the picture, and the actions of its menus."""

from __future__ import annotations

from pathlib import Path

from qtpy.QtCore import QSize, Qt, Signal
from qtpy.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QResizeEvent, QShowEvent
from qtpy.QtWidgets import QApplication, QFileDialog, QMainWindow, QMessageBox, QTabWidget, QWidget

from jaart.core.errors import FileError
from jaart.gui import theme
from jaart.gui.actions import Actions
from jaart.gui.arrangement import Arrangement
from jaart.gui.docks import LATE, Area, Late, Loader, PanelDock
from jaart.gui.form import column
from jaart.gui.image_view import ImageView
from jaart.gui.messages import Log, MessageBar, NoteBar
from jaart.gui.model import SceneModel
from jaart.gui.parameters import Parameters
from jaart.gui.plan import PlanLine
from jaart.gui.status import Status

FILES = "Scenes (*.npz *.vti *.xml);;All files (*)"


class MainWindow(QMainWindow):
    """Parameters on the left, the picture in the middle, the picked ray on the right, statistics below."""

    closed = Signal()

    def __init__(self, model: SceneModel | None = None) -> None:
        super().__init__()
        self.model = model or SceneModel()
        self.model.setParent(self)
        self.view = ImageView(self.model)
        self.message, self.notes = MessageBar(self.model), NoteBar(self.model)
        self.docks: dict[str, PanelDock] = {}
        self.panels_ready = self._shown = False
        self.loader = Loader(self)
        self.resize(1600, 1000)
        self.setAcceptDrops(True)
        self.setDockOptions(self.dockOptions() | QMainWindow.DockOption.AllowNestedDocks)
        centre = QWidget()
        centre.setLayout(column(self.message, self.notes, self.view))
        centre.layout().setStretch(2, 1)
        self.setCentralWidget(centre)
        self.setStatusBar(Status(self.model))
        self.statusBar().addPermanentWidget(PlanLine(self.model, self))
        self._make_docks()
        self.actions_ = Actions(self)
        self._connect()
        self._show_theme()
        self._show_title()

    def open(self) -> None:
        """Ask for a file and open it."""
        name, _ = QFileDialog.getOpenFileName(self, "Open a scene", "", FILES)
        if name:
            self.model.open(name)

    def ask_picture(self) -> None:
        """Ask for a file and save the picture."""
        name, _ = QFileDialog.getSaveFileName(self, "Save the picture", "picture.png", "Pictures (*.png)")
        if name:
            self.save_picture(name if Path(name).suffix else f"{name}.png")

    def save_picture(self, path: str | Path) -> None:
        """Save the picture as it is shown; an error is told in the window."""
        from jaart.core.io.atomic import replacing

        try:
            with replacing(Path(path)) as temporary:
                if not self.view.image.save(str(temporary), "PNG"):
                    raise FileError(path, "the picture cannot be written")
        except FileError as error:
            self.model.failed.emit(str(error))
        except OSError as error:
            self.model.failed.emit(f"{path}: cannot be written: {error.strerror or error}")
        else:
            self.model.said.emit(f"Picture written to {path}")

    def tell(self, title: str, text: str) -> None:
        """Show a text beside the window, without holding it up."""
        box = QMessageBox(QMessageBox.Icon.NoIcon, title, text, QMessageBox.StandardButton.Close, self)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.setModal(False)
        box.show()

    def _make_docks(self) -> None:
        self.setCorner(Qt.Corner.BottomLeftCorner, Area.LeftDockWidgetArea)
        self.setCorner(Qt.Corner.BottomRightCorner, Area.RightDockWidgetArea)
        self.setTabPosition(Area.AllDockWidgetAreas, QTabWidget.TabPosition.North)
        self._dock("Parameters", QSize(300, 600)).set_panel(Parameters(self.model))
        for late in LATE:
            self._dock(late.title, QSize(440 if late.area == Area.RightDockWidgetArea else 600, late.height))
        self._dock("Messages", QSize(600, 240)).set_panel(Log(self.model))
        self.arrangement = Arrangement(self, self.docks)

    def _dock(self, title: str, size: QSize) -> PanelDock:
        dock = self.docks[title] = PanelDock(title, self, size)
        return dock

    def _connect(self) -> None:
        self.model.theme_changed.connect(self._show_theme)
        self.model.scene_changed.connect(self._show_title)
        self.model.hits_changed.connect(self._load_panels)
        self.model.settled.connect(self._load_panels)
        self.model.failed.connect(self.loader.start)
        self.loader.ready.connect(self._build)
        self.loader.failed.connect(self.model.failed)
        self.loader.finished.connect(self._built)

    def _load_panels(self) -> None:
        """Import the rest once the first picture stands or was stopped: before, it would only slow it down."""
        if self.model.complete or (self.model.halted and not self.model.computing):
            self.loader.start()

    def _build(self, late: Late) -> None:
        import importlib

        panel = getattr(importlib.import_module(f"jaart.gui.{late.module}"), late.name)(self.model)
        self.docks[late.title].set_panel(panel)

    def _built(self) -> None:
        self.panels_ready = True

    def _show_theme(self) -> None:
        theme.apply(QApplication.instance(), self.model.theme)

    def _show_title(self) -> None:
        scene = self.model.scene
        frame = f", frame {scene.frame} of {scene.frames}" if scene is not None and scene.frames > 1 else ""
        self.setWindowTitle("Jaart" if scene is None else f"{Path(scene.source).name}{frame} \N{EN DASH} Jaart")

    def showEvent(self, event: QShowEvent) -> None:
        """Give the docks their sizes when first shown."""
        super().showEvent(event)
        if not self._shown:
            self._shown = True
            self.arrangement.fit(anew=True)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Arrange the docks anew where there is much more or less room for them."""
        super().resizeEvent(event)
        if self._shown:
            self.arrangement.fit()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files."""
        if event.mimeData().hasUrls() and event.mimeData().urls()[0].isLocalFile():
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open the file that was dropped."""
        event.acceptProposedAction()
        self.model.open(event.mimeData().urls()[0].toLocalFile())

    def closeEvent(self, event: QCloseEvent) -> None:
        """End the threads, and give back what the panels hold."""
        self.loader.stop()
        self.model.close()
        for dock in self.docks.values():
            if dock.panel is not None:
                dock.panel.close()
        super().closeEvent(event)
        self.closed.emit()


