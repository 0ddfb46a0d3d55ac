"""Generated Python that says who sends what, and what takes several frames or a request."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from dbcspec.emit.stub_docs import quote
from typedcan.model.protocol import Message, Protocol, SendType, Signal, Transfer

_LONGEST_LINE = 100


class References:
    """How the module of the protocol names messages, fields and tuples of them.

    Parameters
    ----------
    class_of
        The name of the class of a message.
    """

    def __init__(self, protocol: Protocol, class_of: Callable[[Message], str]) -> None:
        self._classes = {message.name: class_of(message) for message in protocol.messages}
        self._signals: dict[str, tuple[Message, Signal]] = {
            signal.name: (message, signal) for message, signal in protocol.signals()
        }
        self._protocol = protocol

    def message(self, name: str) -> str:
        """The class of a message."""
        return f"messages.{self._classes[name]}"

    def field(self, name: str, used: int) -> str:
        """A signal as a field; ``used`` columns of the line are taken before it."""
        message, signal = self._signals[name]
        arguments = (self.message(message.name), quote(signal.python_name))
        line = f"FieldRef({', '.join(arguments)})"
        if used + len(line) < _LONGEST_LINE:
            return line
        indent = " " * (4 * (used // 4))
        inner = "".join(f"{indent}    {argument},\n" for argument in arguments)
        return f"FieldRef(\n{inner}{indent})"

    def messages(self, names: Sequence[str], depth: int) -> str:
        """The classes of messages as a tuple."""
        return tuple_of([self.message(name) for name in names], depth)

    def items(self, transfer: Transfer) -> str:
        """The fields that hold the parts of a transfer, as a tuple."""
        return tuple_of([self.field(name, 16) for name in transfer.items], 3)

    def fields(self, transfer: Transfer) -> list[str]:
        """The arguments of a transfer that name one field."""
        named = (
            ("count_field", transfer.count_signal),
            ("frame_number", transfer.frame_number),
            ("group", transfer.group),
            ("groups_field", transfer.groups_signal),
            ("length_field", transfer.length_signal),
        )
        return [
            f"{argument}={self.field(name, 13 + len(argument))}" for argument, name in named if name
        ]

    def conditional(self) -> list[str]:
        """The messages that have a period but are sent only while a condition holds."""
        return [
            self.message(message.name)
            for message in self._protocol.messages
            if message.send_type is SendType.IF_ACTIVE and message.period
        ]

    def imports(self) -> str:
        """What the module takes from the runtime's own."""
        names = ["Protocol"]
        names += ["Request"] if self._protocol.requests else []
        names += ["Transfer"] if self._protocol.transfers else []
        if len(names) > 1:
            names.insert(0, "FieldRef")
        return ", ".join(names)


def tuple_of(texts: Sequence[str], depth: int = 1) -> str:
    """A tuple as an argument at a depth of indentation, one member a line unless it has one."""
    if len(texts) < 2:
        return f"({texts[0]},)" if texts else "()"
    indent = " " * (4 * depth)
    lines = "".join(f"{indent}    {text},\n" for text in texts)
    return f"(\n{lines}{indent})"
