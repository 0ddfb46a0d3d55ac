"""The reference codec, cantools and the typed messages must agree on every payload."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from enum import IntEnum
from pathlib import Path

import cantools
import pytest
from cantools.database.can import Database
from cantools.database.can import Message as CantoolsMessage
from hypothesis import given
from hypothesis import strategies as st
from oracles import reference_codec as reference

import swapcan
from swapcan import Codec, EncodeError, SignalState, message_type
from swapcan.messages import MESSAGES
from typedcan.model.protocol import Message, Protocol, Signal
from typedcan.wire.fields import PhysicalField

NAMES = [message.NAME for message in MESSAGES]
PAYLOADS = st.binary(min_size=8, max_size=8)
every_message = pytest.mark.parametrize("name", NAMES)


@pytest.fixture(scope="module", params=[True, False], ids=["straight", "formats"])
def codec(request: pytest.FixtureRequest) -> Codec:
    """By generated functions, and by cantools' formats and the fields."""
    return Codec(accelerated=request.param)


@pytest.fixture(scope="module")
def dbc(root: Path) -> Database:
    database = cantools.database.load_file(root / "dbc" / "caamtb-swap.dbc", strict=True)
    assert isinstance(database, Database)
    return database


def test_there_is_one_typed_message_for_each_message_of_the_model(protocol: Protocol) -> None:
    assert {(kind.NAME, kind.FRAME_ID, kind.LENGTH) for kind in MESSAGES} == {
        (message.name, message.frame_id, message.length) for message in protocol.messages
    }


@every_message
def test_each_bit_belongs_to_at_most_one_signal_and_cantools_finds_the_same_one(
    name: str, protocol: Protocol, dbc: Database
) -> None:
    message, theirs = protocol.message(name), dbc.get_message_by_name(name)
    for bit in range(8 * message.length):
        data = (1 << bit).to_bytes(message.length, "little")
        ours = {key: raw for key, raw in reference.raw_values(message, data).items() if raw}
        assert len(ours) <= 1
        assert {key: raw for key, raw in _raw(theirs, data).items() if raw} == ours


@every_message
def test_raw_values_agree_with_cantools_in_both_directions(
    name: str, protocol: Protocol, dbc: Database
) -> None:
    message, theirs = protocol.message(name), dbc.get_message_by_name(name)

    @given(data=PAYLOADS)
    def agree(data: bytes) -> None:
        raw = reference.raw_values(message, data)
        assert _raw(theirs, data) == raw
        encoded = theirs.encode(dict(raw), scaling=False, strict=False)
        assert encoded == reference.payload(message, raw)

    agree()


@every_message
def test_typed_values_agree_with_the_reference_and_with_cantools(
    codec: Codec, name: str, protocol: Protocol, dbc: Database
) -> None:
    message, theirs = protocol.message(name), dbc.get_message_by_name(name)

    @given(data=PAYLOADS)
    def agree(data: bytes) -> None:
        decoded = codec.decode(message.frame_id, data, verify=False)
        scaled = theirs.decode_simple(data, decode_choices=False)
        named = theirs.decode_simple(data)
        for signal in message.signals:
            raw = reference.raw_value(signal, data)
            assert scaled[signal.name] == pytest.approx(
                float(reference.physical_value(signal, raw)), rel=1e-12, abs=1e-12
            )
            _assert_says_the_same(
                _value(decoded, signal), signal, raw, scaled[signal.name], str(named[signal.name])
            )

    agree()


def _as_sent(message: Message, raw: dict[str, int]) -> dict[str, int]:
    """Of several codes that say that a signal is invalid the first is sent."""
    signals = {signal.name: signal for signal in message.signals}
    return {
        name: code
        if code not in (signal := signals[name]).other_invalid_codes
        else signal.invalid_code or 0
        for name, code in raw.items()
    }


@every_message
def test_encoding_what_was_decoded_gives_the_same_payload(
    codec: Codec, name: str, protocol: Protocol
) -> None:
    message = protocol.message(name)

    @given(raw=_defined_values(message))
    def same(raw: dict[str, int]) -> None:
        data = reference.payload(message, raw)
        sent = reference.payload(message, _as_sent(message, raw))
        assert codec.encode(codec.decode(message.frame_id, data, verify=False)) == sent

    same()


