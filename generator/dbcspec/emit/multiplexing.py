"""How DBC files write multiplexing: markers on the SG_ lines, and SG_MUL_VAL_ where they fail."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

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
            yield signal, ", ".join(f"{low}-{high}" for low, high in ranges(signal.selectors))


def ranges(numbers: Iterable[int]) -> list[tuple[int, int]]:
    """The numbers as the fewest ranges, both ends included."""
    found: list[tuple[int, int]] = []
    for number in sorted(numbers):
        if found and found[-1][1] + 1 == number:
            found[-1] = (found[-1][0], number)
        else:
            found.append((number, number))
    return found
