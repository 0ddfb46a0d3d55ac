"""`swapcan` in a process group of its own, or with a terminal of its own."""

from __future__ import annotations

import os
import sys

from swapcan.__main__ import main

if __name__ == "__main__":
    if sys.argv[1] == "--terminal":
        import fcntl
        import termios

        del sys.argv[1]
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    else:
        os.setpgid(0, 0)
    sys.exit(main())
