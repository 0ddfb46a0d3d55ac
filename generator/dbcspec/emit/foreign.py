"""Files from a protocol that was read from somebody else's: a tidy DBC, and stubs."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator
from dataclasses import replace

from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.stubs import emit_stubs
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol
from typedcan.model.soundness import hidden, with_unique_names

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def foreign_artifacts(protocol: Protocol, out_name: str) -> dict[str, bytes]:
    """The DBC in the one shape that every reader takes, and a package of typed Python.

    ``out_name`` names both; they can lie anywhere. Text beyond ASCII is UTF-8. Of two messages with
    one identifier the DBC has the one that frames are taken for, the package both. Raises
    `ReadError` for a protocol that neither can say, see `dbc_faults`.
    """
    if not _NAME.fullmatch(out_name) or keyword.iskeyword(out_name):
        raise ReadError(f"{out_name}: is no name for a Python package")
    refuse_unwritable(protocol)
    protocol = with_unique_names(protocol)
    stubs = emit_stubs(protocol)
    return {
        f"{out_name}.dbc": emit_dbc(without_hidden(protocol)).encode("utf-8"),
        **{f"{out_name}/{name}": text.encode("utf-8") for name, text in stubs.items()},
    }


def without_hidden(protocol: Protocol) -> Protocol:
    """The protocol without messages whose identifier a later one has: no DBC has two of those."""
    not_written = hidden(protocol)
    written = tuple(each for each in protocol.messages if each.name not in not_written)
    return replace(protocol, messages=written) if not_written else protocol


def refuse_unwritable(protocol: Protocol) -> None:
    """Raise `ReadError` for a protocol that no DBC can say, see `dbc_faults`."""
    if faults := dbc_faults(protocol):
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        raise ReadError(f"{faults[0]}{more}")


def dbc_faults(protocol: Protocol) -> list[str]:
    """What of a protocol no DBC can or may say, one line each that names the message or node."""
    return [
        *_name_faults(protocol),
        *(
            f"{message.name}: {signal.name} starts with {signal.start_value}, which acts"
            for message, signal in protocol.signals()
            if signal.acting and signal.start_value in signal.acting.codes
        ),
    ]


def _name_faults(protocol: Protocol) -> Iterator[str]:
    names = [
        *(node.name for node in protocol.nodes),
        *(table.name for table in protocol.value_tables),
        *(message.name for message in protocol.messages),
        *(signal.name for _, signal in protocol.signals()),
    ]
    for name in dict.fromkeys(names):
        if not _NAME.fullmatch(name):
            yield f"{name!r} is no DBC name: letters, digits and underscores, no digit first"
