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


class DatabaseError(TypedcanError):
    """The model and the generated code of a package do not belong together."""


def one_line(error: BaseException) -> str:
    """The text of an error and of its cause, in one line."""
    texts = [_text(error)]
    if error.__cause__ and _text(error.__cause__) not in texts[0]:
        texts.append(_text(error.__cause__))
    return ": ".join(texts)


def _text(error: BaseException) -> str:
    name = type(error).__name__
    try:
        text = " ".join(str(error).split())
    except BaseException:  # noqa: BLE001 - an error of somebody else's that cannot even be shown
        text = ""
    # What a driver raises by mistake, such as "list index out of range", says too little alone.
    wanted = isinstance(error, OSError | ValueError) or type(error).__module__ != "builtins"
    return f"{name}: {text}" if text and not wanted else text or name
