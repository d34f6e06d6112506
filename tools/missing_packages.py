"""Print the Debian packages of the system libraries that the window needs and this machine lacks."""

import sys
from pathlib import Path

# The checkout itself, whether it is installed or not.
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from jaart.gui.libraries import NEEDED, NEEDED_X11, missing

print(*missing({**NEEDED, **NEEDED_X11, "libgomp.so.1": "libgomp1"}))
