"""Consent to what moves contactors: what a command would send, and whether it may."""

from __future__ import annotations

import argparse
from collections.abc import Iterable

from swapcan._generated.protocol import PROTOCOL
from typedcan.wire.acting import acting_fields
from typedcan.wire.message import Field, Message


def add_consent(group: argparse._ActionsContainer, what: str) -> None:
    """Add the option without which nothing that acts is sent on a real interface."""
    group.add_argument(
        "--yes-drive-the-bus",
        action="store_true",
        help=f"really send {what}; contactors may close, and chargers start",
    )


def acting_messages(node: str) -> tuple[type[Message], ...]:
    """The messages of a node that have codes that act."""
    return tuple(kind for kind in PROTOCOL.sent_by(node) if acting_fields(kind))


def acting_nodes(names: Iterable[str]) -> tuple[str, ...]:
    """Those of some nodes that send codes that act."""
    return tuple(name for name in names if acting_messages(name))


def what_they_send(names: Iterable[str]) -> str:
    """The codes that act of some nodes, in a line for people."""
    return ", ".join(
        f"{kind.NAME} {field.dbc_name} = {_labels(field)}"
        for name in names
        for kind in acting_messages(name)
        for field in acting_fields(kind)
    )


def _labels(field: Field) -> str:
    codes = sorted(field.acting.codes) if field.acting else []
    return " or ".join(field.labels.get(code, str(code)) for code in codes)
