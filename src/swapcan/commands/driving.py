"""Who would send codes that act, and what is said where they did."""

from __future__ import annotations

from collections.abc import Iterable

from swapcan._generated.protocol import PROTOCOL
from typedcan.wire.acting import acting_fields

LIVE = "TAKE IT FOR LIVE, switch it off by other means"
"""What is said where it is not known that all is off."""

HUNG = "the program stands still: what acts was ended; Ctrl-C, or else kill -9, ends the program"
"""What is said where a driver, a recorder or an output does not come back."""


def acting_nodes(names: Iterable[str]) -> tuple[str, ...]:
    """Those of some nodes that send codes that act."""
    return tuple(name for name in names if _acting_messages(name))


def who_acts(names: Iterable[str]) -> str:
    """Some nodes with their messages that act, for people."""
    return " and ".join(f"{name} ({', '.join(_acting_messages(name))})" for name in names)


def _acting_messages(node: str) -> tuple[str, ...]:
    return tuple(kind.NAME for kind in PROTOCOL.sent_by(node) if acting_fields(kind))
