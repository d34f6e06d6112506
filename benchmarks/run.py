"""The figures of the project, printed: `make bench`. `python -m benchmarks.methods` takes a quarter of an hour more."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks import adamson_alexa, jumps, quality, speed, switching


def main() -> None:
    quality.main()
    print()
    jumps.main()
    print()
    adamson_alexa.main()
    print()
    switching.main()
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
