"""Wall seconds of the preparation and the rays, and of whole starts of the command line."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import jaart
from benchmarks.standard import SIZE, camera
from benchmarks.timing import REPEATS, Spread, timed


def spread(seconds: list[float]) -> str:
    """Median, least and greatest in milliseconds."""
    median = Spread(tuple(seconds)).median
    return f"median {1e3 * median:7.1f} ms   ({1e3 * min(seconds):.1f} … {1e3 * max(seconds):.1f})"


def rays(name: str, raster: int | None) -> None:
    """Preparation and rays of a scene, each run from a freshly loaded scene."""
    settings = jaart.preset("thesis") if raster is None else jaart.preset("thesis").replace(raster=raster)
    view = None if raster is None else camera(raster)
    runs = [jaart.render(jaart.load(name), settings, view, SIZE) for _ in range(REPEATS)]
    label = name if raster is None else f"{name} {raster}^3"
    print(f"{label:12} 512x512  prep_s  {spread([run.prep_s for run in runs])}")
    print(f"{label:12} 512x512  ray_s   {spread([run.ray_s for run in runs])}   {os.cpu_count()} threads")


def start(cache: str | None, folder: Path) -> float:
    """A whole start of `jaart render splash`, with the user's cache of kernels or another."""
    environment = {**os.environ, **({"JAART_CACHE": cache} if cache else {})}
    command = [sys.executable, "-m", "jaart", "render", "splash", "--output", str(folder / "splash.png")]
    return timed(lambda: subprocess.run(command, env=environment, check=True, capture_output=True))


def main() -> None:
    rays("standard", 64)
    rays("splash", None)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print(f"first start ever, compiling   {start(str(folder / 'cache'), folder):.1f} s")
        start(None, folder)
        print(f"a second start                {spread([start(None, folder) for _ in range(REPEATS)])}")
        imports = [timed(lambda: subprocess.run([sys.executable, "-c", "import jaart"], check=True))
                   - timed(lambda: subprocess.run([sys.executable, "-c", ""], check=True)) for _ in range(REPEATS)]
        print(f"import jaart                  {spread(imports)}")


if __name__ == "__main__":
    main()
