"""What a supplier's file says otherwise than a spec, message by message, as changes of the spec.

Messages are matched by their identifiers and signals by their bits; what they are called, who sends
and receives them, and how units are spelt is the supplier's own and no difference.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from decimal import Decimal

from dbcspec.edition.codes import in_own_words, moved, new_codes, says_reserved, states_of
from dbcspec.edition.findings import Deviation, Findings, Step
from dbcspec.edition.places import free_pieces, named_in_behaviour
from dbcspec.edition.scales import has_otherwise, scale_keys
from dbcspec.emit.spec import field_pairs
from dbcspec.emit.spec_yaml import flow_entries
from dbcspec.spec.rows import FieldRow, MessageRow, SignalRow, Spec
from typedcan.model.acting import ActingCodes
from typedcan.model.layout import bits
from typedcan.model.protocol import Aspect, ByteOrder, Message, Protocol, SendType, Signal


class Deviations:
    """Holds the messages of a supplier against those of a spec, one after the other.

    Parameters
    ----------
    spec, base
        The rows of the spec with all errata made, and what they resolve to.
    found
        The supplier's protocol.
    """

    def __init__(self, spec: Spec, base: Protocol, found: Protocol) -> None:
        self.findings = Findings()
        self.states = states_of(spec)
        self._spec = spec
        self._base = base
        self._periods = Aspect.PERIODS in found.carries
        self._explained = spec.explanations()
        self._rows = {row.name: row for row in spec.messages.messages}
        self._referenced = named_in_behaviour(spec)
        self._users: dict[int, int] = {}
        for rows in self._explained.values():
            for _, row in rows:
                self._users[id(row)] = self._users.get(id(row), 0) + 1

    def look_at(self, ours: Message, theirs: Message) -> None:
        """Take down what the supplier's message has otherwise than that of the same identifier."""
        row = self._rows[ours.name]
        self._frame(row, ours, theirs)
        named = [signal for signal in theirs.signals if not says_reserved(signal)]
        by_place = {(bits(signal), signal.selectors): signal for signal in named}
        pairs = [
            (signal, by_place.pop((bits(signal), signal.selectors)))
            for signal in ours.signals
            if (bits(signal), signal.selectors) in by_place
        ]
        kept = {signal.name for signal, _ in pairs}
        gone = [signal for signal in ours.signals if signal.name not in kept]
        self._layout(row, ours, gone, tuple(by_place.values()))
        self._scales(row, pairs)
        for signal, other in pairs:
            self._codes(row, signal, other)

    def _keep(self, deviation: Deviation) -> None:
        if deviation.steps:
            self.findings.deviations.append(deviation)

    def _frame(self, row: MessageRow, ours: Message, theirs: Message) -> None:
        deviation = Deviation(f"{row.name}, its frames")
        facts: list[tuple[str, object, str, str]] = []
        if ours.length != theirs.length:
            was, now = f"{ours.length} bytes", f"{theirs.length} bytes"
            facts.append(("length", theirs.length, was, now))
        if self._periods and theirs.period and theirs.period != ours.period:
            was = f"every {ours.period} ms" if ours.period else "no period"
            facts.append(("period", theirs.period, was, f"every {theirs.period} ms"))
        is_cyclic = theirs.send_type is SendType.CYCLIC and theirs.period
        if self._periods and is_cyclic and ours.send_type is not SendType.CYCLIC:
            was = ours.send_type.name.lower().replace("_", " ")
            facts.append(("type", "Cyclic", f"sent {was}", "sent always"))
        if facts:
            deviation.add(
                ", ".join(was for _, _, was, _ in facts),
                ", ".join(now for *_, now in facts),
                Step(
                    f"messages/{row.name}",
                    f"set: {{{flow_entries((key, value) for key, value, *_ in facts)}}}",
                ),
            )
        self._keep(deviation)

    def _layout(
        self, row: MessageRow, ours: Message, gone: list[Signal], new: tuple[Signal, ...]
    ) -> None:
        """Signals that only one side has, and what becomes of reserved bits."""
        held = [each for each in gone if self._referenced & {each.name, f"{row.name}.{each.name}"}]
        for signal in held:
            text = f"{row.name}.{signal.name}: the file has no such signal, but behaviour.yaml"
            self.findings.notes.append(f"{text} names it, so it stays")
        gone = [signal for signal in gone if signal not in held]
        blocked = {bit for signal in held for bit in bits(signal)}
        for signal in new:
            if blocked & {*bits(signal)}:
                text = f"{row.name}.{signal.name} is left out: it lies on a signal that stays"
                self.findings.notes.append(text)
        new = tuple(signal for signal in new if not blocked & {*bits(signal)})
        if not gone and not new:
            return
        taken = {signal.name for signal in ours.signals} - {signal.name for signal in gone}
        new = _with_own_names((in_own_words(each, self.states) for each in new), taken)
        deviation = Deviation(f"{row.name}, its signals")
        steps = (*self._layout_steps(row, gone, new), *self._rows_gone(row, gone))
        deviation.add(_names(gone), _names(new), *steps)
        self._keep(deviation)
        if new:
            self.findings.rows.append((ours, new))

    def _layout_steps(
        self, row: MessageRow, gone: list[Signal], new: tuple[Signal, ...]
    ) -> Iterator[Step]:
        path, order = f"messages/{row.name}", self._order(row)
        wanted = {bit for signal in new for bit in bits(signal)}
        reserved = [
            each
            for each in row.signals
            if each.name in self._spec.standard.reserved
            and wanted & {*bits(_signal_of(each, order))}
        ]
        removed = [f"{each.name}@{each.start}" for each in reserved]
        removed += [signal.name for signal in gone]
        if removed:
            yield Step(path, f"remove: {{signals: [{', '.join(removed)}]}}")
        left = {bit for each in reserved for bit in bits(_signal_of(each, order))}
        left |= {bit for signal in gone for bit in bits(signal)}
        entries = [flow_entries(field_pairs(signal, order, ())) for signal in new]
        if self._spec.standard.reserved:
            name = self._spec.standard.reserved[0]
            entries += [
                flow_entries([("name", name), ("length", length), ("start", start)])
                for start, length in free_pieces(left - wanted, order)
            ]
        if entries:
            lines = ("add:", "  signals:", *(f"    - {{{each}}}" for each in entries))
            yield Step(path, "\n".join(lines))

    def _rows_gone(self, row: MessageRow, gone: list[Signal]) -> Iterator[Step]:
        """Rows of tables go along with the only signal that they explain."""
        for signal in gone:
            for table, explained in self._explained[row.name, signal.name]:
                if self._users[id(explained)] == 1:
                    yield Step(f"tables/{table.stem}", f"remove: {{rows: [{explained.no}]}}")

    def _order(self, row: MessageRow) -> ByteOrder:
        return ByteOrder(row.byte_order or self._spec.messages.byte_order)

    def _scales(self, row: MessageRow, pairs: Iterable[tuple[Signal, Signal]]) -> None:
        deviation = Deviation(f"{row.name}, scales and ranges")
        for ours, theirs in pairs:
            keys = list(scale_keys(ours, theirs))
            what = ", ".join(f"{name} {new}" for name, _, new in keys)
            for path, record in self._paths(row.name, ours, what):
                changed = [key for key in keys if has_otherwise(record, *key)]
                if changed:
                    text = f"set: {{{flow_entries((name, new) for name, _, new in changed)}}}"
                    was = ", ".join(f"{name} {old}" for name, old, _ in changed)
                    now = ", ".join(f"{name} {new}" for name, _, new in changed)
                    deviation.add(f"{ours.name} {was}", f"{ours.name} {now}", Step(path, text))
            if (ours.signed, ours.is_float) != (theirs.signed, theirs.is_float):
                kind = "float" if theirs.is_float else ("unsigned", "signed")[theirs.signed]
                step = Step(f"messages/{row.name}/{ours.name}", f"set: {{type: {kind}}}")
                deviation.add(f"{ours.name} of another type", f"{ours.name} {kind}", step)
        self._keep(deviation)

    def _paths(self, message: str, ours: Signal, what: str) -> Iterator[tuple[str, SignalRow]]:
        """The rows that explain the signal; where other signals share one, that is noted."""
        for table, row in self._explained[message, ours.name] if what else []:
            if self._users[id(row)] > 1:
                text = f"{message}.{ours.name}: the file has {what}; its row in {table.stem}"
                self.findings.notes.append(f"{text} explains other signals too")
            else:
                yield f"tables/{table.stem}/{row.no}", row

    def _codes(self, message: MessageRow, ours: Signal, theirs: Signal) -> None:
        deviation = Deviation(f"{message.name}, codes of {ours.name}")
        for path, row in list(self._paths(message.name, ours, _codes_text(theirs))):
            new = new_codes(row, theirs, self.states)
            if new is None:
                continue
            pairs: list[tuple[str, object]] = [("codes", new.labels)]
            if new.english != row.english_codes:
                pairs.append(("english_codes", new.english))
            deviation.add(
                _labels(row.labels, new.changed) or "no such codes",
                _labels(new.labels, (*new.changed, *new.added)),
                Step(path, f"set: {{{flow_entries(pairs)}}}"),
            )
            if ours.acting and len(deviation.steps) == 1:
                self._acts(message, ours, moved(ours.acting, row, new), deviation)
            if new.changed:
                codes = ", ".join(map(str, new.changed))
                text = f"Codes {codes} of {ours.name} mean something else than in the standard."
                self.findings.warnings.append(text)
        self._keep(deviation)

    def _acts(
        self, message: MessageRow, ours: Signal, acting: ActingCodes | None, deviation: Deviation
    ) -> None:
        """Codes that act move along with their labels."""
        names = {ours.name, f"{message.name}.{ours.name}"}
        listed = next(each for each in self._spec.behaviour.acts if each.signal in names)
        if acting is None:
            text = f"{ours.name}: a code that acts is not to be told by its label: settle acts by"
            self.findings.warnings.append(f"{text} hand before anything is driven.")
            return
        pairs = [("codes", acting.codes), ("safe", acting.safe)]
        changed = [pair for pair in pairs if pair[1] != getattr(listed, pair[0])]
        if changed:
            deviation.add(
                f"acts at {', '.join(map(str, listed.codes))}, safe {listed.safe}",
                f"acts at {', '.join(map(str, acting.codes))}, safe {acting.safe}",
                Step(f"behaviour/acts/{listed.signal}", f"set: {{{flow_entries(changed)}}}"),
            )


