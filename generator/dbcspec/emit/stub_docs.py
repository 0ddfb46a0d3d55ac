"""What generated Python says of itself: docstrings, and texts as literals."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Sequence

from dbcspec.emit.multiplexing import ranges
from typedcan.model.j1939 import pgn
from typedcan.model.layout import float_limits
from typedcan.model.numbers import number
from typedcan.model.protocol import Message, Signal

_WIDTH = 92


def quote(text: str) -> str:
    """A string literal as the formatter wants it."""
    plain = _printable(text)
    mark = "'" if plain.count('"') > plain.count("'") else '"'
    return mark + plain.replace("\\", "\\\\").replace(mark, f"\\{mark}") + mark


def enum_doc(users: tuple[Signal, ...]) -> str:
    """Of an enum: whose codes they are."""
    first, *others = users
    more = f" and {len(others)} more" if others else ""
    return line(f"Codes of {first.name}{more}{_cited(first.reference)}.")


def field_doc(signal: Signal, says: str, selector: str = "") -> str:
    """Of a field: title, limits, name in the DBC, place in the standard, what acts.

    ``says`` is what it states where it is not given, if that is a statement, ``selector`` the field
    that selects its branch, if it is in one.
    """
    english = signal.english or signal.title or signal.name
    title = f" ({signal.title})" if signal.title not in ("", english) else ""
    text = f"{english}{title}: {_limits(signal)}. {signal.name}{_cited(signal.reference)}."
    text += f" There while {selector} is {_ranges(signal.selectors)}." if selector else ""
    return _wrapped(text + _acting(signal) + (f" If not given: {says}." if says else ""))


def _ranges(numbers: Sequence[int]) -> str:
    """``0 to 2, 5``: the numbers, as few as that takes."""
    runs = ranges(numbers)
    return ", ".join(f"{low}" if low == high else f"{low} to {high}" for low, high in runs)


def _acting(signal: Signal) -> str:
    """Which codes act, which one is safe, and whether the field has to be given."""
    if not signal.acting:
        return ""
    labels = signal.value_table.labels() if signal.value_table else {}
    codes = ", ".join(labels.get(code, str(code)) for code in signal.acting.codes)
    safe = labels.get(signal.acting.safe, str(signal.acting.safe))
    what = "Says that something is on" if signal.acting.reports else "Makes the receiver act"
    given = " It has to be given: no value would be one of these." if signal.must_be_given else ""
    return f" {what}: {codes}; safe is {safe}.{given}"


def _limits(signal: Signal) -> str:
    unit = f" {signal.unit}" if signal.unit else ""
    if signal.is_float and (signal.minimum, signal.maximum) == float_limits(signal.length):
        return f"any number{unit}"
    return f"{number(signal.minimum)} to {number(signal.maximum)}{unit}"


def message_doc(message: Message, said: Sequence[str], needed: Sequence[str]) -> str:
    """Of a message: what it carries, identifier, route, when it is sent, and what is not given.

    ``said`` is what its fields state where they are not given, ``needed`` which have to be.
    """
    when = f", every {message.period} ms" if message.period else ""
    while_ = f", sent {message.condition}" if message.condition else ""
    found = f", found by its PGN 0x{pgn(message.frame_id):04X}" if message.by_pgn else ""
    facts = f"Identifier 0x{message.frame_id:08X}{found}{_route(message)}{when}{while_}."
    facts += f" {message.frame_kind}." if message.is_fd else ""
    if message.reference:
        facts += f" {message.reference}."
    title = f"{line(message.title)}.\n\n    " if message.title else ""
    text = f"{line(message.english or message.name)}.\n\n    {title}{_wrapped(facts)}"
    rest = _not_given(said, needed)
    return f"{text}\n\n    {_wrapped(rest)}" if rest else text


def _not_given(said: Sequence[str], needed: Sequence[str]) -> str:
    counts = Counter(said)
    texts = [f"{label} ({count} fields)" if count > 1 else label for label, count in counts.items()]
    parts = [f"Fields that are not given say: {', '.join(texts)}."] if texts else []
    return " ".join((*parts, *([f"Must be given: {', '.join(needed)}."] if needed else [])))


def _route(message: Message) -> str:
    senders, receivers = " or ".join(message.senders), " and ".join(message.receivers)
    if senders and receivers:
        return f", {senders} to {receivers}"
    if senders:
        return f", from {senders}"
    return f", to {receivers}" if receivers else ""


def _cited(reference: str) -> str:
    return f", {reference}" if reference else ""


def line(text: str) -> str:
    """One line that can stand between three quotes."""
    text = " ".join(_printable(text).split())
    return text.replace("\\", "\\\\").replace('"', "'")


def _printable(text: str) -> str:
    """The text with spaces for what nobody could see."""
    if text.isprintable():
        return text
    return " ".join("".join(each if each.isprintable() else " " for each in text).split())


def _wrapped(text: str) -> str:
    lines = textwrap.wrap(line(text), _WIDTH, break_long_words=False, break_on_hyphens=False)
    return "\n    ".join(lines)
