"""The options that the commands for whole logs share, their protocol, and the check for extras."""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path

from typedcan.shell.console import CommandError


def add_window_options(parser: argparse.ArgumentParser) -> None:
    """Add --from and --to."""
    parser.add_argument(
        "--from",
        dest="start",
        metavar="TIME",
        help="seconds since the log's begin, or a date like 2025-06-30T14:05:00 (recorder's time)",
    )
    parser.add_argument("--to", dest="end", metavar="TIME", help="the same")
    parser.add_argument(
        "--recorded-in",
        metavar="ZONE",
        help="time zone of the recorder, such as Asia/Shanghai or UTC (default: this computer's)",
    )


def size_of(log: Path) -> int:
    """Bytes of a log; raises `CommandError` where there is none."""
    try:
        return log.stat().st_size
    except OSError as error:
        raise CommandError(f"{log}: {error.strerror}") from None


def names(text: str) -> list[str]:
    """The names in a text, with commas between them; as the type of an argument."""
    return [name for name in text.split(",") if name]


def need(*packages: str) -> None:
    """Raise `CommandError` where a package of the extra ``logs`` is not installed."""
    for name in packages:
        if find_spec(name) is None:
            raise CommandError(f"this needs {name}: pip install 'swapcan[logs]'")
