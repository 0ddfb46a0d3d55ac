"""Entry point of the `dbcspec` command."""

from __future__ import annotations

import sys

from dbcspec.cli import run
from typedcan.shell.printing import print_remark, print_warnings


def main() -> int:
    """Run the command line, or say which extra it needs."""
    print_warnings()
    try:
        return run(sys.argv[1:])
    except ModuleNotFoundError as error:
        if error.name not in ("yaml", "jinja2", "openpyxl"):
            raise
        print_remark(
            f"dbcspec: {error.name} is not installed; pip install 'swapcan[generator]' brings it"
        )
        return 2


if __name__ == "__main__":
    sys.exit(main())
