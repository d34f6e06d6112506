"""Start Jaart: `jaart`, or `python -m jaart`."""

from __future__ import annotations

import os
import sys


def main(arguments: list[str] | None = None) -> int:
    """Run the command line.

    arguments: without the program's name, those of the process when None. Returns the exit status:
    0 done, 1 could not be done, 2 wrong usage, 130 interrupted.
    """
    try:
        from jaart.cli import run
        from jaart.cli_interrupt import leave

        status = run(sys.argv[1:] if arguments is None else arguments)
        if status == 130:
            leave(status)
        return status
    except KeyboardInterrupt:  # while the program itself was loaded
        print("jaart: interrupted", file=sys.stderr)
        os._exit(130)


if __name__ == "__main__":
    sys.exit(main())
