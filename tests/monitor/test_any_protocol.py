"""A bus of a second protocol, with 11-bit and 29-bit messages and nothing to see at a glance."""

from __future__ import annotations

from dataclasses import replace

import can
import pytest
from monitor.machine import CODEC, frame, machine
from monitor.monitored import Monitored, row, signal

from typedcan.dynamic import typed_protocol
from typedcan.model.protocol import Bus
from typedcan.monitor.watch import Watch
from typedcan.wire.codec import Codec


def test_one_number_in_both_widths_is_two_messages() -> None:
    monitored = machine()
    monitored.hear(
        frame("Motor_Status", 0.0, Speed=500),
        frame("Motor_Status", 0.1, Speed=510),
        frame("Motor_Description_Of_Its_Maker", 0.1, Serial=4_000_000_000),
        can.Message(arbitration_id=0x100, is_extended_id=False, data=bytes(4), timestamp=0.15),
    )
    picture = monitored.at(0.15)
    short, long = picture.messages[:2]
    assert (short.name, short.identifier, short.is_extended) == ("Motor_Status", "0x100", False)
    assert (long.identifier, long.is_extended) == ("0x00000100", True)
    assert (short.frames, short.faults["length"], long.frames) == (2, 1, 1)
    assert long.faults["length"] == 0
    assert signal(picture, "Motor_Status", "Speed").value == "510"
    assert signal(picture, long.name, "Serial").value == "4000000000"
    assert picture.foreign == ()


def test_foreign_identifiers_of_both_widths_are_told_apart() -> None:
    monitored = machine()
    monitored.hear(
        *(can.Message(arbitration_id=0x300, timestamp=0.1) for _ in range(2)),
        can.Message(arbitration_id=0x300, is_extended_id=False, timestamp=0.2),
        can.Message(arbitration_id=0x200, timestamp=0.3),  # the lamp's number, in the other width
    )
    picture = monitored.at(0.5)
    listed = [(str(each), each.frames) for each in picture.foreign]
    assert listed == [("0x00000200", 1), ("0x300", 1), ("0x00000300", 2)]
    assert [each.age for each in picture.foreign] == pytest.approx([0.2, 0.3, 0.4])
    assert row(picture, "Lamp").frames == 0


def test_every_message_with_a_period_has_to_come_whoever_sends_it() -> None:
    monitored = machine()
    monitored.hear(frame("Key_Pressed", 0.0, Key=7))
    monitored.hear(*(frame("Motor_Status", n / 10) for n in range(11)))
    monitored.hear(frame("Lamp", 1.0))
    states = {each.name: each.state for each in monitored.at(1.1).messages}
    assert states == {
        "Motor_Status": "alive",
        "Motor_Description_Of_Its_Maker": "never seen",
        "Key_Pressed": "seen",
        "Lamp": "late",  # for two periods
        "Pages": "never seen",
    }
    told = {str(each.event) for each in monitored.session.events()}
    assert "Key_Pressed: never seen -> alive" in told
    assert row(monitored.at(1.3), "Lamp").state == "lost"
    monitored.at(6.0)
    told = {str(each.event) for each in monitored.session.events()}
    assert any(text.startswith("Lamp: ") and "lost" in text for text in told)
    assert any(text.startswith("Motor_Description_Of_Its_Maker: not seen") for text in told)


def test_periods_are_measured_and_none_is_known_of_what_comes_on_events() -> None:
    monitored = machine()
    monitored.hear(*(frame("Lamp", at) for at in (0.0, 0.04, 0.1, 0.15)))
    monitored.hear(frame("Key_Pressed", 0.2))
    picture = monitored.at(0.2)
    lamp, key = row(picture, "Lamp"), row(picture, "Key_Pressed")
    assert (lamp.period, lamp.frames) == (0.05, 4)
    assert lamp.mean == pytest.approx(0.05)
    assert lamp.worst == pytest.approx(0.06)
    assert (key.period, key.receivers, key.state) == (None, (), "seen")
    assert key.matches("0x101")
    assert not key.matches("0x00000101")
    assert key.matches("panel")


def test_signals_and_alarms_are_those_of_the_database() -> None:
    monitored = machine()
    monitored.hear(frame("Motor_Status", 1.0, Speed=1200, Heat=2))
    picture = monitored.at(1.5)
    heat = signal(picture, "Motor_Status", "Heat")
    assert (heat.value, heat.label, heat.mark, heat.age) == ("2", "Too hot", "alarm", 0.5)
    speed = signal(picture, "Motor_Status", "Speed")
    assert (speed.value, speed.unit, speed.label, speed.mark) == ("1200", "rpm", "", None)
    (alarm,) = picture.alarms
    assert (alarm.message, alarm.signal, alarm.title) == (
        "Motor_Status",
        "Heat",
        "How hot the motor is",
    )
    assert (alarm.text, alarm.age) == ("Too hot", 0.5)
    monitored.hear(frame("Motor_Status", 1.6, Heat=0))
    assert monitored.at(1.6).alarms == ()


