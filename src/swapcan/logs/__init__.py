"""Hours of bus traffic into columns: log files in, tables out. Needs the extra ``logs``.

Nothing is imported before it is used: the readers alone do without Arrow.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

# The names, with their types, stand in __init__.pyi too.
_HOMES = {
    "BatchError": "typedcan.logs.batch",
    "TransferTables": "typedcan.logs.transfers.tables",
    "Damage": "typedcan.logs.read",
    "DamagedLogError": "typedcan.logs.batch",
    "FRAME_SCHEMA": "typedcan.logs.batch",
    "Layout": "typedcan.logs.pipeline",
    "LogError": "typedcan.logs.read",
    "LogSource": "typedcan.logs.read",
    "Mode": "typedcan.logs.plan",
    "Options": "typedcan.logs.pipeline",
    "Progress": "typedcan.logs.progress",
    "Shape": "typedcan.logs.shapes",
    "Summary": "typedcan.logs.summary",
    "Target": "typedcan.logs.write.target",
    "Window": "typedcan.logs.part",
    "convert_logs": "swapcan.log_tables",
    "decode_batch": "swapcan.log_tables",
    "frame_batches": "typedcan.logs.batch",
    "open_log": "typedcan.logs.read",
    "raster_step": "typedcan.logs.raster",
    "schemas": "swapcan.log_tables",
    "tables": "swapcan.log_tables",
    "window_of": "typedcan.logs.part",
}


def __getattr__(name: str) -> Any:
    """A public name, from the module that has it."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names."""
    return sorted(_HOMES)
