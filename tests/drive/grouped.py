"""`swapcan` in a process group of its own, or with a terminal of its own; its look-out is short."""

from __future__ import annotations

import os
import sys

from swapcan.__main__ import main
from typedcan.drive import driving

if __name__ == "__main__":
    driving.LOOK_OUT = 0.3
    if sys.argv[1] == "--terminal":
        import fcntl
        import termios

        del sys.argv[1]
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    else:
        os.setpgid(0, 0)
    sys.exit(main())