def test_signals_of_branches_are_shown_as_they_came_last() -> None:
    monitored = machine()

    def shown(at: float) -> list[tuple[str, str, str | None, float | None]]:
        rows = monitored.at(at).signals("Pages")
        return [(row.value, row.label, row.mark, row.age) for row in rows]

    monitored.hear(frame("Pages", 1.0, Page=1, State=1))
    assert shown(1.0) == [
        ("1", "", None, 0.0),
        ("", "", None, None),
        ("1", "Burnt out", "alarm", 0.0),
    ]
    before = monitored.at(1.0)
    monitored.hear(frame("Pages", 2.0, Page=0, Hours=7))
    assert shown(2.5) == [
        ("0", "", None, 0.5),
        ("7", "", None, 0.5),
        ("1", "Burnt out", "alarm", 1.5),
    ]
    assert before.signals("Pages")[1].value == ""
    (alarm,) = monitored.at(2.5).alarms
    assert (alarm.signal, alarm.age) == ("State", 1.5)
    monitored.hear(frame("Pages", 3.0, Page=1, State=0))
    assert shown(3.0)[2] == ("0", "Normal", None, 0.0)
    assert monitored.at(3.0).alarms == ()


def test_what_json_has_of_a_protocol_without_a_glance() -> None:
    monitored = machine()
    monitored.hear(frame("Motor_Status", 0.0, Heat=1))
    picture = monitored.at(0.5)
    told = picture.as_dict()
    assert list(told) == ["totals", "messages", "alarms", "transfers", "foreign"]
    assert told["alarms"] == [
        {
            "message": "Motor_Status",
            "signal": "Heat",
            "title": "How hot the motor is",
            "text": "Warm",
            "age": 0.5,
        }
    ]
    assert [each["is_extended"] for each in told["messages"]] == [False, True, False, False, False]
    assert told["totals"]["load"] is None


def test_the_load_takes_a_bit_rate_given_or_that_of_all_buses_of_the_protocol() -> None:
    def load(watch: Watch) -> float | None:
        monitored = Monitored(watch)
        monitored.hear(frame("Lamp", 0.5), frame("Motor_Description_Of_Its_Maker", 0.5))
        return monitored.at(1.0).totals.load

    def of_buses(*rates: int) -> Codec:
        buses = tuple(Bus(name=f"Bus{n}", bit_rate=rate, nodes=()) for n, rate in enumerate(rates))
        return Codec(typed_protocol(replace(CODEC.protocol.model, buses=buses)))

    # 47 and 67 bits beside the data; of 34 and 54 of them and the data, one in 16 is stuffed.
    bits = (47 + 8 + (34 + 8) / 16) + (67 + 32 + (54 + 32) / 16)
    assert load(Watch(0.0, CODEC)) is None
    assert load(Watch(0.0, CODEC, bitrate=125_000)) == pytest.approx(bits / 125_000)
    assert load(Watch(0.0, of_buses(500_000))) == pytest.approx(bits / 500_000)
    assert load(Watch(0.0, of_buses(500_000, 500_000))) == pytest.approx(bits / 500_000)
    assert load(Watch(0.0, of_buses(500_000), bitrate=125_000)) == pytest.approx(bits / 125_000)
    assert load(Watch(0.0, of_buses(500_000, 250_000))) is None
    assert load(Watch(0.0, of_buses(0))) is None
    fresh = Watch(1.0, CODEC), Watch(1.0, of_buses(500_000))
    assert [each.picture(1.0).totals.load for each in fresh] == [None, 0.0]


def test_a_message_of_several_senders_is_found_by_each() -> None:
    motor, *others = CODEC.protocol.model.messages
    shared = replace(motor, other_senders=("Light",))
    protocol = replace(CODEC.protocol.model, messages=(shared, *others))
    monitored = Monitored(Watch(0.0, Codec(typed_protocol(protocol))))
    shown = row(monitored.at(0.0), "Motor_Status")
    assert shown.sender == "Motor, Light"
    assert shown.matches("light")
    assert shown.matches("motor")


def test_a_protocol_without_messages_and_nodes_has_foreign_identifiers_only() -> None:
    empty = replace(CODEC.protocol.model, messages=(), nodes=())
    monitored = Monitored(Watch(0.0, Codec(typed_protocol(empty))))
    monitored.hear(frame("Lamp", 0.5))
    picture = monitored.at(1.0)
    assert (picture.messages, picture.totals.messages) == ((), 0)
    assert [str(each) for each in picture.foreign] == ["0x200"]