def _labels(labels: Mapping[int, str], codes: Iterable[int]) -> str:
    return ", ".join(f"{code} {labels[code]}" for code in sorted(codes))


def _codes_text(signal: Signal) -> str:
    """The codes of a signal in short, for a note."""
    codes = signal.value_table.codes if signal.value_table else ()
    return ", ".join(f"{code.value} {code.label.strip()}" for code in codes)


def _names(signals: Iterable[Signal]) -> str:
    return ", ".join(f"{signal.name} at {signal.start}|{signal.length}" for signal in signals) or (
        "nothing"
    )


def _with_own_names(signals: Iterable[Signal], taken: set[str]) -> tuple[Signal, ...]:
    """The signals with names that the message does not have yet."""
    named: list[Signal] = []
    for signal in signals:
        name, count = signal.name, 1
        while name in taken:
            count += 1
            name = f"{signal.name}_{count}"
        taken.add(name)
        named.append(replace(signal, name=name))
    return tuple(named)


def _signal_of(row: FieldRow, order: ByteOrder) -> Signal:
    """The place of a reserved field, for its bits."""
    return Signal(
        name=row.name,
        start=row.start or 0,
        length=row.length or 1,
        byte_order=ByteOrder(row.byte_order) if row.byte_order else order,
        minimum=Decimal(0),
        maximum=Decimal(1),
    )
