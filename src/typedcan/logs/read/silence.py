"""Keeps what a library logs about a file to ourselves."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def silenced(logger: str) -> Iterator[list[str]]:
    """While this lasts a logger is silent; what it would have warned of is in the list."""
    warnings: list[str] = []

    def keep(record: logging.LogRecord) -> bool:
        if record.levelno >= logging.WARNING:
            warnings.append(record.getMessage())
        return False

    silent = logging.getLogger(logger)
    silent.addFilter(keep)
    try:
        yield warnings
    finally:
        silent.removeFilter(keep)
