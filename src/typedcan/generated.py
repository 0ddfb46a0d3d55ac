"""What generated messages and codecs import: `dbcspec generate` writes them on these names."""

from __future__ import annotations

from typedcan.model.code_types import Code1, Code2, Code3, Code4, Code5, Code6, Code7, Code8
from typedcan.model.frozen import draft_of
from typedcan.model.protection import Checksum, Counter
from typedcan.model.signal_state import SignalState
from typedcan.wire.fields import Field
from typedcan.wire.message import Message, Selected, StraightLine, code_table, raw_of

__all__ = [
    "Checksum",
    "Code1",
    "Code2",
    "Code3",
    "Code4",
    "Code5",
    "Code6",
    "Code7",
    "Code8",
    "Counter",
    "Field",
    "Message",
    "Selected",
    "SignalState",
    "StraightLine",
    "code_table",
    "draft_of",
    "raw_of",
]
