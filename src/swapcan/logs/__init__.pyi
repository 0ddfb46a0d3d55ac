from swapcan.log_tables import convert_logs, decode_batch, schemas, tables
from swapcan.logs.batch import (
    FRAME_SCHEMA,
    BatchError,
    DamagedLogError,
    frame_batches,
)
from swapcan.logs.cells.arrow import CellTables
from swapcan.logs.pipeline import Layout, Options
from swapcan.logs.plan import Mode
from swapcan.logs.progress import Progress
from swapcan.logs.raster import raster_step
from swapcan.logs.read import Damage, LogError, LogSource, open_log
from swapcan.logs.shapes import Shape
from swapcan.logs.summary import Summary
from swapcan.logs.window import moment
from swapcan.logs.write.target import Target

__all__ = [
    "FRAME_SCHEMA",
    "BatchError",
    "CellTables",
    "Damage",
    "DamagedLogError",
    "Layout",
    "LogError",
    "LogSource",
    "Mode",
    "Options",
    "Progress",
    "Shape",
    "Summary",
    "Target",
    "convert_logs",
    "decode_batch",
    "frame_batches",
    "moment",
    "open_log",
    "raster_step",
    "schemas",
    "tables",
]
