"""Which facts of two models differ, one by one, each where the spec would have to say it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal

from dbcspec.compare.pairing import MessagePair, SignalPair, pair
from typedcan.model.protocol import Aspect, Message, Protocol, Signal

ACTS = "codes that act"
"""The difference in which codes of a signal act, and all that is said of them."""


@dataclass(frozen=True, slots=True)
class Difference:
    """A fact of a message, or of a signal of it, as the spec has it and as it should be."""

    message: str
    signal: str
    what: str
    old: str
    new: str

    def __str__(self) -> str:
        subject = self.signal or self.message
        if not self.old:
            return f"{subject}: the spec has no {self.what} {self.new}"
        if not self.new:
            return f"{subject}: the spec alone has the {self.what} {self.old}"
        return f"{subject}: {self.what} is {self.old}, not {self.new}"


def differences(old: Protocol, new: Protocol) -> Iterator[Difference]:
    """Every difference in what both protocols carry, in the order of the old one."""
    both = old.carries & new.carries
    pairing = pair(old, new)
    for messages in pairing.messages:
        yield from _message(messages, both)
        for signals in messages.signals:
            yield from _signal(signals, both)
        for signal in messages.removed:
            yield Difference(messages.old.name, signal.name, "signal", signal.name, "")
        for signal in messages.added:
            yield Difference(messages.old.name, signal.name, "signal", "", signal.name)
    for message in pairing.removed:
        yield Difference(message.name, "", "message", message.name, "")
    for message in pairing.added:
        yield Difference(message.name, "", "message", "", message.name)


def _message(messages: MessagePair, both: frozenset[Aspect]) -> Iterator[Difference]:
    old, new = messages.old, messages.new
    facts: list[tuple[str, object, object]] = [
        ("name", old.name, new.name),
        ("identifier", f"0x{old.frame_id:X}", f"0x{new.frame_id:X}"),
        ("frame format", _format(old), _format(new)),
        ("length", old.length, new.length),
        ("sender", ", ".join(old.senders), ", ".join(new.senders)),
    ]
    if Aspect.PERIODS in both:
        facts.append(("period", old.period or 0, new.period or 0))
        facts.append(("send type", old.send_type.name, new.send_type.name))
    if Aspect.COMMENTS in both:
        facts.append(("title", old.title, new.title))
        facts.append(("English title", old.english, new.english))
    if Aspect.PROTECTION in both:
        facts.append(("checksum", old.checksum, new.checksum))
        facts.append(("counter", old.counter, new.counter))
    for what, before, after in facts:
        if before != after:
            yield Difference(old.name, "", what, _shown(before), _shown(after))


def _signal(signals: SignalPair, both: frozenset[Aspect]) -> Iterator[Difference]:
    old, new = signals.old, signals.new
    facts: list[tuple[str, object, object]] = [
        ("name", old.name, new.name),
        ("start", old.start, new.start),
        ("length", old.length, new.length),
        ("byte order", old.byte_order.value, new.byte_order.value),
        ("type", _type(old), _type(new)),
        ("factor", old.factor, new.factor),
        ("offset", old.offset, new.offset),
        ("range", (old.minimum, old.maximum), (new.minimum, new.maximum)),
        ("unit", old.unit, new.unit),
        ("codes", _codes(old, new), _codes(new, old)),
        ("multiplexing", _multiplexing(old), _multiplexing(new)),
    ]
    if set(old.receivers) != set(new.receivers):
        facts.append(("receivers", ",".join(old.receivers), ",".join(new.receivers)))
    elif signals.old_message.sender != signals.new_message.sender:
        facts.append(
            ("receivers", f"{signals.old_message.sender}>", f"{signals.new_message.sender}>")
        )
    if Aspect.START_VALUES in both:
        facts.append(("start value", old.start_value, new.start_value))
    if Aspect.COMMENTS in both:
        facts.append(("title", old.title, new.title))
        facts.append(("English title", old.english, new.english))
    if Aspect.PROTECTION in both:
        facts.append(("invalid code", old.invalid_code, new.invalid_code))
        facts.append(("other invalid codes", old.other_invalid_codes, new.other_invalid_codes))
        facts.append(("abnormal code", old.abnormal_code, new.abnormal_code))
    if Aspect.ACTS in both:
        facts.append((ACTS, _acts(old), _acts(new)))
    for what, before, after in facts:
        if before != after:
            yield Difference(
                signals.old_message.name, old.name, what, _shown(before), _shown(after)
            )


def _format(message: Message) -> str:
    width = "extended" if message.extended else "standard"
    width = "J1939PG" if message.by_pgn else width
    return f"{width}, {message.frame_kind}" if message.is_fd else width


def _type(signal: Signal) -> str:
    return ("signed" if signal.signed else "unsigned") + " float" * signal.is_float


def _multiplexing(signal: Signal) -> tuple[bool, str, tuple[int, ...]]:
    return signal.is_selector, signal.multiplexer, signal.selectors


def _acts(signal: Signal) -> str:
    """The codes, the safe one, what they are and where that stands."""
    acting = signal.acting
    if acting is None:
        return ""
    codes = ", ".join(map(str, acting.codes))
    return f"{codes} ({acting.kind}, safe {acting.safe}, {acting.reference or 'no clause'})"


def _codes(signal: Signal, other: Signal) -> str:
    """The codes that the other signal has not, or not so."""
    there = other.value_table.codes if other.value_table else ()
    here = signal.value_table.codes if signal.value_table else ()
    return ", ".join(
        f"{code.value}: {code.label}" + (f" ({code.english})" if code.english != code.label else "")
        for code in here
        if code not in there
    )


def _shown(value: object) -> str:
    """A fact as one short line; never empty, for that means that there is none."""
    if isinstance(value, Decimal):
        return format(value, "f")
    if isinstance(value, tuple) and all(isinstance(each, Decimal) for each in value) and value:
        return "~".join(_shown(each) for each in value)
    return str(value) if value not in ("", None, ()) else "nothing"
