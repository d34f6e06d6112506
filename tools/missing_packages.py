"""Print the Debian packages of the system libraries that the window or the peers need and this machine lacks."""

import sys
from pathlib import Path

# The checkout itself, whether it is installed or not.
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from jaart.gui.libraries import NEEDED, NEEDED_X11, missing

PEERS = {"libusb-1.0.so.0": "libusb-1.0-0", "libGL.so.1": "libgl1", "libX11.so.6": "libx11-6",
         "libgomp.so.1": "libgomp1"}
WINDOW = {**NEEDED, **NEEDED_X11, "libgomp.so.1": "libgomp1"}

print(*missing(PEERS if sys.argv[1:] == ["peers"] else WINDOW))
