"""Messages as the other side has them: encoded, sent as bytes, decoded."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from swapcan import decode, encode
from swapcan.messages import B2V_BattInfo2
from swapcan.transfer import Reading
from typedcan.wire.message import Message

ALPHABET = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"
"""Table 8 row 4 and table 15 row 2."""


def delivered(messages: Iterable[Message]) -> list[Message]:
    """The messages after a trip through their frames."""
    return [decode(type(message).FRAME_ID, encode(message)) for message in messages]


def payloads(messages: Iterable[Message]) -> list[str]:
    """The bytes of each frame in hexadecimal."""
    return [encode(message).hex() for message in messages]


def totals(
    cells: Mapping[int, Sequence[Reading]], probes: Mapping[int, Sequence[Reading]]
) -> B2V_BattInfo2:
    """What a pack with these cells and probes says of itself."""
    return B2V_BattInfo2(
        tot_csc_num=len(cells),
        tot_cell_num=sum(map(len, cells.values())),
        tot_temp_num=sum(map(len, probes.values())),
    )
