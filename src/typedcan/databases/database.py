"""What cantools has read to the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

from cantools.database.can import Database
from cantools.database.can import Message as CantoolsMessage
from cantools.database.can import Node as CantoolsNode
from cantools.database.can import Signal as CantoolsSignal

from typedcan.databases.extras import Extras, groups_of
from typedcan.databases.protection import protected
from typedcan.databases.scaling import limits, scaling, start_value
from typedcan.databases.value_tables import ValueTables, codes_labelled, codes_of
from typedcan.model import protocol as model
from typedcan.model.errors import Location, ReadError
from typedcan.model.naming import field_name, field_names, shared_prefix

INVALID_LABELS = frozenset(
    {"signal invalid", "invalid", "sna", "signal not available", "not available", "信号无效"}
)
"""Labels, in small letters, of the code that says that there is no valid value."""

ABNORMAL_LABELS = frozenset({"abnormal"})
"""Labels, in small letters, of the code that says that the value is abnormal."""

_NOBODY = "Vector__XXX"
_LONGEST_PERIOD = 1 << 32
"""Milliseconds; what is longer is no number that a clock can count to."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Labels:
    """The labels, in small letters, of codes that are no values."""

    invalid: frozenset[str] = INVALID_LABELS
    abnormal: frozenset[str] = ABNORMAL_LABELS


@dataclass(frozen=True, slots=True)
class Places:
    """Where a message and its signals, in their order, stand."""

    message: Location
    signals: Sequence[Location]
    short_names: Sequence[str] = ()
    """The names of the signals in the file, where the attributes give longer ones."""


def to_protocol(
    database: Database, file: str, places: Sequence[Places], labels: Labels
) -> model.Protocol:
    """The model of a database; ``places`` has those of its messages, in their order.

    ``file`` is what errors call it; its stem is the protocol's name where the file has none.
    Raises `ReadError` for numbers that no signal can have.
    """
    builder = _Builder(database, file, labels)
    return builder.protocol(places)


