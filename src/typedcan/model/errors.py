"""Where something stands, and the errors of reading a protocol."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Location:
    """A place in a text file; line and column count from 1."""

    path: str
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        return f"{self.path}:{self.line}:{self.column}"


class TypedcanError(Exception):
    """Base of all errors that these packages raise on purpose."""

    @property
    def lines(self) -> tuple[str, ...]:
        """What it says, for people, a line each."""
        return (str(self),)


class ReadError(TypedcanError):
    """A file or a configuration cannot be used: one line that says which and why."""
