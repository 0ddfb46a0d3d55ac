"""How DBC files write multiplexing: markers on the SG_ lines, and SG_MUL_VAL_ where they fail."""

from __future__ import annotations

from collections.abc import Iterator

from typedcan.model.protocol import Message, Signal


def marker(signal: Signal) -> str:
    """What stands after the name on its SG_ line, with a space before it."""
    branch = f"m{signal.selectors[0]}" if signal.multiplexer and signal.selectors else ""
    mark = f"{branch}M" if signal.is_selector else branch
    return f" {mark}" if mark else ""


def selector_lists(message: Message) -> Iterator[tuple[Signal, str]]:
    """The multiplexed signals with their selectors as SG_MUL_VAL_ has them.

    None where markers say everything: there is one selector, which is not multiplexed itself, and
    every signal has one branch.
    """
    multiplexed = [each for each in message.signals if each.multiplexer and each.selectors]
    selectors = [each for each in message.signals if each.is_selector]
    plain = (
        len(selectors) == 1
        and not selectors[0].multiplexer
        and all(len(each.selectors) == 1 for each in multiplexed)
    )
    if not plain:
        for signal in multiplexed:
            yield signal, ", ".join(f"{low}-{high}" for low, high in _ranges(signal.selectors))


def _ranges(numbers: tuple[int, ...]) -> list[tuple[int, int]]:
    ranges: list[tuple[int, int]] = []
    for number in sorted(numbers):
        if ranges and ranges[-1][1] + 1 == number:
            ranges[-1] = (ranges[-1][0], number)
        else:
            ranges.append((number, number))
    return ranges
