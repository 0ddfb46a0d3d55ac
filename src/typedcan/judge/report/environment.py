"""What judged: the versions that decide what a report says."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

_PACKAGES = ("numpy", "cantools", "python-can")


def environment() -> dict[str, str]:
    """Versions by name; nothing of the host, the user or the day."""
    return {
        "swapcan": _version("swapcan"),
        "Python": platform.python_version(),
        **{name: _version(name) for name in _PACKAGES},
        "System": f"{platform.system()} {platform.machine()}".strip(),
    }


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "(not installed)"
