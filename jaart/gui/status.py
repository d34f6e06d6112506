"""The status bar: how far the picture is, and its numbers."""

from __future__ import annotations

from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QLabel, QProgressBar, QStatusBar, QWidget

from jaart.gui.model import SceneModel
from jaart.gui.stop import StopButton
from jaart.gui.theme import tabular


class Status(QStatusBar):
    """Progress on the left, rays hit, evaluations a ray, time and δ on the right."""

    def __init__(self, model: SceneModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model = model
        self.setSizeGripEnabled(False)
        self.bar = QProgressBar(maximum=100, textVisible=False)
        self.bar.setFixedSize(120, 8)
        self.state = QLabel(minimumWidth=1)
        self.figures = QLabel(objectName="figures", minimumWidth=1)
        self.figures.setFont(tabular(self.figures.font()))
        self.setContentsMargins(8, 0, 8, 0)
        self.addWidget(self.bar)
        self.addWidget(StopButton(model))
        self.addWidget(self.state, 1)
        self.addPermanentWidget(self.figures)
        self._late = QTimer(self, singleShot=True, interval=200)
        self._late.timeout.connect(self._take_long)
        self._stage = "", 0.0
        model.staged.connect(self._staged)
        model.progressed.connect(self._progress)
        model.measurer.progressed.connect(lambda share: self._progress(share, "Measuring errors"))
        model.said.connect(self.state.setText)
        model.hits_changed.connect(self.refresh)
        model.settled.connect(self._settled)
        model.begun.connect(self._late.start)
        self._settled()

    def refresh(self) -> None:
        """Show the numbers of a full picture."""
        if self.model.complete:
            self.figures.setText("      ".join(figures(self.model)))
        elif self.model.hits is None or self.model.halted:
            self.figures.setText("")

    def _progress(self, share: float, what: str = "Tracing rays") -> None:
        if not self.model.computing or self._late.isActive():
            return
        self.bar.setVisible(share < 1)
        self._show_share(share)
        if share:
            self.state.setText(f"{what} … {100 * share:.0f} %")

    def _show_share(self, share: float, known: bool = True) -> None:
        """Move the bar to a share of the work, or to and fro where nobody knows it."""
        self.bar.setMaximum(100 if known else 0)
        self.bar.setValue(round(100 * share))

    def _staged(self, what: str, share: float) -> None:
        """Note what is made before rays are traced; tell it once it takes long."""
        self._stage = what, share
        if what and self.model.computing and not self._late.isActive():
            self.bar.show()
            self._show_share(share, known=share > 0)
            self.state.setText(f"{what[0].upper()}{what[1:]} …" + (f" {100 * share:.0f} %" if share else ""))

    def _take_long(self) -> None:
        if self._stage[0]:
            self._staged(*self._stage)
        else:
            self._progress(0.0)

    def _settled(self) -> None:
        self._late.stop()
        self._stage = "", 0.0
        self.bar.hide()
        self.state.setText(at_rest(self.model))
        self.refresh()


def at_rest(model: SceneModel) -> str:
    """What is shown while nothing is computed."""
    if model.halted:
        shown = "" if model.hits is None else ": this is the picture before" if model.complete else ": a coarse picture"
        return f"Stopped{shown}. Changing a value begins again."
    return "Picture of {} × {} rays".format(*model.size) if model.complete else ""


def figures(model: SceneModel) -> list[str]:
    """The numbers of the model's picture, one text each."""
    hits, quality = model.hits, model.quality
    if hits is None:
        return []
    texts = [f"{100 * hits.hit.mean():.1f} % of rays hit", f"{hits.evaluations.mean():.2f} evaluations/ray",
             f"{1000 * hits.ray_s:.0f} ms"]
    if quality is not None and not quality.relevant:
        texts.append("δ: no relevant rays")
    elif quality is not None:
        texts.append(f"δ {_short(quality.delta)}   δp {_short(quality.delta_p)}   δn {_short(quality.delta_n)}")
    return texts


def _short(error: float) -> str:
    """An error to four places, or to three digits where it is small."""
    return f"{error:.4f}" if not 0 < error < 0.01 else f"{error:.3g}"
