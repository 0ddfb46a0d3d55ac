"""Paths of findings as reports for other tools need them."""

from __future__ import annotations

import re
from urllib.parse import quote

_DRIVE = re.compile(r"[A-Za-z]:/")


def slashed(path: str) -> str:
    """The path with forward slashes, without a leading ``./``."""
    return path.replace("\\", "/").removeprefix("./")


def is_absolute(path: str) -> bool:
    """Whether a path with forward slashes starts at the root of a disk."""
    return path.startswith("/") or bool(_DRIVE.match(path))


def uri(path: str) -> str:
    """The path as a URI reference: relative where the path is, else of the scheme ``file``."""
    plain = slashed(path)
    if not is_absolute(plain):
        # A colon in the first part of a relative reference would be read as a scheme.
        return quote(plain, errors="backslashreplace")
    return "file://" + quote(
        f"/{plain}" if _DRIVE.match(plain) else plain, errors="backslashreplace"
    )
