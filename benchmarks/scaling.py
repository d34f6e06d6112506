"""What a second thread gives: pictures with one thread and with two in turns, beside what the machine itself gives."""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import jaart
from benchmarks.standard import SIZE, camera
from benchmarks.timing import REPEATS, Spread, in_turns, ratios, timed
from jaart.core.suited import suited

#: Threads compared.
ONE, TWO = 1, 2
#: Work without Jaart: hashes, which share neither memory nor locks.
PIECES, PIECE = 16, bytes(1 << 22)


def main(folder: Path | None = None, repeats: int = REPEATS, small: bool = False) -> dict[str, Spread]:
    """Print how much sooner two threads are done, and save it into a folder if one is given."""
    size = (64, 64) if small else SIZE
    works = {"hashes, no Jaart": hashes, **pictures(size, small)}
    print(f"seconds of one thread over those of two, {size[0]}x{size[1]}, in turns; a second core can give 2, and this "
          f"machine gave the first line")
    found = {name: speed_up(work, repeats) for name, work in works.items()}
    for name, spread in found.items():
        print(f"  {name:24} {spread}")
    if folder is not None:
        write(found, folder / "threads.csv")
    return found


def pictures(size: tuple[int, int], small: bool) -> dict[str, Callable[[int], float]]:
    """Rays of scenes that are prepared, by threads."""
    raster = 16 if small else 64
    chosen = [("standard", name, raster, camera(raster)) for name in ("thesis", "best")]
    chosen += [("splash", "best", None, None)] + ([] if small else [("bumpy", "best", None, None)])
    return {f"{scene}, {name}": rays(scene, name, raster, view, size) for scene, name, raster, view in chosen}


def rays(name: str, preset: str, raster: int | None, view: jaart.Camera | None,
         size: tuple[int, int]) -> Callable[[int], float]:
    """The seconds of a picture's rays, with everything kept that can be."""
    scene = jaart.load(name)
    settings = suited(scene, jaart.preset(preset))[0]
    settings = settings if raster is None else settings.replace(raster=raster)
    jaart.render(scene, settings, view, size)
    return lambda threads: jaart.render(scene, settings, view, size, threads=threads).ray_s


def hashes(threads: int) -> float:
    """Seconds for the hashes of some pieces."""
    with ThreadPoolExecutor(threads) as pool:
        return timed(lambda: list(pool.map(lambda _: hashlib.sha256(PIECE).digest(), range(PIECES))))


def speed_up(work: Callable[[int], float], repeats: int) -> Spread:
    """Seconds of one thread over those of two in the same round."""
    given = in_turns({"one": lambda: work(ONE), "two": lambda: work(TWO)}, repeats, float("inf"))
    found = ratios(given["one"], given["two"])
    assert found is not None
    return found


def write(found: dict[str, Spread], path: Path) -> None:
    """The ratios as CSV."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["work", "one_over_two", "least", "quartiles", "runs"])
        writer.writerows([name, s.median, s.least, s.quartiles, len(s)] for name, s in found.items())


if __name__ == "__main__":
    main()
