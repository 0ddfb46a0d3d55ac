"""Multiplexing in generated Python: a field of a branch that is not there is None."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.model.protocol import Protocol, Signal

_LONGEST_LINE = 100

Conditions = tuple[tuple[int, tuple[int, ...]], ...]
"""Which raw values the selectors must have, outermost first: index of its field, and values."""


def conditions(signal: Signal, by_name: Mapping[str, tuple[int, Signal]]) -> Conditions:
    """When a signal is there; ``by_name`` has the readable ones and the places of their fields."""
    found: list[tuple[int, tuple[int, ...]]] = []
    while signal.multiplexer:
        index, selector = by_name[signal.multiplexer]
        found.insert(0, (index, signal.selectors))
        signal = selector
    return tuple(found)


class Branches:
    """Names the sets of selectors of a protocol, and writes what depends on them."""

    def __init__(self, protocol: Protocol) -> None:
        every = dict.fromkeys(signal.selectors for _, signal in protocol.signals())
        used = [values for values in every if values]
        self._names = {values: f"_BRANCH_{count}" for count, values in enumerate(used, start=1)}

    def constants(self) -> list[str]:
        """The lines of the decoders' module that define the sets."""
        return [_constant(name, values) for values, name in self._names.items()]

    def decoded(self, target: str, value: str, when: Conditions) -> str:
        """The lines that set a field of a message."""
        lines = [f"    {target} = None"] if when else []
        for depth, (index, values) in enumerate(when, start=1):
            lines.append(f"{'    ' * depth}if v{index} in {self._names[values]}:")
        return "\n".join((*lines, assigned(target, value, len(when) + 1)))


def assigned(target: str, value: str, depth: int = 1) -> str:
    """An assignment in a block, in parentheses where it is too long, as the formatter wants it."""
    indent = "    " * depth
    line = f"{indent}{target} = {value}"
    if len(line) <= _LONGEST_LINE:
        return line
    return f"{indent}{target} = (\n{indent}    {value}\n{indent})"


def declared(target: str, default: str | None) -> str:
    """A field in the body of a class; one without a default must be given."""
    return f"    {target}" if default is None else assigned(target, default)


def called(target: str, function: str, arguments: str) -> str:
    """An assignment of what a function returns, at the beginning of a line."""
    line = f"{target} = {function}({arguments})"
    return line if len(line) <= _LONGEST_LINE else f"{target} = {function}(\n    {arguments}\n)"


def _constant(name: str, values: tuple[int, ...]) -> str:
    line = f"{name} = frozenset({_tuple(values)})"
    if len(line) <= _LONGEST_LINE:
        return line
    return "\n".join((f"{name} = frozenset(", *_column(values, "    ", ""), ")"))


def _tuple(values: tuple[int, ...]) -> str:
    return f"({values[0]},)" if len(values) == 1 else f"({', '.join(map(str, values))})"


def _column(values: tuple[int, ...], indent: str, end: str) -> list[str]:
    """A tuple that is too long for a line, as the formatter wants it."""
    return [f"{indent}(", *(f"{indent}    {value}," for value in values), f"{indent}){end}"]
