"""All figures of the project, printed: `make bench`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks import jumps, quality, speed


def main() -> None:
    quality.main()
    print()
    jumps.main()
    print()
    speed.main()
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        print()
        from benchmarks import window

        window.main()
    else:
        print("\nthe window is measured where there is a display (xvfb-run -a make bench)")


if __name__ == "__main__":
    main()
