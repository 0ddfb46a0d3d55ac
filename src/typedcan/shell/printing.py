"""What a terminal is shown: nothing in it that the terminal would obey or nobody could see."""

from __future__ import annotations

import json
import re
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

_SPACES = frozenset(map(chr, (0xA0, 0x1680, *range(0x2000, 0x200B), 0x202F, 0x205F, 0x3000)))
"""Spaces that `str.isprintable` counts among what cannot be seen; Chinese texts have the last."""

_COLOUR = re.compile(r"(\x1b\[[0-9;]*m)")


def printable(text: str) -> str:
    r"""The text on one line, each character in it that cannot be seen as its escape, such as \n.

    Control characters, line and paragraph separators, marks that hide or turn round the text about
    them, halves of surrogate pairs and what is no character at all: a terminal obeys them, XML
    forbids them, a reviewer misses them. Whatever else there is stays as it is.
    """
    return _escaped(text, lambda character: repr(character)[1:-1])


def printable_json(value: object, *, indent: int | None = None) -> str:
    """JSON of a value, with the escapes of JSON for what `printable` escapes: it loses nothing."""
    text = json.dumps(value, ensure_ascii=False, indent=indent)
    lines = (_escaped(line, lambda found: json.dumps(found)[1:-1]) for line in text.split("\n"))
    return "\n".join(lines)


def aligned(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """The lines of a table, its cells made printable."""
    table = [list(map(printable, row)) for row in (headings, *rows)]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    table.insert(1, ["-" * width for width in widths])
    for row in table:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        yield "  ".join(cells).rstrip()


def print_line(text: str, *, flush: bool = False) -> None:
    """Print a line of the results: a line break in the text is shown and does not make another."""
    print(printable(text), flush=flush)


def print_text(text: str, *, coloured: bool = False) -> None:
    """Print results whose line breaks are ours, such as a report; nothing where there are none.

    Of one that is ``coloured`` the sequences that set colours are let through: whoever puts them in
    makes the texts between them printable first.
    """
    shown = _colours_let_through if coloured else printable
    if text:
        print("\n".join(map(shown, text.removesuffix("\n").split("\n"))))


def print_remark(text: str) -> None:
    """Print a line beside the results: an error, or what is done; that nobody reads it is fine."""
    if sys.stderr:  # else print would take stdout
        with suppress(OSError, ValueError):  # a terminal that is gone, a stream that is closed
            print(printable(text), file=sys.stderr, flush=True)


def print_warnings() -> None:
    """Have what libraries warn of printed as remarks from now on."""
    warnings.showwarning = _print_warning  # type: ignore[assignment]


def _print_warning(message: Warning | str, category: type[Warning], *_: object) -> None:
    print_remark(f"{category.__name__}: {message}")


def _colours_let_through(line: str) -> str:
    return "".join(
        part if _COLOUR.fullmatch(part) else printable(part) for part in _COLOUR.split(line)
    )


def _escaped(text: str, escape: Callable[[str], str]) -> str:
    if text.isprintable():
        return text
    return "".join(
        character if character.isprintable() or character in _SPACES else escape(character)
        for character in text
    )
