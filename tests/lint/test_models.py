"""The linter on models that no spec is behind, such as those read from a DBC file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from decimal import Decimal
from typing import Any

import pytest

from dbcspec.lint.items import rule_infos, to_items
from dbcspec.lint.pgn_unique import RULE as PGN_UNIQUE
from dbcspec.lint.registry import ALL_RULES
from dbcspec.lint.rule import Finding, Settings, Subject
from dbcspec.lint.run import lint
from dbcspec.lint.units import is_known
from typedcan.model.acting import ActingCodes
from typedcan.model.errors import Location
from typedcan.model.protocol import Aspect, Bus, Code, Message, Node, Protocol, Signal, ValueTable


def signal(name: str = "SPEED", **values: Any) -> Signal:
    defaults = {"start": 0, "length": 8, "minimum": Decimal(0), "maximum": Decimal(255)}
    return Signal(name=name, english="What it means", **{**defaults, **values})


def message(name: str = "STATE", **values: Any) -> Message:
    defaults = {"frame_id": 0x100, "length": 8, "sender": "ECU", "signals": (signal(),)}
    return Message(name=name, english="What it carries", **{**defaults, **values})


def found(messages: Sequence[Message], settings: Settings, **values: Any) -> list[Finding]:
    defaults = {"name": "test", "nodes": (Node(name="ECU"),), "messages": tuple(messages)}
    return lint(Subject(protocol=Protocol(**{**defaults, **values}), settings=settings))


def findings(*messages: Message, **values: Any) -> list[str]:
    """Rule and text of every finding."""
    return [f"{each.rule}: {each.text}" for each in found(messages, Settings(), **values)]


def rules(*messages: Message, settings: Settings | None = None, **values: Any) -> list[str]:
    """The rules of all findings."""
    return [each.rule for each in found(messages, settings or Settings(), **values)]


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


def test_value_tables_are_held_against_messages_only_where_both_become_classes() -> None:
    table = ValueTable("STATE", (Code(0, "Off", "Off"), Code(1, "On", "On")))
    values: dict[str, Any] = {"value_tables": (table,)}
    assert rules(message(), **values) == ["name-unique"]
    carries = frozenset({Aspect.VALUE_TABLE_NAMES})
    assert rules(message(), carries=carries, **values) == []


def test_a_signed_signal_has_no_room_for_codes_above_its_half() -> None:
    table = ValueTable("Limit", (Code(127, "High", "High"), Code(128, "Error", "Error")))
    speed = signal(signed=True, minimum=Decimal(-128), maximum=Decimal(127), value_table=table)
    assert findings(message(signals=(speed,)), value_tables=(table,)) == [
        (
            "code-in-raw-range: SPEED: no code of 8 bits can be 128, only 0~127: correct the codes "
            "or the length"
        )
    ]


def test_codes_of_a_signal_that_fills_the_frame_are_no_enumeration() -> None:
    table = ValueTable("Limit", (Code(0, "None", "None"), Code(2**64 - 1, "All", "All")))
    wide = signal(length=64, maximum=Decimal(2**64 - 1), value_table=table)
    assert findings(message(signals=(wide,)), value_tables=(table,)) == []


def test_a_factor_of_0_is_one_finding() -> None:
    table = ValueTable("OnOff", (Code(0, "Off", "Off"), Code(1, "On", "On")))
    flat = signal(length=2, factor=Decimal(0), value_table=table)
    assert findings(message(signals=(flat,)), value_tables=(table,)) == [
        (
            "signal-readable: SPEED of STATE cannot be read: it has a factor that is 0, or no "
            "finite number"
        )
    ]


def test_the_bits_of_a_float_are_no_whole_numbers() -> None:
    table = ValueTable("Limit", (Code(2**40, "High", "High"),))
    real = signal(
        length=32, is_float=True, maximum=Decimal(10) ** 30, start_value=-5, value_table=table
    )
    assert findings(message(signals=(real,)), value_tables=(table,)) == []


def test_codes_that_act_are_held_against_signals_that_no_spec_is_behind() -> None:
    table = ValueTable("OnOff", (Code(0, "Off", "Off"), Code(1, "On", "On")))
    on = signal(length=2, maximum=Decimal(3), value_table=table, where=Location("m.xlsx!M", 5))
    acts = ActingCodes(codes=(1, 4), safe=0)
    items = found(
        [message(signals=(replace(on, start_value=1, acting=acts),))],
        Settings(),
        value_tables=(table,),
    )
    assert [(each.rule, each.where.line) for each in items if each.rule != "code-labelled"] == [
        ("acting-code-in-range", 5),
        ("acting-code-labelled", 5),
        ("start-value-safe", 5),
    ]
    flat = replace(on, factor=Decimal(0), acting=ActingCodes(codes=(1,), safe=0))
    assert rules(message(signals=(flat,)), value_tables=(table,)) == ["signal-readable"]
    wide = replace(on, length=10**12, acting=acts, value_table=None)
    assert "acting-code-in-range" not in rules(message(signals=(wide,)))


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
        "text-fits-dbc: title of STATE contains a semicolon: take it out",
        "text-gbk: condition of STATE has '€', which GB2312 lacks: use another character",
    ]


def test_a_comment_that_is_title_and_english_is_one_finding() -> None:
    same = message(title="What it carries", signals=(signal(title="What it means"),))
    assert findings(same) == []
    odd = Message(
        name="STATE", frame_id=1, length=8, sender="ECU", title="a;b", english="a;b"
    )  # as a file has one comment
    assert rules(odd) == ["text-fits-dbc"]


def test_a_file_without_any_comment_is_one_finding() -> None:
    bare = Message(
        name="STATE",
        frame_id=1,
        length=8,
        sender="ECU",
        signals=(Signal(name="SPEED", start=0, length=8, minimum=Decimal(0), maximum=Decimal(9)),),
    )
    assert rules(bare) == ["comment-given"]


def selector(name: str = "MODE", **values: Any) -> Signal:
    defaults = {"start": 0, "length": 4, "maximum": Decimal(15), "is_selector": True}
    return signal(name, **{**defaults, **values})


def branch(name: str, *selectors: int, **values: Any) -> Signal:
    defaults = {"start": 8, "multiplexer": "MODE", "selectors": selectors}
    return signal(name, **{**defaults, **values})


def test_branches_under_different_selectors_share_bits() -> None:
    apart = (selector(), branch("SPEED", 1, 3), branch("HEAT", 2))
    assert findings(message(signals=apart)) == []


def test_branches_with_one_common_selector_share_none() -> None:
    common = (selector(), branch("SPEED", 1, 3), branch("HEAT", 2, 3))
    assert findings(message(signals=common)) == [
        (
            "branches-overlap: HEAT overlaps SPEED at bit 8 of STATE while MODE is 3: correct a "
            "start bit, a length or a selector"
        )
    ]


def test_a_branch_shares_no_bit_with_its_selector_or_a_signal_that_is_always_there() -> None:
    onto_selector = (selector(), branch("SPEED", 1, start=0))
    assert rules(message(signals=onto_selector)) == ["signals-overlap"]
    onto_static = (selector(), signal("HEAT", start=8), branch("SPEED", 1))
    assert rules(message(signals=onto_static)) == ["signals-overlap"]


def test_a_branch_of_a_branch_is_apart_from_the_other_branches_of_the_first() -> None:
    inner = selector("PAGE", start=16, multiplexer="MODE", selectors=(1,))
    below = branch("SPEED", 0, multiplexer="PAGE")
    assert rules(message(signals=(selector(), inner, below, branch("HEAT", 2)))) == []
    together = message(signals=(selector(), inner, below, branch("HEAT", 1)))
    assert rules(together) == ["signals-overlap"]


def test_multiplexers_that_select_each_other_do_not_hang() -> None:
    one = selector("MODE", multiplexer="PAGE", selectors=(0,))
    other = selector("PAGE", start=4, multiplexer="MODE", selectors=(0,))
    assert rules(message(signals=(one, other))) == ["signal-readable"] * 2


def body(bit_rate: int) -> Bus:
    return Bus(name="body", bit_rate=bit_rate, nodes=("ECU",))


def test_the_longest_frame_with_all_stuff_bits_is_what_a_bus_carries() -> None:
    # Davis et al. 2007: 135 bits for 8 bytes with 11 bits of identifier, 160 with 29.
    exact = Settings(bus_load=100)
    for extended, bits in ((False, 135), (True, 160)):
        every_second = message(period=1000, extended=extended)
        assert rules(every_second, settings=exact, buses=(body(bits),)) == []
        assert rules(every_second, settings=exact, buses=(body(bits - 1),)) == ["bus-load"]


def test_only_periodic_messages_of_nodes_on_the_bus_load_it() -> None:
    event = message()
    elsewhere = message("LIMITS", frame_id=0x101, sender="HMI", period=1)
    longer_than_classic = message("BULK", frame_id=0x102, length=64, period=1, is_fd=True)
    nodes = (Node(name="ECU"), Node(name="HMI"))
    messages = (event, elsewhere, longer_than_classic)
    assert rules(*messages, nodes=nodes, buses=(body(1000),)) == []


def test_j1939_rules_do_not_speak_of_other_29_bit_identifiers() -> None:
    none, null = (Node(name="ECU"),), (Node(name="ECU", address=254),)
    for nodes, by_pgn, expected in (
        (none, False, []),
        (null, False, []),
        (none, True, ["LIMITS"]),
        ((Node(name="ECU", address=1),), False, ["LIMITS"]),
    ):
        shared = (
            message(frame_id=0x18FF0001, by_pgn=by_pgn),
            message("LIMITS", frame_id=0x18FF0002),
        )
        protocol = Protocol(name="x", messages=shared, nodes=nodes)
        found = PGN_UNIQUE.findings(Subject(protocol=protocol))
        assert [each.subject for each in found] == expected


@pytest.mark.parametrize(
    "unit",
    ["km/h", "mOhm", "µA", "m/s²", "m/s^2", "N*m", "N.m", "1/min", "kWh/100km", "degC/s", "%", "1"],
)
def test_a_known_unit_may_have_prefixes_exponents_and_parts(unit: str) -> None:
    assert is_known(unit)


@pytest.mark.parametrize("unit", ["Kwh", "apples", "apples/s", "s/apples", "mmm", "^2", "/"])
def test_what_is_put_together_of_anything_else_is_unknown(unit: str) -> None:
    assert not is_known(unit)
    assert rules(message(signals=(signal(unit=unit),))) == ["unit-known"]


def test_findings_become_items_in_the_group_of_their_message() -> None:
    twice = (message(signals=(signal(unit="apples"),)), message("LIMITS", frame_id=0x101))
    items = to_items(found(twice, Settings(), nodes=(Node(name="A"),)))
    assert {(item.rule, item.group, item.subject) for item in items} == {
        ("unit-known", "STATE", "SPEED"),
        ("node-declared", "STATE", "ECU"),
        ("node-declared", "LIMITS", "ECU"),
        ("name-is-identifier", "", "A"),
    }
    levels = {"unit-known": "warning", "node-declared": "warning", "name-is-identifier": "error"}
    assert all(item.level == levels[item.rule] for item in items)


def test_reports_know_every_rule() -> None:
    assert [(info.id, info.purpose) for info in rule_infos()] == [
        (rule.id, rule.purpose) for rule in ALL_RULES
    ]
