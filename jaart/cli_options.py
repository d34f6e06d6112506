"""The options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from jaart.core.settings import PARAMETERS, PRESETS

#: Pixels of a picture when nobody says.
DEFAULT_SIZE = "512x512"
#: The preset when nobody says.
DEFAULT_PRESET = "best"
_GROUPS = ", ".join(dict.fromkeys(about.group.lower() for about in PARAMETERS.values()))

SceneName = Annotated[str, typer.Argument(metavar="SCENE", help=(
    "A file, or a built-in scene: splash, standard, bumpy."))]
SizeText = Annotated[str, typer.Option("--size", metavar="WxH", help="Pixels of the picture.")]
CameraTexts = Annotated[list[str] | None, typer.Option("--camera", metavar="K=V ...", help=(
    "eye=x,y,z target=x,y,z up=x,y,z fov=degrees (across the longer side) or ortho=width; "
    "in cells or cloud units; by default the whole scene in view."))]
PresetName = Annotated[str, typer.Option("--preset", metavar="NAME", help=(
    f"Settings to start from: {', '.join(PRESETS)}."))]
SetTexts = Annotated[list[str] | None, typer.Option("--set", metavar="K=V ...", help=(
    f"Single settings on top, such as h=1.0: {_GROUPS}. 'jaart settings' lists them all with their meaning."))]
Frame = Annotated[int | None, typer.Option("--frame", min=0, metavar="N", help="Which of a series, from 0.")]
OutputFile = Annotated[Path | None, typer.Option("--output", "-o", metavar="FILE", help="The picture, .png.")]
Threads = Annotated[int | None, typer.Option(min=1, metavar="N", help="By default one a core.")]
