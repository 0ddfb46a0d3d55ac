"""A value that takes several frames, as a spec says it; `transfers` beside has the kinds."""

from __future__ import annotations

from dataclasses import dataclass, fields
from decimal import Decimal
from enum import Enum
from typing import Any


class Numbering(Enum):
    """What the numbers of frames count: those of a group, or all of them through all groups."""

    WITHIN_GROUP = "within_group"
    THROUGH = "through"


class Counted(Enum):
    """What a count tells: how many items there are in all, or how many frames."""

    ITEMS = "items"
    FRAMES = "frames"


class Pace(Enum):
    """What comes in a period of the messages: all frames of a set, or one of them."""

    ALL_IN_PERIOD = "all_in_period"
    ONE_A_PERIOD = "one_a_period"


class Ending(Enum):
    """Where a text ends: all its characters count, or those before the first fill."""

    FIXED = "fixed"
    TO_FILL = "to_fill"


@dataclass(frozen=True, slots=True, kw_only=True)
class Transfer:
    """A value that takes several frames; of messages and signals the names are here.

    Parameters
    ----------
    name, english
        Its name, and what it carries.
    kind
        The name of its kind, which says what the rest means.
    messages
        Those that carry it, in order.
    items
        The signals that hold its parts, in order: those of one frame where frames are numbered,
        else those of all messages.
    frame_number, first_number
        The signal that numbers the frames, and the number of the first one.
    numbering
        What it counts where there are groups.
    group, first_group
        The signal that names the group of a frame, and the first group.
    groups, groups_signal
        How many groups there are: fixed, or told by a signal.
    count, count_signal, counted
        How many items, or frames, there are in all: fixed, or told by a signal.
    counts
        How many items each group has, where all that is fixed.
    length, length_signal
        Where a text ends, or the signal that tells how many of the items count.
    fill
        Raw value of items that are not used; None where there is none.
    encoding
        Of the bytes of a text; empty where the value tables of its items name the characters, or
        else for ASCII.
    details
        Further signals of its messages that belong to the value.
    pace
        What comes in a period of its messages.
    period
        In ms, from one time that all of it is sent to the next; None: as its messages and the pace
        say.
    timeout
        Periods in which all frames must have come; None for what the kind has.
    rounds
        How often in a row the same must come before it counts; None for what the kind has.
    table, column
        What tables of logs and the columns of readings there are called; empty for its name.
    """

    name: str
    english: str
    kind: str = ""
    messages: tuple[str, ...]
    items: tuple[str, ...]
    frame_number: str = ""
    first_number: int = 1
    numbering: Numbering = Numbering.THROUGH
    group: str = ""
    first_group: int = 1
    groups: int | None = None
    groups_signal: str = ""
    count: int | None = None
    count_signal: str = ""
    counted: Counted = Counted.ITEMS
    counts: tuple[int, ...] = ()
    length: Ending = Ending.FIXED
    length_signal: str = ""
    fill: int | None = None
    encoding: str = ""
    details: tuple[str, ...] = ()
    pace: Pace = Pace.ALL_IN_PERIOD
    period: int | None = None
    timeout: Decimal | None = None
    rounds: int | None = None
    table: str = ""
    column: str = ""

    def given(self) -> dict[str, str | int | Decimal | tuple[str | int, ...]]:
        """What is not left out, by the names of a spec and as it writes it."""
        values = {part.name: getattr(self, part.name) for part in fields(self)}
        return {
            part.name: _plain(values[part.name])
            for part in fields(self)
            if values[part.name] != part.default
        }


def _plain(value: Any) -> Any:
    return value.value if isinstance(value, Enum) else value
