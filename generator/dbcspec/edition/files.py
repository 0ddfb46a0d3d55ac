"""The files of an edition that is a first patch made from a supplier's file."""

from __future__ import annotations

import re
import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from dbcspec.edition.codes import in_own_words, says_reserved
from dbcspec.edition.deviations import Deviations
from dbcspec.edition.findings import Deviation
from dbcspec.emit.spec import message_lines, row_pairs
from dbcspec.emit.spec_yaml import mapping_lines, scalar
from dbcspec.spec.compiled import Compiled
from dbcspec.spec.rows import Spec
from typedcan.model.naming import unused
from typedcan.model.protocol import ByteOrder, Message, Protocol, ReservedBits, Signal

_SCHEMA = "# yaml-language-server: $schema=../../schema"
_WIDE = 96
_ADDRESSED = 0xF0
"""From this PDU format on the identifiers of J1939 have no destination."""


@dataclass(frozen=True, slots=True)
class FirstPatch:
    """The files of an edition, path below its folder to bytes, and what a person has to settle."""

    files: dict[str, bytes]
    deviations: int
    messages: int
    notes: tuple[str, ...]


def first_patch(base: Compiled, found: Protocol, title: str, over: str) -> FirstPatch:
    """What a supplier's protocol says otherwise than a spec, as the files of an edition.

    ``title`` names its source, ``over`` the edition that ``base`` was compiled in, "" for none.
    Messages of the spec that the file does not have stay.
    """
    spec, ours = base.spec, base.protocol
    by_identifier = {(each.frame_id, each.extended): each for each in ours.messages}
    deviations = Deviations(spec, ours, found)
    new: list[Message] = []
    matched: list[tuple[Message, Message]] = []
    for message in found.messages:
        known = by_identifier.pop((message.frame_id, message.extended), None)
        if known is None:
            new.append(message)
        else:
            matched.append((known, message))
            deviations.look_at(known, message)
    added = _Added(spec, ours, matched, deviations.states)
    messages = [added.message(message) for message in new]
    findings = deviations.findings
    notes = [*findings.notes]
    if by_identifier:
        names = ", ".join(message.name for message in by_identifier.values())
        notes.append(f"the file does not have {names}: they stay as they are")
    rows = [(message, added.signals(message, signals)) for message, signals in findings.rows]
    rows += [(message, message.signals) for message in messages if message.signals]
    texts = {
        "edition.yaml": _head(title, over, findings.warnings),
        "errata.yaml": _errata(findings.deviations, base.printed),
        "messages.yaml": _messages(messages, spec, ours),
        **{
            f"tables/{count:02}-{message.name}.yaml": _table(message, signals, count)
            for count, (message, signals) in enumerate(rows, start=1)
        },
    }
    files = {name: ("\n".join(lines) + "\n").encode("utf-8") for name, lines in texts.items()}
    return FirstPatch(files, len(findings.deviations), len(messages), tuple(notes))


class _Added:
    """Messages and signals that the spec lacks, sent and received by its own nodes."""

    def __init__(
        self,
        spec: Spec,
        base: Protocol,
        matched: list[tuple[Message, Message]],
        states: tuple[str, ...],
    ) -> None:
        self._states = states
        self._has_reserved = "Reserved" in spec.standard.reserved
        self._names = {message.name for message in base.messages}
        self._addresses = {
            address: node.name
            for node in reversed(base.nodes)
            for address in (*node.other_addresses, node.address)
            if address is not None
        }
        self._nodes = _same_nodes(spec, matched)

    def message(self, message: Message) -> Message:
        """The message under a name that is free, with nodes of the spec."""
        name = unused(message.name, self._names)
        self._names.add(name)
        sender = self._nodes.get(message.sender, "")
        receivers: tuple[str, ...] = ()
        if message.extended:
            sender = self._addresses.get(message.frame_id & 0xFF, sender)
            if message.frame_id >> 16 & 0xFF < _ADDRESSED:
                to = self._addresses.get(message.frame_id >> 8 & 0xFF)
                receivers = (to,) if to else ()
        reserved = [each for each in message.signals if says_reserved(each)]
        kept = [each for each in message.signals if each not in reserved]
        return replace(
            message,
            name=name,
            sender=sender,
            other_senders=(),
            signals=tuple(self._signal(each, sender, receivers) for each in kept),
            reserved=tuple(
                ReservedBits(start=each.start, length=each.length, byte_order=each.byte_order)
                for each in reserved
                if self._has_reserved
            ),
        )

    def signals(self, message: Message, signals: Iterable[Signal]) -> tuple[Signal, ...]:
        """Signals of a message of the spec: received by whoever receives its others."""
        return tuple(replace(signal, receivers=message.receivers) for signal in signals)

    def _signal(self, signal: Signal, sender: str, receivers: tuple[str, ...]) -> Signal:
        mapped = (self._nodes.get(name, "") for name in signal.receivers)
        every = dict.fromkeys((*mapped, *receivers))
        return replace(
            in_own_words(signal, self._states),
            receivers=tuple(name for name in every if name and name != sender),
        )


