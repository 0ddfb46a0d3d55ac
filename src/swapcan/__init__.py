"""swapcan: the CAN protocol of battery-swap heavy trucks, typed, on any python-can bus."""

from __future__ import annotations

import ast
import pkgutil
from importlib import import_module
from typing import Any

# The names and the modules that have them stand in __init__.pyi alone, for type checkers and here.
# Each is imported when it is used: a program that decodes a frame starts without live nodes.
_HOMES = {
    name.name: node.module
    for node in ast.parse(pkgutil.get_data(__name__, "__init__.pyi") or b"").body
    if isinstance(node, ast.ImportFrom) and node.module
    for name in node.names
}

__all__ = [*_HOMES]  # noqa: PLE0604 - texts, all of them


def __getattr__(name: str) -> Any:
    """A public name, from the module that has it."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})
