"""Corrected rows to the model: joins layout and meaning, and insists that nothing is missing."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from dataclasses import fields
from decimal import Decimal
from typing import TypeVar

from dbcspec.errors import Fault, SpecError
from dbcspec.spec.behaviour_names import unknown_names
from dbcspec.spec.readings import ReadErratum, usual_readings
from dbcspec.spec.resolve_acts import acting_codes
from dbcspec.spec.resolve_database import with_database
from dbcspec.spec.resolve_protection import filled_in, protected
from dbcspec.spec.resolve_standard import (
    errata_of,
    joined,
    nodes_of,
    row_reference,
    table_reference,
)
from dbcspec.spec.rows import FieldRow, MessageRow, SignalRow, Spec
from dbcspec.spec.schema import Record
from dbcspec.spec.value_tables import ValueTables
from typedcan.model import protocol as model
from typedcan.model.acting import usual_start
from typedcan.model.layout import bits, float_limits
from typedcan.model.naming import field_name, shared_prefix
from typedcan.model.transfer import Transfer
from typedcan.model.transfers.registry import usual_kind

T = TypeVar("T")

_FD = "_FD"
"""How frame formats of CAN FD end."""

_SEND_TYPES = {
    "Cyclic": model.SendType.CYCLIC,
    "IfActive": model.SendType.IF_ACTIVE,
    "Event": model.SendType.EVENT,
}


def resolve(
    spec: Spec, name: str, errata: Iterable[ReadErratum] | None = None, chosen: str = ""
) -> model.Protocol:
    """Build the protocol called ``name``; raises `SpecError` with everything that is missing.

    ``errata`` are those in force, where they are not the usual ones, and ``chosen`` names them.

    A signal that no table explains is left out, and names of nodes are taken as they stand: the
    linter reports both.
    """
    resolver = _Resolver(spec, chosen=bool(chosen))
    read = usual_readings(spec) if errata is None else errata
    resolved = with_database(resolver.protocol(name), spec.database, resolver.faults)
    protocol = dataclasses.replace(resolved, errata=errata_of(read), chosen=chosen)
    if resolver.faults:
        raise SpecError(resolver.faults)
    return protocol


class _Resolver:
    def __init__(self, spec: Spec, *, chosen: bool) -> None:
        self._spec = spec
        self.faults: list[Fault] = []
        self._aliases = {
            alias: node.name for node in spec.standard.nodes for alias in (node.name, *node.aliases)
        }
        self._explained = spec.explanations()
        self._value_tables = ValueTables(spec, self.faults, chosen=chosen)
        self._conditions = {
            message: timing.condition
            for timing in spec.behaviour.timing
            for message in timing.messages
        }
        self._acting = acting_codes(spec, self.faults)
        self._units = spec.standard.units
        self._frame_format = spec.standard.frame_format or "ExtendedCAN"

    def protocol(self, name: str) -> model.Protocol:
        standard = self._spec.standard
        messages = tuple(self._message(row) for row in self._spec.messages.messages)
        self.faults += unknown_names(self._spec, messages)
        return model.Protocol(
            name=name,
            number=standard.number,
            title=joined(standard.title, standard.part_title),
            english=joined(standard.english, standard.part_english),
            edition=standard.edition,
            nodes=nodes_of(standard),
            buses=tuple(
                model.Bus(
                    name=bus.name,
                    title=bus.title,
                    english=bus.english,
                    bit_rate=self._given(bus, "bit_rate", bus.bit_rate, 0),
                    nodes=bus.nodes,
                    errata=bus.marks,
                )
                for bus in standard.buses
            ),
            messages=messages,
            value_tables=self._value_tables.used(),
            transfers=tuple(self._transfers()),
            requests=tuple(
                model.Request(
                    signal=row.signal, code=row.code, withdraw=row.withdraw, answers=row.answers
                )
                for row in self._spec.behaviour.requests
            ),
        )

    def _given(self, record: Record, key: str, value: T | None, instead: T) -> T:
        """The value, or a fault that it is missing."""
        if value is None:
            text = f"{record.identity}: {key} is missing, and no erratum gives it"
            self.faults.append(Fault(record.where_is(key), text))
            return instead
        return value

    def _message(self, row: MessageRow) -> model.Message:
        fields = [field for field in row.signals if field.name not in self._spec.standard.reserved]
        prefixes = (*row.prefixes, f"{row.name}_", shared_prefix([field.name for field in fields]))
        filled = filled_in(self._spec)
        signals = tuple(
            self._signal(
                row, field, prefixes, filled.get(f"{row.name}.{field.name}", filled.get(field.name))
            )
            for field in fields
            if self._explained[row.name, field.name]
        )
        explained = [
            entry for field in fields for entry in self._explained[row.name, field.name][:1]
        ]
        routes = [signal_row.route for _, signal_row in explained if signal_row.route]
        tables = {id(table): table for table, _ in explained}.values()
        period = self._given(row, "period", row.period, 0)
        message = model.Message(
            name=row.name,
            title=" + ".join(table.title for table in tables),
            english=row.english,
            frame_id=row.id,
            extended=self._is_extended(row),
            length=self._given(row, "length", row.length, 8),
            is_fd=self._is_fd(row),
            by_pgn=self._is_by_pgn(row),
            bit_rate_switch=self._is_fd(row) and row.bit_rate_switch == "yes",
            sender=self._node(row.sender or (routes[0][0] if routes else "")),
            other_senders=tuple(map(self._node, row.other_senders)),
            period=period or None,
            send_type=_SEND_TYPES[self._given(row, "type", row.type, "Event")],
            condition=self._conditions.get(row.name, ""),
            signals=signals,
            reserved=(*self._reserved(row), *self._unassigned(row, signals)),
            reference=", ".join(
                (row.annex or self._spec.messages.annex, *map(table_reference, tables))
            ),
            errata=row.marks,
            where=row.where,
        )
        return protected(message, self._spec, self.faults)

    def _reserved(self, message: MessageRow) -> Iterator[model.ReservedBits]:
        padding = self._spec.behaviour.padding
        cited = (message.annex or self._spec.messages.annex, padding.cite if padding else "")
        for field in message.signals:
            if field.name in self._spec.standard.reserved:
                yield model.ReservedBits(
                    start=self._given(field, "start", field.start, 0),
                    length=self._given(field, "length", field.length, 1),
                    byte_order=self._byte_order(message, field),
                    value=(padding.reserved or 0) if padding else 0,
                    reference=", ".join(filter(None, cited)),
                )

    def _unassigned(
        self, row: MessageRow, signals: tuple[model.Signal, ...]
    ) -> Iterator[model.ReservedBits]:
        """Bits that no field names, where they are sent as 1."""
        padding = self._spec.behaviour.padding
        if not (padding and padding.unassigned):
            return
        named: tuple[model.Signal | model.ReservedBits, ...] = (*signals, *self._reserved(row))
        taken = {bit for each in named for bit in bits(each)}
        start = 0
        for bit in range(8 * (row.length or 0) + 1):
            if bit in taken or bit == 8 * (row.length or 0):
                if bit > start:
                    yield model.ReservedBits(
                        start=start, length=bit - start, value=1, reference=padding.cite
                    )
                start = bit + 1

    def _byte_order(self, message: MessageRow, field: FieldRow) -> model.ByteOrder:
        return model.ByteOrder(
            field.byte_order or message.byte_order or self._spec.messages.byte_order
        )

    def _is_extended(self, row: MessageRow) -> bool:
        if row.extended:
            return row.extended == "yes"
        return not self._frame_format.startswith("StandardCAN")

    def _is_fd(self, row: MessageRow) -> bool:
        return row.fd == "yes" if row.fd else self._frame_format.endswith(_FD)

    def _is_by_pgn(self, row: MessageRow) -> bool:
        said = row.by_pgn == "yes" if row.by_pgn else self._frame_format == "J1939PG"
        return said and self._is_extended(row) and not self._is_fd(row)

    def _node(self, printed: str) -> str:
        return self._aliases.get(printed, printed)

    def _signal(
        self, message: MessageRow, field: FieldRow, prefixes: Iterable[str], filled: int | None
    ) -> model.Signal:
        rows = self._explained[message.name, field.name]
        row = rows[0][1]
        length = self._given(field, "length", field.length, 1)
        is_float = field.type == "float"
        any_float = float_limits(length) if is_float else None
        low, high = self._given(row, "range", row.range or any_float, (Decimal(0), Decimal(1)))
        receivers = self._given(row, "route", row.route, ("", ()))[1]
        factor = self._given(row, "factor", row.factor, Decimal(1))
        if not factor:
            self.faults.append(Fault(row.where_is("factor"), f"{row.name}: factor is 0"))
            factor = Decimal(1)
        value_table = self._value_tables.of(row)
        standard = self._spec.standard
        invalid_codes = _labelled(row, standard.invalid_labels)
        invalid = invalid_codes[0] if invalid_codes else None
        acting = self._acting.get(f"{message.name}.{field.name}") or self._acting.get(field.name)
        usual = usual_start(invalid, acting) if filled is None else filled
        unit = self._given(row, "unit", row.unit, "")
        marks = dict.fromkeys(
            mark for record in (field, *(row for _, row in rows)) for mark in record.marks
        )
        return model.Signal(
            name=field.name,
            title=row.title,
            english=row.english,
            start=self._given(field, "start", field.start, 0),
            length=length,
            byte_order=self._byte_order(message, field),
            signed=field.type != "unsigned",
            is_float=is_float,
            factor=factor,
            offset=self._given(row, "offset", row.offset, Decimal(0)),
            minimum=low,
            maximum=high,
            unit=self._units.get(unit, unit),
            value_table=value_table,
            invalid_code=invalid,
            other_invalid_codes=tuple(invalid_codes[1:]),
            abnormal_code=next(iter(_labelled(row, standard.abnormal_labels)), None),
            start_value=usual if field.initial is None else field.initial,
            acting=acting,
            receivers=tuple(map(self._node, receivers)),
            is_selector=field.selector == "yes",
            multiplexer=field.multiplexer,
            selectors=field.selectors,
            python_name=field.field or field_name(field.name, prefixes),
            reference=", ".join(row_reference(*entry) for entry in rows),
            errata=tuple(sorted(marks)),
            where=field.where,
        )

    def _transfers(self) -> Iterable[Transfer]:
        for row in self._spec.behaviour.transfers:
            facts = {part.name: getattr(row, part.name) for part in fields(Transfer)}
            facts["kind"] = row.kind or usual_kind(group=row.group, frame_number=row.frame_number)
            yield Transfer(**facts)


def _labelled(row: SignalRow, labels: tuple[str, ...]) -> list[int]:
    """The codes that have such a label, as printed or in English."""
    english = row.english_codes
    return [code for code, label in row.labels.items() if {label, english.get(code)} & {*labels}]
