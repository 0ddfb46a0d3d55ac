"""Writes the differences of two models into the YAML of a spec, each value in its place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from dbcspec.compare.pairing import MessagePair, SignalPair, pair
from dbcspec.spec.differences import ACTS, Difference, differences
from dbcspec.spec.rows import MessageRow, SignalRow, SignalTable, Spec
from dbcspec.spec.schema import Record, keys_of
from dbcspec.spec.splice import YamlText, scalar
from dbcspec.spec.text import (
    SEND_TYPES,
    acts_entry,
    acts_values,
    labels_of,
    message_entry,
    row_values,
    settled,
    signal_row,
)
from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Message, Protocol, Signal

_MESSAGES, _BEHAVIOUR = "messages.yaml", "behaviour.yaml"
_TITLES = "the captions of its tables make it"
_Path = tuple[str | int, ...]
T = TypeVar("T")


class SpecWriter:
    """Collects the changes of all files.

    Parameters
    ----------
    folder
        The spec.
    printed, corrected
        Its rows before and after the errata.
    old, new
        The model that it makes, and the one that it shall make.
    """

    def __init__(
        self, folder: Path, printed: Spec, corrected: Spec, old: Protocol, new: Protocol
    ) -> None:
        self._folder = folder
        self._printed = printed
        self._corrected = corrected
        self._old = old
        self._new = new
        self._files: dict[str, YamlText] = {}
        self._reasons: dict[tuple[str, str], str] = {}
        self._next_number: dict[int, int] = {}
        self._acts_done: set[str] = set()
        self._settled = dict(settled(printed.errata))
        self._units = {plain: unit for unit, plain in reversed([*printed.standard.units.items()])}

    def write(self) -> dict[str, bytes]:
        """The bytes of every file that changes."""
        pairing = pair(self._old, self._new)
        changed: dict[tuple[str, str], dict[str, Difference]] = {}
        for each in differences(self._old, self._new):
            changed.setdefault((each.message, each.signal), {})[each.what] = each
        for messages in pairing.messages:
            self._message(messages, changed.get((messages.old.name, ""), {}))
            for signals in messages.signals:
                key = (messages.old.name, signals.old.name)
                self._signal(signals, changed.get(key, {}))
            for signal in messages.added:
                self._add_signal(messages.old, messages.new, signal)
        for message in pairing.added:
            self._add_message(message)
        self._references({new.name: new for _, new in self._new.signals()}, changed)
        return {name: text.result() for name, text in self._files.items() if text.is_changed}

    def explained(self, left: Difference) -> str:
        """A difference that stays, with the reason where there is one."""
        reason = self._reasons.get((left.signal or left.message, left.what), "")
        return f"{left}{f': {reason}' if reason else ''}"

    def _file(self, name: str) -> YamlText:
        if name not in self._files:
            self._files[name] = YamlText((self._folder / name).read_bytes())
        return self._files[name]

    def _set(
        self, file: str, path: _Path, records: tuple[Record | None, Record], key: str, value: str,
        subject: tuple[str, str, str],
    ) -> None:  # fmt: skip
        """Set one key of one record, unless an erratum has settled it."""
        if self._is_free(records, key, subject):
            self._file(file).set(path, key, value, list(keys_of(type(records[1]))))

    def _is_free(
        self, records: tuple[Record | None, Record], key: str, subject: tuple[str, str, str]
    ) -> bool:
        """Whether the record says what is printed; ``subject`` is address, name and difference."""
        printed, corrected = records
        address, name, what = subject
        erratum = self._settled.get((address, key))
        if printed is None or getattr(printed, key) != getattr(corrected, key):
            erratum = erratum or ", ".join(corrected.marks)
        if erratum is None:
            return True
        reason = f"{address}: erratum {erratum} settles {key}; change the erratum"
        self._reasons[name, what] = reason
        return False

    def _message(self, messages: MessagePair, changed: Mapping[str, Difference]) -> None:
        index, row = self._message_row(messages.old.name)
        self._reasons[row.name, "title"] = _TITLES
        printed = _at(self._printed.messages.messages, index)
        new = messages.new
        for what, key, value in (
            ("identifier", "id", f"0x{new.frame_id:0{8 if new.extended else 3}X}"),
            ("English title", "english", scalar(new.english)),
            ("length", "length", str(new.length)),
            ("send type", "type", SEND_TYPES[new.send_type]),
            ("period", "period", str(new.period or 0)),
        ):
            if what in changed:
                subject = (f"messages/{row.name}", row.name, what)
                path = ("messages", index)
                self._set(_MESSAGES, path, (printed, row), key, value, subject)

    def _message_row(self, name: str) -> tuple[int, MessageRow]:
        rows = self._corrected.messages.messages
        return next((index, row) for index, row in enumerate(rows) if row.name == name)

    def _signal(self, signals: SignalPair, changed: Mapping[str, Difference]) -> None:
        self._layout(signals, changed)
        sender, new_unit = signals.new_message.sender, signals.new.unit
        unit = self._units.get(new_unit, new_unit)
        for count, (table_index, row_index, row) in enumerate(self._rows(signals.old.name)):
            table = self._corrected.tables[table_index]
            printed_table = _at(self._printed.tables, table_index)
            printed = _at(printed_table.rows, row_index) if printed_table else None
            address = f"tables/{table.stem}/{row.no}"
            path = ("rows", row_index)
            for what, key, value in row_values(sender, signals.new, unit):
                # Only the first row's titles count; another table may say it in other words.
                if what in changed and (key not in ("title", "english") or count == 0):
                    subject = (address, signals.old.name, what)
                    self._set(_file_of(table), path, (printed, row), key, value, subject)
            if "codes" in changed:
                subject = (address, signals.old.name, "codes")
                self._codes(_file_of(table), path, (printed, row), signals.new, subject)
        if ACTS in changed:
            self._acts(signals)

    def _layout(self, signals: SignalPair, changed: Mapping[str, Difference]) -> None:
        """Start and length in the annex."""
        message_index, message = self._message_row(signals.old_message.name)
        printed_message = _at(self._printed.messages.messages, message_index)
        for index, row in enumerate(message.signals):
            if row.name != signals.old.name:
                continue
            printed = _at(printed_message.signals, index) if printed_message else None
            address = f"messages/{message.name}/{row.name}"
            path = ("messages", message_index, "signals", index)
            for what, value in (("start", signals.new.start), ("length", signals.new.length)):
                if what in changed:
                    subject = (address, row.name, what)
                    self._set(_MESSAGES, path, (printed, row), what, str(value), subject)

    def _acts(self, signals: SignalPair) -> None:
        """The codes that act: what differs in their row, or a row of their own."""
        old, new, signal = signals.old.acting, signals.new.acting, signals.old.name
        rows = {
            row.signal: (index, row) for index, row in enumerate(self._corrected.behaviour.acts)
        }
        full = f"{signals.old_message.name}.{signal}"
        name = full if full in rows else signal
        if new is None:
            self._reasons[signal, ACTS] = f"delete the row of {name} in {_BEHAVIOUR} by hand"
        elif old and name not in self._acts_done:
            # Signals of several messages may share a row: what one of them says is written.
            self._acts_done.add(name)
            index, row = rows[name]
            records = (_at(self._printed.behaviour.acts, index), row)
            was, subject = acts_values(old), (f"behaviour/acts/{name}", signal, ACTS)
            for key, value in acts_values(new).items():
                if value != was[key]:
                    self._set(_BEHAVIOUR, ("acts", index), records, key, value, subject)
        elif old is None:
            self._add_acts(signals.old_message.name, signal, new)

    def _add_acts(self, message: str, signal: str, acting: ActingCodes) -> None:
        """A row for a signal, with its message where others have one of that name."""
        if self._printed.behaviour.acts:
            repeated = [each.name for _, each in self._new.signals()].count(signal) > 1
            entry = acts_entry(f"{message}.{signal}" if repeated else signal, acting)
            self._file(_BEHAVIOUR).append(("acts",), entry)
        else:
            self._reasons[signal, ACTS] = f"{_BEHAVIOUR} has no acts: write the first row by hand"

    def _rows(self, name: str) -> Iterator[tuple[int, int, SignalRow]]:
        """Every row of a signal with its places."""
        for table_index, table in enumerate(self._corrected.tables):
            for row_index, row in enumerate(table.rows):
                if row.name == name:
                    yield table_index, row_index, row

    def _codes(
        self, file: str, path: _Path, records: tuple[SignalRow | None, SignalRow], new: Signal,
        subject: tuple[str, str, str],
    ) -> None:  # fmt: skip
        if self._file(file).reference(path, "codes") or not self._is_free(
            records, "codes", subject
        ):
            return
        self._set_codes(file, path, new)

    def _set_codes(self, file: str, path: _Path, new: Signal) -> None:
        order = list(keys_of(SignalRow))
        labels, english = labels_of(new)
        self._file(file).set_codes(path, "codes", labels, order)
        self._file(file).set_codes(path, "english_codes", english, order)

    def _references(
        self,
        wanted: Mapping[str, Signal],
        changed: Mapping[tuple[str, str], Mapping[str, Difference]],
    ) -> None:
        """A row that refers to another's codes gets its own where the two now differ."""
        names = {signal for (_, signal), each in changed.items() if "codes" in each}
        tables = (table for table in self._corrected.tables if names & {r.name for r in table.rows})
        for table in tables:
            for index, row in enumerate(table.rows):
                file, path = _file_of(table), ("rows", index)
                here = wanted.get(row.name)
                there = wanted.get(self._file(file).reference(path, "codes") or "")
                if here and there and labels_of(here) != labels_of(there):
                    printed = next(each for each in self._printed.tables if each.stem == table.stem)
                    subject = (f"tables/{table.stem}/{row.no}", row.name, "codes")
                    if self._is_free((_at(printed.rows, index), row), "codes", subject):
                        self._set_codes(file, path, here)

    def _add_signal(self, old: Message, new: Message, signal: Signal) -> None:
        index, _ = self._message_row(old.name)
        field = {"name": signal.name, "length": str(signal.length), "start": str(signal.start)}
        self._file(_MESSAGES).append(("messages", index, "signals"), field)
        names = {each.name for each in old.signals}
        table_index = max(
            (place for name in names for place, _, _ in self._rows(name)),
            default=len(self._corrected.tables) - 1,
        )
        self._add_row(table_index, new, signal)

    def _add_row(self, table_index: int, message: Message, signal: Signal) -> None:
        table = self._corrected.tables[table_index]
        number = self._next_number.get(table_index, max(row.no for row in table.rows) + 1)
        self._next_number[table_index] = number + 1
        unit = self._units.get(signal.unit, signal.unit)
        row = signal_row(number, message.sender, signal, unit)
        self._file(_file_of(table)).append(("rows",), row)
        if signal.acting:
            self._add_acts(message.name, signal.name, signal.acting)

    def _add_message(self, message: Message) -> None:
        """Append a message; its rows go to the last table with the same sender, else the last."""
        self._reasons[message.name, "title"] = _TITLES
        entry = message_entry(message)
        self._file(_MESSAGES).append(("messages",), entry)
        tables = self._corrected.tables
        table_index = max(
            (
                index
                for index, table in enumerate(tables)
                if any(row.route and row.route[0] == message.sender for row in table.rows)
            ),
            default=len(tables) - 1,
        )
        for signal in message.signals:
            self._add_row(table_index, message, signal)


def _at(items: Sequence[T], index: int) -> T | None:
    return items[index] if index < len(items) else None


def _file_of(table: SignalTable) -> str:
    return f"tables/{table.stem}.yaml"
