"""Elements of HTML and SVG; every text that is put into one is escaped."""

from __future__ import annotations

import html
from collections.abc import Sequence

from typedcan.shell.printing import printable


class Markup(str):
    """A piece of a document; a plain text is none, and is escaped where it is put into one."""

    __slots__ = ()


def element(tag: str, *children: str, **attributes: str | None) -> Markup:
    """An element with what is in it.

    Parameters
    ----------
    children
        Elements, or texts that are to be seen as they are.
    attributes
        By name, ``_`` at its end left out and elsewhere ``-``; None: left out.
    """
    given = "".join(
        f' {name.rstrip("_").replace("_", "-")}="{html.escape(printable(value))}"'
        for name, value in attributes.items()
        if value is not None
    )
    return Markup(f"<{tag}{given}>{together(*children)}</{tag}>")


def together(*parts: str) -> Markup:
    """Parts one behind the other."""
    return Markup("".join(map(_escaped, parts)))


def lines(*parts: str) -> Markup:
    """Parts, each on lines of its own; empty ones are left out."""
    return Markup("\n".join(_escaped(part) for part in parts if part))


def _escaped(part: str) -> str:
    return part if isinstance(part, Markup) else html.escape(printable(part))


def table(
    headings: Sequence[str], rows: Sequence[Sequence[str]], *, numeric: str, wide: int
) -> Markup:
    """A table in a box of its own, which scrolls where the page is too narrow.

    Parameters
    ----------
    numeric
        The places of the columns with numbers, as digits from 0.
    wide
        The place of the column with sentences.
    """
    kinds = {int(place): "n" for place in numeric} | {wide: "wide"}
    head = [
        element("th", text, class_=kinds.get(place), scope="col")
        for place, text in enumerate(headings)
    ]
    body = [
        element(
            "tr",
            *(element("td", cell, class_=kinds.get(place)) for place, cell in enumerate(row)),
        )
        for row in rows
    ]
    inner = together(element("thead", element("tr", *head)), element("tbody", lines(*body)))
    # Reached by the keyboard, so that what is out of sight can be scrolled to.
    return element("div", element("table", inner), class_="scroll", tabindex="0")
