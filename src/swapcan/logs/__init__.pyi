from swapcan.log_tables import convert_logs, decode_batch, schemas, tables
from typedcan.logs.batch import FRAME_SCHEMA, BatchError, DamagedLogError, frame_batches
from typedcan.logs.part import Window, window_of
from typedcan.logs.pipeline import Layout, Options
from typedcan.logs.plan import Mode
from typedcan.logs.progress import Progress
from typedcan.logs.raster import raster_step
from typedcan.logs.read import Damage, LogError, LogSource, open_log
from typedcan.logs.shapes import Shape
from typedcan.logs.summary import Summary
from typedcan.logs.transfers.tables import TransferTables
from typedcan.logs.write.target import Target

__all__ = [
    "FRAME_SCHEMA",
    "BatchError",
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
    "TransferTables",
    "Window",
    "convert_logs",
    "decode_batch",
    "frame_batches",
    "open_log",
    "raster_step",
    "schemas",
    "tables",
    "window_of",
]
