"""Values that take several frames, for live nodes: texts, readings by group, numbered blocks.

Split for sending, put together on receipt, for any protocol: what kind a transfer is, its spec
says. Nothing here knows a bus or a clock: messages and times, in seconds that never go back, are
handed in. `typedcan.model.transfers` has the rules, and says what a result is worth under loss,
repetition and reordering.
"""

from typedcan.model.transfers.blocks import Blocks
from typedcan.model.transfers.kind import Problem
from typedcan.model.transfers.kind import ProblemKind as Kind
from typedcan.model.transfers.reading_rules import Reading, Readings
from typedcan.model.transfers.text import Text
from typedcan.transfer.assembly import Assembler, Transfers, Value
from typedcan.transfer.split import TransferError, characters, create, split, text_slots

__all__ = [
    "Assembler",
    "Blocks",
    "Kind",
    "Problem",
    "Reading",
    "Readings",
    "Text",
    "TransferError",
    "Transfers",
    "Value",
    "characters",
    "create",
    "split",
    "text_slots",
]