class _Builder:
    def __init__(self, database: Database, file: str, labels: Labels) -> None:
        self._database = database
        self._file = file
        self._labels = labels
        self._defined = dict(database.dbc.attribute_definitions) if database.dbc else {}
        self._attributes = dict(database.dbc.attributes) if database.dbc else {}
        self._extras = Extras(database)
        named = database.dbc.value_tables if database.dbc else {}
        self._value_tables = ValueTables({name: codes_of(table) for name, table in named.items()})

    def protocol(self, places: Sequence[Places]) -> model.Protocol:
        database = self._database
        bus = next(iter(database.buses), None)
        named = (bus.name if bus else "") or PurePath(self._file).stem
        english, title = _texts(bus.comment if bus else None)
        nodes = tuple(self._node(node) for node in database.nodes)
        messages = tuple(
            self._message(message, place)
            for message, place in zip(database.messages, places, strict=True)
        )
        return model.Protocol(
            name=named,
            title=title,
            english=english,
            nodes=nodes,
            buses=tuple(
                model.Bus(
                    name=bus.name or named,
                    bit_rate=int(bus.baudrate),
                    nodes=tuple(node.name for node in nodes),
                )
                for bus in database.buses
                if bus.baudrate
            ),
            messages=messages,
            value_tables=self._value_tables.all(),
            version=database.version or "" if database.dbc else "",
            definitions=self._extras.definitions,
            attributes=self._extras.of_database(),
            variables=tuple(self._extras.variables()),
            carries=self._carries(messages),
            made_from=self._made_from(),
        )

    def _made_from(self) -> str:
        digest = self._attributes.get("SpecDigest")
        return str(digest.value) if digest else ""

    def _carries(self, messages: Sequence[model.Message]) -> frozenset[model.Aspect]:
        aspect = model.Aspect
        signals = [signal for message in self._database.messages for signal in message.signals]
        comments = [
            *(message.comment() + message.title for message in messages),
            *(signal.english + signal.title for message in messages for signal in message.signals),
        ]
        said = {
            aspect.PERIODS: "GenMsgCycleTime" in self._defined
            or any(message.cycle_time for message in self._database.messages),
            aspect.START_VALUES: "GenSigStartValue" in self._defined
            or any(signal.raw_initial is not None for signal in signals),
            aspect.COMMENTS: any(comments),
            aspect.REFERENCES: "SpecReference" in self._defined,
            aspect.ADDRESSES: "NmStationAddress" in self._defined,
            aspect.VALUE_TABLE_NAMES: self._value_tables.named,
            aspect.FRAME_FORMATS: "VFrameFormat" in self._defined
            or any(message.is_fd or message.by_pgn for message in messages),
            aspect.ATTRIBUTES: self._database.dbc is not None,
        }
        return frozenset(each for each, is_said in said.items() if is_said)

    def _node(self, node: CantoolsNode) -> model.Node:
        english, title = _texts(node.comment)
        address = _attribute(node, "NmStationAddress")
        return model.Node(
            name=node.name,
            title=title,
            english=english,
            address=int(address) if isinstance(address, int | float) else None,
            attributes=self._extras.attributes(_attributes(node)),
        )

    def _message(self, message: CantoolsMessage, places: Places) -> model.Message:
        english, title = _texts(message.comment)
        period = round(min(message.cycle_time or 0, 2 * _LONGEST_PERIOD))
        if period > _LONGEST_PERIOD:
            raise ReadError(f"{places.message}: {message.name}: no cycle time is so long")
        prefixes = (f"{message.name}_", shared_prefix([each.name for each in message.signals]))
        # cantools gives signals their long names, but leaves the short one where they select.
        long = dict(zip(places.short_names, (each.name for each in message.signals), strict=False))
        # Some files do not mark what selects.
        selecting = {each.multiplexer_signal for each in message.signals if each.multiplexer_ids}
        selecting = {long.get(name, name) for name in selecting if name}
        fields = field_names(field_name(signal.name, prefixes) for signal in message.signals)
        senders = [name for name in dict.fromkeys(message.senders) if name != _NOBODY]
        is_fd = message.is_fd or self._needs_fd(message)
        found = model.Message(
            name=message.name,
            title=title,
            english=english,
            frame_id=message.frame_id,
            extended=message.is_extended_frame,
            length=message.length,
            is_fd=is_fd,
            bit_rate_switch=is_fd and self._switches(message),
            by_pgn=self._is_by_pgn(message),
            sender=senders[0] if senders else "",
            other_senders=tuple(senders[1:]),
            period=period if period > 0 else None,
            send_type=_send_type(message, period),
            signals=tuple(
                self._signal(signal, python_name, place, long, selecting)
                for signal, python_name, place in zip(
                    message.signals, fields, places.signals, strict=True
                )
            ),
            groups=groups_of(message),
            attributes=self._extras.attributes(_attributes(message)),
            relations=tuple(self._extras.relations(message)),
            reference=str(_attribute(message, "SpecReference") or ""),
            errata=tuple(str(_attribute(message, "SpecErrata") or "").split()),
            where=places.message,
        )
        return protected(found, message)

    def _is_by_pgn(self, message: CantoolsMessage) -> bool:
        """Whether the file says that it is a parameter group of J1939, or that all of them are."""
        named = message.protocol == "j1939"
        if "VFrameFormat" not in self._defined and "ProtocolType" in self._defined:
            value = self._attributes.get("ProtocolType")
            default = self._defined["ProtocolType"].default_value
            named = "J1939" in str(value.value if value else default)
        return named and message.is_extended_frame

    def _needs_fd(self, message: CantoolsMessage) -> bool:
        """Whether only CAN FD can carry a message of a file that says nothing of it."""
        silent = "VFrameFormat" not in self._defined and message.protocol is None
        return silent and model.LONGEST_CLASSIC < message.length <= model.FD_LENGTHS[-1]

    def _switches(self, message: CantoolsMessage) -> bool:
        """Whether the payload has the second bit rate; where no attribute says it, it has."""
        definition, value = self._defined.get("CANFD_BRS"), _attribute(message, "CANFD_BRS")
        if definition and value is None:
            value = definition.default_value
        elif definition and definition.choices and isinstance(value, int):
            value = dict(enumerate(definition.choices)).get(value)
        return str(value).lower() not in ("0", "no", "off")

    def _signal(
        self,
        signal: CantoolsSignal,
        python_name: str,
        where: Location,
        long: Mapping[str, str],
        selecting: Set[str | None],
    ) -> model.Signal:
        english, title = _texts(signal.comment)
        codes = codes_of(signal.choices or {})
        factor, offset = scaling(signal)
        selector = signal.multiplexer_signal or ""
        low, high = limits(signal, factor, offset)
        start = start_value(signal, self._defined)
        invalid = codes_labelled(codes, self._labels.invalid, start)
        abnormal = codes_labelled(codes, self._labels.abnormal, start)
        return model.Signal(
            name=signal.name,
            title=title,
            english=english,
            start=signal.start,
            length=signal.length,
            byte_order=(
                model.ByteOrder.INTEL
                if signal.byte_order == "little_endian"
                else model.ByteOrder.MOTOROLA
            ),
            # A float has a sign, whatever its line says.
            signed=signal.is_signed or signal.conversion.is_float,
            is_float=signal.conversion.is_float,
            factor=factor,
            offset=offset,
            minimum=low,
            maximum=high,
            unit=signal.unit or "",
            value_table=self._value_tables.of(signal.name, codes) if codes else None,
            invalid_code=invalid[0] if invalid else None,
            other_invalid_codes=invalid[1:],
            abnormal_code=abnormal[0] if abnormal else None,
            start_value=start,
            receivers=tuple(name for name in signal.receivers if name != _NOBODY),
            is_selector=signal.is_multiplexer or signal.name in selecting,
            multiplexer=long.get(selector, selector) if signal.multiplexer_ids else "",
            selectors=tuple(sorted(signal.multiplexer_ids or ())) if selector else (),
            python_name=python_name,
            attributes=self._extras.attributes(_attributes(signal)),
            reference=str(_attribute(signal, "SpecReference") or ""),
            errata=tuple(str(_attribute(signal, "SpecErrata") or "").split()),
            where=where,
        )


def _texts(comment: str | None) -> tuple[str, str]:
    """A comment as English text and as title in the language of the standard.

    Text with Chinese, Japanese or Korean characters is a title, any other counts as English.
    """
    text = (comment or "").strip()
    is_title = any("\u2e80" <= letter <= "\ud7a3" for letter in text)
    return ("", text) if is_title else (text, "")


def _attribute(item: CantoolsNode | CantoolsMessage | CantoolsSignal, name: str) -> object:
    """The value of an attribute of a node, message or signal, None where it has none."""
    attributes = _attributes(item)
    return attributes[name].value if name in attributes else None


def _attributes(item: CantoolsNode | CantoolsMessage | CantoolsSignal) -> Mapping[str, Any]:
    return item.dbc.attributes if item.dbc else {}


def _send_type(message: CantoolsMessage, period: int) -> model.SendType:
    """By the word of GenMsgSendType, else by whether there is a period."""
    word = (message.send_type or "").lower()
    if not word:
        return model.SendType.CYCLIC if period > 0 else model.SendType.EVENT
    if "ifactive" in word:
        return model.SendType.IF_ACTIVE
    return model.SendType.CYCLIC if word.startswith("cyclic") else model.SendType.EVENT
