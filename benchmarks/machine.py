"""What machine the figures are from, in a line."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from benchmarks.timing import THREADS

#: What the figures depend on, as pip calls it; Open3D has two names.
PACKAGES = ("numba", "numpy", "scikit-image", "open3d", "open3d-cpu", "pymeshlab")


def words() -> str:
    """Processor, threads, how busy the machine is already, and versions."""
    found = [f"{name} {_version(name)}" for name in PACKAGES if _version(name)]
    busy = f", {os.getloadavg()[0]:.1f} tasks running before" if hasattr(os, "getloadavg") else ""
    return f"{_processor()}, {THREADS} threads{busy}; Python {platform.python_version()}, {', '.join(found)}"


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")),
                platform.machine())


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""
