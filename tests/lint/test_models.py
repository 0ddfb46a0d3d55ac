"""The linter on models that no spec is behind, such as those read from a DBC file."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

from dbcspec.lint.rule import Subject
from dbcspec.lint.run import lint
from dbcspec.model import Code, Message, Node, Protocol, Signal, ValueTable


def signal(name: str = "SPEED", **values: Any) -> Signal:
    defaults = {"start": 0, "length": 8, "minimum": Decimal(0), "maximum": Decimal(255)}
    return Signal(name=name, **{**defaults, **values})


def message(name: str = "STATE", **values: Any) -> Message:
    defaults = {"frame_id": 0x100, "length": 8, "sender": "ECU", "signals": (signal(),)}
    return Message(name=name, **{**defaults, **values})


def findings(*messages: Message, **values: Any) -> list[str]:
    """Rule and text of every finding."""
    defaults = {"name": "test", "nodes": (Node(name="ECU"),), "messages": messages}
    subject = Subject(protocol=Protocol(**{**defaults, **values}))
    return [f"{each.rule}: {each.text}" for each in lint(subject)]


def test_a_sound_model_has_no_findings() -> None:
    assert findings(message()) == []


def test_an_identifier_of_11_bits_may_not_equal_one_of_29() -> None:
    short, long = message(extended=False), message("LIMITS", extended=True)
    assert findings(short, long) == [
        "identifier-unique: LIMITS has the identifier 0x100 of STATE: correct one"
    ]


def test_an_identifier_of_11_bits_ends_at_7ff() -> None:
    assert findings(message(frame_id=0x7FF, extended=False)) == []
    assert findings(message(frame_id=0x800, extended=False)) == [
        "identifier-unique: STATE: 0x800 is no 11-bit identifier, which ends at 0x7FF: correct it"
    ]


def test_two_messages_of_a_model_may_have_signals_of_one_name() -> None:
    assert findings(message(), message("LIMITS", frame_id=0x101)) == []
    twice = (signal(), signal(start=8))
    assert findings(message(signals=twice)) == [
        (
            "name-unique: SPEED, a signal of STATE, is the name of a signal of STATE already: "
            "rename one"
        )
    ]


def test_a_signed_signal_has_no_room_for_codes_above_its_half() -> None:
    table = ValueTable("Limit", (Code(127, "High", "High"), Code(128, "Error", "Error")))
    speed = signal(signed=True, minimum=Decimal(-128), maximum=Decimal(127), value_table=table)
    assert findings(message(signals=(speed,)), value_tables=(table,)) == [
        (
            "code-in-raw-range: SPEED: no code of 8 bits can be 128, only 0~127: correct the codes "
            "or the length"
        )
    ]


def test_a_factor_of_0_is_a_range_that_does_not_fit() -> None:
    table = ValueTable("OnOff", (Code(0, "Off", "Off"), Code(1, "On", "On")))
    flat = signal(length=2, factor=Decimal(0), value_table=table)
    assert findings(message(signals=(flat,)), value_tables=(table,)) == [
        (
            "range-fits-bits: SPEED: the range 0~255 is not within 0~0, what 2 bits hold: correct "
            "range, factor or offset"
        )
    ]


def test_a_signal_of_absurd_length_is_one_finding() -> None:
    assert findings(message(signals=(signal(length=10**12), signal("TORQUE", start=8)))) == [
        (
            "signal-inside-message: SPEED has 1000000000000 bits, but STATE has room for 1 to 64: "
            "correct the length"
        )
    ]


def test_senders_and_receivers_are_nodes_of_the_model() -> None:
    heard = signal(receivers=("ZZZ",))
    assert findings(message(sender="VCU", signals=(heard,))) == [
        (
            "node-declared: the message STATE names VCU, which is no declared node (the closest is "
            "ECU): declare or correct it"
        ),
        (
            "node-declared: the signal SPEED names ZZZ, which is no declared node: declare or "
            "correct it"
        ),
    ]


def test_texts_of_a_model_are_held_against_the_rules_of_dbc_files() -> None:
    assert findings(message(reference="§ 5", title="say; it", condition="if €")) == [
        "text-fits-dbc: condition of STATE is not ASCII: give an English form",
        "text-fits-dbc: reference of STATE is not ASCII: give an English form",
        "text-fits-dbc: title of STATE contains a semicolon: take it out",
    ]
