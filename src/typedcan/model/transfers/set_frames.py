"""How a value that is the same in each set lies in its frames: what is read, what is written."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

from typedcan.model.protocol import Message
from typedcan.model.transfer import Counted, Ending
from typedcan.model.transfers.kind import Frame, SplitError
from typedcan.model.transfers.parts import Part, Parts, field_of

Content = tuple[Any, ...]
"""What a frame says: all that can be conflicted with."""


class Slot(NamedTuple):
    """One frame of a set: its number, and its signals that hold items of the value and none."""

    message: str
    number: int
    used: tuple[Part, ...]
    unused: tuple[Part, ...] = ()


def slots_of(parts: Parts, count: int) -> tuple[Slot, ...]:
    """The frames of a set with so many items, or frames where those are counted, in order."""
    if parts.number is None:
        return tuple(_slots_of_messages(parts, count))
    slots: list[Slot] = []
    left = parts.capacity if parts.transfer.counted is Counted.FRAMES else count
    most = count if parts.transfer.counted is Counted.FRAMES else left
    while left > 0 and len(slots) < most:
        number = parts.transfer.first_number + len(slots)
        items = _items_of(parts, parts.messages[0], number)
        if not items:
            break
        slots.append(Slot(parts.messages[0].name, number, items[:left], items[left:]))
        left -= len(items)
    return tuple(slots)


def _slots_of_messages(parts: Parts, count: int) -> Iterator[Slot]:
    for number, message in enumerate(parts.messages, 1):
        items = tuple(part for part in parts.items if part.message.name == message.name)
        yield Slot(message.name, number, items[: max(0, count)], items[max(0, count) :])
        count -= len(items)


def _items_of(parts: Parts, message: Message, number: int) -> tuple[Part, ...]:
    """The items of a numbered frame: those of its branch where the number selects branches."""
    selector = parts.number.signal.name if parts.number else ""
    return tuple(
        part
        for part in parts.items
        if part.message.name == message.name
        and (part.signal.multiplexer != selector or number in part.signal.selectors)
    )


class Reader(NamedTuple):
    """How a frame is read.

    ``content`` takes what counts of its values: those of ``details``, by field name, the length of
    the value at ``length``, if it is there, and from ``items`` on the items.
    """

    content: Callable[[tuple[Any, ...]], Content]
    details: tuple[str, ...]
    length: int | None
    items: int


def reader_of(parts: Parts, wanted: Sequence[Part], slot: Slot) -> Reader:
    """How one frame of a set is read of the wanted values."""
    details = [part for part in parts.details if part.message.name == slot.message]
    length = [part for part in (parts.length,) if part and part.message.name == slot.message]
    places = [wanted.index(part) for part in (*details, *length, *slot.used)]
    names = tuple(field_of(part) for part in details)
    return Reader(_picker(places), names, len(details) if length else None, len(details + length))


def _picker(places: Sequence[int]) -> Callable[[tuple[Any, ...]], Content]:
    begin = places[0] if places else 0
    if [*places] == [*range(begin, begin + len(places))]:
        return itemgetter(slice(begin, begin + len(places)))
    return itemgetter(*places)


def wanted_of(parts: Parts, message: str) -> tuple[Part, ...]:
    """The number first, then how much there is, where its own frames tell that."""
    head = [parts.number, None if parts.totals else parts.count]
    rest = (*parts.details, parts.length, *parts.items)
    own = [part for part in rest if part and part.message.name == message]
    return (*(part for part in head if part), *own)


def split_items(parts: Parts, items: Sequence[Any], details: Mapping[str, Any]) -> list[Frame]:
    """The frames of so many items, with what belongs to the value by field names.

    Items that are not used hold the fill, where there is one. Raises `SplitError` where there are
    other items than the frames carry.
    """
    transfer = parts.transfer
    count = transfer.count or len(parts.items)
    if parts.count:
        count = len(items)
        if transfer.counted is Counted.FRAMES:
            count = -(count // -parts.width)
    slots = slots_of(parts, count)
    room = sum(len(slot.used) for slot in slots)
    is_exact = transfer.length is Ending.FIXED and transfer.counted is Counted.ITEMS
    if is_exact and not parts.length and len(items) != room:
        raise SplitError(f"the frames carry {room} items, not {len(items)}")
    if not 1 <= len(items) <= room:
        raise SplitError(f"the frames carry 1 to {room} items, not {len(items)}")
    frames: list[Frame] = []
    done = 0
    for slot in slots:
        own = (*slot.used, *slot.unused)
        values: dict[str, Any] = dict(_facts(parts, slot, count, len(items), details))
        for place, part in enumerate(own, done):
            if place < len(items):
                values[part.signal.name] = items[place]
            elif transfer.fill is not None:
                values[part.signal.name] = part.value_of(transfer.fill)
        frames.append(Frame(slot.message, values))
        done += len(own)
    return frames


def _facts(
    parts: Parts, slot: Slot, count: int, length: int, details: Mapping[str, Any]
) -> Iterator[tuple[str, Any]]:
    """What a frame says beside its items."""
    if parts.number:
        yield parts.number.signal.name, slot.number
    for part, value in ((parts.count, count), (parts.length, length)):
        if part and part.message.name == slot.message:
            yield part.signal.name, value
    for part in parts.details:
        if part.message.name == slot.message and field_of(part) in details:
            yield part.signal.name, details[field_of(part)]
