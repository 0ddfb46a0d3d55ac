"""What can be wrong with a transfer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Kind = Literal["conflict", "timeout", "number", "length", "character", "check", "totals"]
"""What is wrong.

conflict
    A frame came with other content than before: the value changed, or two nodes send it.
timeout
    A set of frames was begun and not completed in time, or not confirmed by a second one.
number
    A frame number or group number that there cannot be.
length
    The text is not transmitted, or is longer than its frames.
character
    The text has a code that has no character.
check
    The text has no right check digit.
totals
    More readings arrive than the sender says there are.
"""


@dataclass(frozen=True, slots=True)
class Problem:
    """Something wrong with a transfer.

    ``transfer`` is its name in the protocol, ``text`` says in one line what is wrong, ``at`` is
    the time in seconds.
    """

    transfer: str
    kind: Kind
    text: str
    at: float

    def __str__(self) -> str:
        return f"{self.transfer}: {self.text}"
