"""Which of two rows of things belong together: by one key, the rest by the next."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import TypeVar

from typedcan.model.protocol import Node, Protocol

T = TypeVar("T")


def is_reordered(matched: Sequence[tuple[T, T]], new: Sequence[T]) -> bool:
    """Whether things that are in both stand in another order than before."""
    position = {id(item): index for index, item in enumerate(new)}
    indexes = [position[id(after)] for _, after in matched]
    return indexes != sorted(indexes)


def roles(old: Protocol, new: Protocol) -> tuple[Callable[[Node], Hashable], ...]:
    """What a renamed node is known by: what it sends, its address, what it receives.

    A node without the one or the other is not recognised by it.
    """
    sent: dict[int, frozenset[int]] = {}
    heard: dict[int, frozenset[int]] = {}
    for side in (old, new):
        sends: dict[str, set[int]] = {}
        hears: dict[str, set[int]] = {}
        for message in side.messages:
            for sender in message.senders or ("",):
                sends.setdefault(sender, set()).add(message.frame_id)
            for receiver in message.receivers:
                hears.setdefault(receiver, set()).add(message.frame_id)
        for node in side.nodes:
            sent[id(node)] = frozenset(sends.get(node.name, ()))
            heard[id(node)] = frozenset(hears.get(node.name, ()))
    return (
        lambda node: sent[id(node)] or id(node),
        lambda node: ("address", node.address) if node.address is not None else id(node),
        lambda node: heard[id(node)] or id(node),
    )


def matched(
    old: Sequence[T], new: Sequence[T], *keys: Callable[[T], Hashable]
) -> tuple[tuple[tuple[T, T], ...], tuple[T, ...], tuple[T, ...]]:
    """Pairs by the first key, the rest by the second, and so on; then what is left of each."""
    found: dict[int, int] = {}
    taken: set[int] = set()
    for key in keys:
        if len(found) == len(old) or len(taken) == len(new):
            break
        waiting: dict[Hashable, list[int]] = {}
        for index in reversed(range(len(new))):
            if index not in taken:
                waiting.setdefault(key(new[index]), []).append(index)
        for index, item in enumerate(old):
            if index not in found and (candidates := waiting.get(key(item))):
                found[index] = candidates.pop()
                taken.add(found[index])
    return (
        tuple((old[index], new[found[index]]) for index in sorted(found)),
        tuple(item for index, item in enumerate(old) if index not in found),
        tuple(item for index, item in enumerate(new) if index not in taken),
    )
