"""Files from a protocol that was read from somebody else's: a tidy DBC, and stubs."""

from __future__ import annotations

import keyword
import re
from collections import Counter
from collections.abc import Iterable, Iterator

from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.stubs import emit_stubs
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Message, Protocol, Signal

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def foreign_artifacts(protocol: Protocol, out_name: str) -> dict[str, bytes]:
    """The DBC in the one shape that every reader takes, and a package of typed Python.

    ``out_name`` names both; they can lie anywhere. Text beyond ASCII is UTF-8. Raises `ReadError`
    for a protocol that neither can say, see `dbc_faults`.
    """
    if not _NAME.fullmatch(out_name) or keyword.iskeyword(out_name):
        raise ReadError(f"{out_name}: is no name for a Python package")
    if faults := dbc_faults(protocol):
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        raise ReadError(f"{faults[0]}{more}")
    stubs = emit_stubs(protocol)
    return {
        f"{out_name}.dbc": emit_dbc(protocol).encode("utf-8"),
        **{f"{out_name}/{name}": text.encode("utf-8") for name, text in stubs.items()},
    }


def dbc_faults(protocol: Protocol) -> list[str]:
    """What of a protocol no DBC can or may say, one line each that names the message or node."""
    return [
        *_name_faults(protocol),
        *_twice("message", (message.name for message in protocol.messages)),
        *_twice(
            "identifier",
            (
                f"0x{message.frame_id:X} ({29 if message.extended else 11} bits)"
                for message in protocol.messages
            ),
        ),
        *(fault for message in protocol.messages for fault in _message_faults(message)),
        *_text_faults(protocol),
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


def _twice(what: str, names: Iterable[str]) -> Iterator[str]:
    for name, count in Counter(names).items():
        if count > 1:
            yield f"{what} {name} is there {count} times"


def _message_faults(message: Message) -> Iterator[str]:
    yield from _twice(f"{message.name}: signal", (signal.name for signal in message.signals))
    by_name = {signal.name: signal for signal in message.signals}
    for signal in message.signals:
        if signal.acting and signal.start_value in signal.acting.codes:
            yield f"{message.name}: {signal.name} starts with {signal.start_value}, which acts"
    for signal in message.signals:
        above: list[Signal] = []
        while signal.multiplexer and signal not in above:
            above.append(signal)
            if signal.multiplexer not in by_name:
                yield f"{message.name}: {signal.name} is selected by no signal of the message"
                break
            signal = by_name[signal.multiplexer]  # noqa: PLW2901 - climbs to the outermost
        if signal in above and signal.multiplexer in by_name:
            yield f"{message.name}: {signal.name} selects itself"


def _text_faults(protocol: Protocol) -> Iterator[str]:
    """A backslash before the closing quote would quote the quote."""
    texts = [
        *((node.name, text) for node in protocol.nodes for text in (node.title, node.english)),
        *((each.name, text) for each in protocol.messages for text in (each.title, each.english)),
        *(
            (signal.name, text)
            for _, signal in protocol.signals()
            for text in (signal.title, signal.english, signal.unit)
        ),
        *((table.name, each.english) for table in protocol.value_tables for each in table.codes),
    ]
    for name, text in texts:
        if text.endswith("\\"):
            yield f"{name}: a text of it ends in a backslash"