@every_message
def test_any_payload_decodes_and_encodes_to_itself_or_is_refused(
    codec: Codec, name: str, protocol: Protocol
) -> None:
    message = protocol.message(name)

    @given(data=PAYLOADS)
    def itself_or_refused(data: bytes) -> None:
        raw = reference.raw_values(message, data)
        decoded = codec.decode(message.frame_id, data, verify=False)
        if all(reference.is_defined(signal, raw[signal.name]) for signal in message.signals):
            assert codec.encode(decoded) == reference.payload(message, _as_sent(message, raw))
        else:
            try:
                encoded = codec.encode(decoded)
            except EncodeError as refused:
                by_field = {_field(decoded, each): each for each in message.signals}
                at_fault = by_field[refused.field]
                assert not reference.is_defined(at_fault, raw[at_fault.name])
            else:
                assert encoded == reference.payload(message, _as_sent(message, raw))

    itself_or_refused()


@every_message
def test_setting_one_signal_changes_only_its_bits(
    codec: Codec, name: str, protocol: Protocol
) -> None:
    message = protocol.message(name)
    zero = codec.decode(message.frame_id, bytes(message.length), verify=False)
    assert codec.encode(zero) == bytes(message.length)
    for signal in message.signals:
        own = sum(1 << (8 * byte + bit) for byte, bit in reference.places(signal))
        for raw in (raw for raw in _telling_values(signal) if raw):
            alone = reference.payload(message, {signal.name: raw})
            value = _value(codec.decode(message.frame_id, alone, verify=False), signal)
            encoded = codec.encode(
                dataclasses.replace(zero, **{_field(zero, signal): value})  # type: ignore[type-var]
            )
            assert encoded == reference.payload(message, _as_sent(message, {signal.name: raw}))
            assert int.from_bytes(encoded, "little") & ~own == 0


def test_every_defined_value_of_up_to_16_bits_survives_the_way_to_the_wire(
    protocol: Protocol, dbc: Database
) -> None:
    tried: set[object] = set()
    for message, signal in protocol.signals():
        field = message_type(message.name).FIELDS[signal.python_name]
        alike = (signal.length, signal.factor, signal.offset, signal.maximum, field.states)
        if not isinstance(field, PhysicalField) or signal.length > 16 or str(alike) in tried:
            continue
        tried.add(str(alike))
        theirs = dbc.get_message_by_name(message.name).get_signal_by_name(signal.name)
        for raw in reference.raw_range(signal):
            if raw not in field.states:
                value = theirs.conversion.raw_to_scaled(raw, decode_choices=False)
                assert field.to_raw(message.name, value) == raw
    assert len(tried) > 5


def _raw(message: CantoolsMessage, data: bytes) -> dict[str, object]:
    return dict(message.decode_simple(data, scaling=False, decode_choices=False))


def _field(message: swapcan.Message, signal: Signal) -> str:
    (name,) = (name for name, field in message.FIELDS.items() if field.dbc_name == signal.name)
    return name


def _value(message: swapcan.Message, signal: Signal) -> object:
    return getattr(message, _field(message, signal))


def _assert_says_the_same(
    value: object, signal: Signal, raw: int, scaled: object, named: str
) -> None:
    """A typed value must say what the raw value means, and nothing that it does not mean."""
    states = {signal.invalid_code: SignalState.INVALID, signal.abnormal_code: SignalState.ABNORMAL}
    states |= dict.fromkeys(signal.other_invalid_codes, SignalState.INVALID)
    labels = reference.labels(signal)
    plain = signal.factor == 1 and signal.offset == 0 and not signal.unit
    match value:
        case SignalState():
            assert value is states[raw]
        case IntEnum():
            assert plain
            assert (value.value, named) == (raw, labels[raw])
            assert value.name.replace("_", "").startswith(_letters(labels[raw]))
        case str():
            assert (ord(value), value) == (raw, labels[raw])
        case float():
            assert raw not in states
            assert value == scaled
        case _:
            assert value == raw
            assert plain
            # A labelled code may stay a number only where its label does nothing but number it.
            assert raw not in states
            assert labels.get(raw, str(raw)).endswith(str(raw))


def _letters(label: str) -> str:
    return "".join(letter for letter in label.upper() if letter.isalnum())


def _telling_values(signal: Signal) -> list[int]:
    """Defined raw values of a signal that show most: its codes, its ends, each bit alone."""
    highest = (1 << signal.length) - 1
    bits = [1 << bit for bit in range(signal.length)]
    values = {0, 1, highest - 1, highest, *bits, *reference.labels(signal)}
    return sorted(raw for raw in values if reference.is_defined(signal, raw))


def _defined_values(message: Message) -> st.SearchStrategy[dict[str, int]]:
    """Raw values for all signals of a message, each inside its range or one of its codes."""
    return st.fixed_dictionaries(
        {
            signal.name: st.sampled_from(_telling_values(signal))
            | st.integers(0, (1 << signal.length) - 1).filter(_defined(signal))
            for signal in message.signals
        }
    )


def _defined(signal: Signal) -> Callable[[int], bool]:
    return lambda raw: reference.is_defined(signal, raw)