def _same_nodes(spec: Spec, matched: list[tuple[Message, Message]]) -> dict[str, str]:
    """What the supplier's nodes are called in the spec: by name, else by what they send."""
    sent = Counter((theirs.sender, ours.sender) for ours, theirs in matched if theirs.sender)
    nodes = {theirs: ours for (theirs, ours), _ in reversed(sent.most_common())}
    for node in spec.standard.nodes:
        nodes |= dict.fromkeys((node.name, *node.aliases), node.name)
    return nodes


def _head(title: str, over: str, warnings: Iterable[str]) -> Iterator[str]:
    yield "# A first patch made from a file: go over each entry, and say who speaks so since when."
    yield f"{_SCHEMA}/edition.json"
    yield f"title: {scalar(title)}"
    yield f"english: {scalar(title)}"
    yield f"source: {scalar(title)}"
    yield "date: unknown"
    if over:
        yield f"over: {scalar(over)}"
    every = list(dict.fromkeys(warnings))
    if every:
        yield "warnings:"
        yield from (f"  - {scalar(each)}" for each in every)


def _errata(deviations: list[Deviation], printed: Spec) -> Iterator[str]:
    yield "# What the file says otherwise than the standard."
    yield f"{_SCHEMA}/errata.json"
    letters = _letters(printed)
    width = max(2, len(str(len(deviations))))
    yield "errata:" if deviations else "errata: []"
    for count, deviation in enumerate(deviations, start=1):
        yield f"  - id: {letters}{count:0{width}}"
        yield "    kind: edition"
        yield f"    place: {scalar(deviation.place)}"
        yield from _folded("printed", "; ".join(deviation.printed))
        yield from _folded("reading", "; ".join(deviation.reading))
        yield "    because: The supplier's file has it so."
        yield "    change:"
        for step in deviation.steps:
            yield f"      - at: [{scalar(step.path)}]"
            yield from (f"        {line}" for line in step.text.split("\n"))


def _letters(printed: Spec) -> str:
    """Letters that no number of an erratum of the spec begins with."""
    rows = [*printed.errata, *(row for each in printed.editions for row in each.errata)]
    taken = {match[0] for row in rows if (match := re.match("[A-Za-z_]+", row.id))}
    return next(
        each for each in ("S", *(f"S{chr(code)}_" for code in range(65, 91))) if each not in taken
    )


def _folded(key: str, text: str) -> Iterator[str]:
    """A text over several lines, where one does not hold it."""
    line = f"    {key}: {scalar(text)}"
    plain = " ".join(text.split())
    if len(line) <= _WIDE or not plain.isprintable():
        yield line
        return
    yield f"    {key}: >-"
    lines = textwrap.wrap(plain, _WIDE - 6, break_long_words=False, break_on_hyphens=False)
    yield from (f"      {each}" for each in lines)


def _messages(messages: list[Message], spec: Spec, base: Protocol) -> Iterator[str]:
    yield "# Messages that the standard does not have."
    yield f"{_SCHEMA}/edition-messages.json"
    usual = ByteOrder(spec.messages.byte_order)
    yield "messages:" if messages else "messages: []"
    for message in messages:
        yield from message_lines(message, base, usual)


def _table(message: Message, signals: tuple[Signal, ...], count: int) -> Iterator[str]:
    yield f"number: {count}"
    yield f"title: {scalar(message.title or message.name)}"
    yield f"english: {scalar(message.english or message.name)}"
    yield f'clause: "{count}"'
    yield "rows:"
    for number, signal in enumerate(signals, start=1):
        yield f"  - no: {number}"
        yield from mapping_lines(4, row_pairs(message, signal, {signal.name}))
