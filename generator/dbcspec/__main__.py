"""Entry point of the `dbcspec` command."""

from __future__ import annotations

import sys


def main() -> int:
    """Run the command line, or say which extra it needs."""
    try:
        from dbcspec.cli import run
    except ModuleNotFoundError as error:
        if error.name not in ("yaml", "jinja2"):
            raise
        print(
            f"dbcspec: {error.name} is not installed; pip install 'swapcan[generator]' brings it",
            file=sys.stderr,
        )
        return 2
    return run(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
