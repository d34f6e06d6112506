"""What it costs to switch an option in a program that is warm: its kernels are loaded from disk.

Each option is switched in a process of its own; the kernels were compiled by the run before the one that counts.
"""

from __future__ import annotations

import subprocess
import sys
import time

import jaart
from jaart.core.warm import warm_up

#: Options by what is switched on, after a picture with the thesis's settings.
OPTIONS = {
    "nothing": {}, "weight": {"weight": "wendland"}, "normal": {"normal": "covariance"}, "neighbourhood":
    {"neighbourhood": "knn"}, "polynomial": {"method": "polynomial"}, "projection": {"method": "projection"},
    "cylinder": {"method": "cylinder"}, "off_centre": {"method": "off_centre", "search": "minimise"},
    "newton": {"search": "newton"},
    "march": {"search": "march"}, "safe": {"search": "safe"}, "centres": {"search": "centres"},
    "true normal": {"shading_normal": "gradient"}, "bounds": {"min_gap": 0.1, "max_nearest": 2.0, "max_angle": 0.9},
}


def main() -> None:
    print(f"{'option':15} {'load, s':>8}")
    for name in OPTIONS:
        seconds = [float(subprocess.run([sys.executable, "-m", "benchmarks.switching", name], check=True, text=True,
                                        capture_output=True).stdout) for _ in range(3)]
        print(f"{name:15} {sorted(seconds)[1]:8.3f}", flush=True)


def one(name: str) -> None:
    """Seconds that the kernels of an option take to load after those of the thesis's settings."""
    scene, settings = jaart.load("standard"), jaart.preset("thesis")
    warm_up(scene, settings)
    begin = time.perf_counter()
    warm_up(scene, settings.replace(**OPTIONS[name]))
    print(time.perf_counter() - begin)


if __name__ == "__main__":
    one(sys.argv[1]) if len(sys.argv) > 1 else main()
