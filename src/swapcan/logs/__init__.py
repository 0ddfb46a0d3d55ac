"""Hours of bus traffic into columns: log files in, tables out. Needs the extra ``logs``.

Nothing is imported before it is used: the readers alone do without Arrow.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

# The names, with their types, stand in __init__.pyi too.
_HOMES = {
    "BatchError": ".batch",
    "CellTables": ".cells.arrow",
    "Damage": ".read",
    "DamagedLogError": ".batch",
    "FRAME_SCHEMA": ".batch",
    "Layout": ".pipeline",
    "LogError": ".read",
    "LogSource": ".read",
    "Mode": ".plan",
    "Options": ".pipeline",
    "Progress": ".progress",
    "Shape": ".shapes",
    "Summary": ".summary",
    "Target": ".write.target",
    "convert_logs": "swapcan.log_tables",
    "decode_batch": "swapcan.log_tables",
    "frame_batches": ".batch",
    "moment": ".window",
    "open_log": ".read",
    "raster_step": ".raster",
    "schemas": "swapcan.log_tables",
    "tables": "swapcan.log_tables",
}


def __getattr__(name: str) -> Any:
    """A public name, from the module that has it."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names."""
    return sorted(_HOMES)
