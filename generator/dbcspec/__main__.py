"""Entry point of the `dbcspec` command."""

from __future__ import annotations

import sys

from dbcspec.cli import run
from typedcan.shell.printing import print_warnings


def main() -> int:
    """Run the command line with the arguments of this process; return its exit status."""
    print_warnings()
    try:
        return run(sys.argv[1:])
    except KeyboardInterrupt:  # before a command began, or a second one
        return 130


if __name__ == "__main__":
    sys.exit(main())
