"""What the frames of a bus amount to: states, periods, faults, signals, totals."""

from __future__ import annotations

import can
import pytest
from monitor.monitored import Monitored, frame, look, row, signal

from swapcan import encode
from swapcan.transfer import split_pack_code


def test_all_messages_of_the_protocol_have_a_row_before_anything_came(
    monitored: Monitored,
) -> None:
    picture = monitored.at(0.0)
    assert len(picture.messages) == 25
    assert {each.state for each in picture.messages} == {"never seen"}
    assert {each.age for each in picture.messages} == {None}


def test_a_cyclic_message_is_alive_then_late_then_lost(monitored: Monitored) -> None:
    monitored.hear(*(frame("B2V_ST2", 0.1 * n) for n in range(10)))
    assert row(monitored.at(1.0), "B2V_ST2").state == "alive"
    assert row(monitored.at(1.1), "B2V_ST2").state == "late"
    late = row(monitored.at(1.39), "B2V_ST2")
    assert late.state == "late"
    assert late.age == pytest.approx(0.49)
    assert row(monitored.at(1.41), "B2V_ST2").state == "lost"
    monitored.hear(frame("B2V_ST2", 2.0))
    assert row(monitored.at(2.0), "B2V_ST2").state == "alive"


def test_period_and_jitter_are_those_of_the_timestamps(monitored: Monitored) -> None:
    monitored.hear(*(frame("B2V_ST2", at) for at in (0.0, 0.09, 0.2, 0.29, 0.4)))
    measured = row(monitored.at(0.4), "B2V_ST2")
    assert (measured.frames, measured.period) == (5, 0.1)
    assert measured.mean == pytest.approx(0.1)
    assert measured.jitter == pytest.approx(0.01)
    assert measured.worst == pytest.approx(0.11)


def test_what_is_sent_while_asked_for_ends_and_is_not_lost(monitored: Monitored) -> None:
    monitored.hear(frame("B2V_BattInfo1", 0.0))
    assert row(monitored.at(0.4), "B2V_BattInfo1").state == "alive"
    assert row(monitored.at(0.6), "B2V_BattInfo1").state == "ended"


def test_what_is_sent_on_events_was_seen(monitored: Monitored) -> None:
    monitored.hear(frame("B2V_RQ", 0.0))
    assert row(monitored.at(100.0), "B2V_RQ").state == "seen"


def test_faults_are_counted_with_their_message(monitored: Monitored) -> None:
    short = can.Message(arbitration_id=0x1882D0F3, data=bytes(7), timestamp=0.1)
    wrong = can.Message(
        arbitration_id=0x1881D0F3, data=bytes([1, 0, 0, 0, 0, 0, 0, 0]), timestamp=0.2
    )
    monitored.hear(short, wrong, *(frame("B2V_ST1", at, ALIV=3) for at in (0.3, 0.4)))
    picture = monitored.at(0.4)
    assert row(picture, "B2V_ST2").faults["length"] == 1
    assert row(picture, "B2V_ST2").frames == 0
    assert row(picture, "B2V_ST1").faults["checksum"] == 1
    assert row(picture, "B2V_ST1").faults["counter repeated"] == 1
    assert (row(picture, "B2V_ST1").fault_count, row(picture, "B2V_ST2").fault_count) == (2, 1)
    totals = picture.totals
    assert (totals.length, totals.checksum, totals.counter, totals.faults) == (1, 1, 1, 3)
    assert (totals.frames, totals.messages) == (4, 2)


def test_foreign_identifiers_are_listed_and_error_frames_counted(monitored: Monitored) -> None:
    monitored.hear(
        can.Message(arbitration_id=0x18FEF100, timestamp=0.1),
        can.Message(arbitration_id=0x123, is_extended_id=False, timestamp=0.2),
        can.Message(arbitration_id=0x123, is_extended_id=False, timestamp=0.3),
        can.Message(is_error_frame=True, timestamp=0.4),
    )
    picture = monitored.at(0.5)
    listed = [(str(each), each.frames) for each in picture.foreign]
    assert listed == [("0x123", 2), ("0x18FEF100", 1)]
    assert picture.foreign[0].age == pytest.approx(0.2)
    assert (picture.totals.foreign, picture.totals.errors) == (3, 1)


def test_a_bus_full_of_foreign_identifiers_does_not_fill_the_memory(monitored: Monitored) -> None:
    monitored.hear(*(can.Message(arbitration_id=number) for number in range(3000)))
    picture = monitored.at(0.0)
    assert len(picture.foreign) == 1000
    assert picture.totals.foreign == 3000


def test_signals_have_value_unit_label_and_age(monitored: Monitored) -> None:
    monitored.hear(
        frame("B2V_ST2", 1.0, SOC=80, SOH=102, Current=-120.5), frame("B2V_ST1", 1.5, BMS=2)
    )
    picture = monitored.at(2.0)
    soc = signal(picture, "B2V_ST2", "SOC")
    assert (soc.value, soc.unit, soc.label, soc.mark, soc.age) == ("80", "%", "", None, 1.0)
    soh = signal(picture, "B2V_ST2", "SOH")
    assert (soh.value, soh.label, soh.mark) == ("", "Signal Invalid", "invalid")
    assert signal(picture, "B2V_ST2", "_Current").value == "-120.5"
    state = signal(picture, "B2V_ST1", "ST1_BMS")
    assert (state.value, state.label, state.age) == ("2", "HV closed", 0.5)


def test_signals_are_found_by_name_title_label_and_mark(monitored: Monitored) -> None:
    monitored.hear(frame("B2V_ST2", 0.0, SOC=80, SOH=102), frame("B2V_ST1", 0.0, BMS=2))
    picture = monitored.at(0.0)
    soc, soh = signal(picture, "B2V_ST2", "SOC"), signal(picture, "B2V_ST2", "SOH")
    assert all(soc.matches(text) for text in ("st2_soc", "state of CHARGE", ""))
    assert (soh.matches("invalid"), soc.matches("invalid")) == (True, False)
    assert signal(picture, "B2V_ST1", "ST1_BMS").matches("hv closed")


def test_characters_are_shown_as_such_and_what_is_none_as_its_code(monitored: Monitored) -> None:
    data = bytes([1, *b"LZ", 0x07, *b"JL4"])
    monitored.hear(can.Message(arbitration_id=0x18E1F3D0, data=data + b"X"))
    rows = monitored.at(0.0).signals("V2B_VIN")
    assert [row.value for row in rows] == ["1", "L", "Z", "0x07", "J", "L", "4", "X"]
    assert [row.label for row in rows] == [""] * 8


def test_signals_that_never_came_have_a_title_and_no_value(monitored: Monitored) -> None:
    soc = signal(monitored.at(1.0), "B2V_ST2", "SOC")
    assert (soc.title, soc.value, soc.age, soc.mark) == ("Pack state of charge", "", None, None)


def test_a_picture_stands_still_while_frames_come(monitored: Monitored) -> None:
    monitored.hear(frame("B2V_ST2", 0.0, SOC=80))
    before = monitored.at(0.0)
    monitored.hear(frame("B2V_ST2", 0.1, SOC=40))
    assert signal(before, "B2V_ST2", "SOC").value == "80"
    assert row(before, "B2V_ST2").frames == 1


def test_vin_and_pack_code_are_shown_once_complete(monitored: Monitored) -> None:
    vin, code = "LZGJL4V40MX000001", "001PB280SWAPR1EA10000025"
    for number in (1, 2, 3):
        letters = vin[7 * (number - 1) : 7 * number].ljust(7, "\0")
        monitored.hear(
            can.Message(arbitration_id=0x18E1F3D0, data=bytes([number, *letters.encode()]))
        )
    assert look(monitored.at(0.0)).vin == vin
    for part in split_pack_code(code) * 2:
        monitored.hear(can.Message(arbitration_id=part.FRAME_ID, data=encode(part)))
    assert look(monitored.at(0.0)).pack_code == code


def test_clearing_counts_anew_and_keeps_what_was_said(monitored: Monitored) -> None:
    monitored.hear(
        frame("B2V_ST2", 0.0, SOC=80),
        can.Message(arbitration_id=0x1882D0F3, data=bytes(7)),
        can.Message(arbitration_id=0x123),
    )
    monitored.session.clear()
    picture = monitored.at(0.1)
    assert (picture.totals.frames, picture.totals.faults, picture.totals.foreign) == (0, 0, 0)
    assert picture.foreign == ()
    assert row(picture, "B2V_ST2").frames == 0
    assert signal(picture, "B2V_ST2", "SOC").value == "80"
    monitored.hear(frame("B2V_ST2", 0.1))
    assert row(monitored.at(0.1), "B2V_ST2").frames == 1


def test_after_clearing_each_kind_of_fault_is_counted_from_nothing(monitored: Monitored) -> None:
    def one_of_each(at: float) -> list[can.Message]:
        return [
            can.Message(arbitration_id=0x1882D0F3, data=bytes(7), timestamp=at),
            can.Message(arbitration_id=0x1881D0F3, data=bytes([1, *bytes(7)]), timestamp=at),
            *(frame("B2V_ST1", at, ALIV=3) for _ in range(2)),
            can.Message(arbitration_id=0x123, timestamp=at),
            can.Message(is_error_frame=True, timestamp=at),
            can.Message(arbitration_id=0x1883D0F3, data=bytes(8), is_fd=True, timestamp=at),
        ]

    monitored.hear(*one_of_each(0.0), *one_of_each(0.1))
    monitored.session.clear()
    assert monitored.session.status().messages == 0
    monitored.hear(frame("B2V_ST1", 0.2, ALIV=4), *one_of_each(0.2))
    totals = monitored.at(0.3).totals
    assert (totals.length, totals.checksum, totals.foreign, totals.errors) == (1, 1, 1, 1)
    assert totals.format == 1
    assert totals.counter == 2  # a 3 after the 4, and another 3
    assert totals.seconds == pytest.approx(0.2)
    status = monitored.session.status()
    assert (status.frames, status.messages) == (totals.frames, totals.messages) == (8, 4)


def test_a_remote_frame_loads_the_bus_without_data(monitored: Monitored) -> None:
    monitored.hear(
        can.Message(is_remote_frame=True, dlc=8, arbitration_id=0x1882D0F3, timestamp=0.5),
        can.Message(is_extended_id=False, arbitration_id=0x123, data=bytes(1), timestamp=0.5),
    )
    bits = (67 + 54 / 16) + (47 + 8 + (34 + 8) / 16)
    assert monitored.at(1.0).totals.load == pytest.approx(bits / 250_000)


def test_load_and_rate_are_those_of_the_last_two_seconds(monitored: Monitored) -> None:
    monitored.hear(*(frame("B2V_ST2", n / 100) for n in range(1000)))
    totals = monitored.at(10.0).totals
    assert totals.frames_per_second == pytest.approx(100, rel=0.02)
    assert totals.load == pytest.approx(100 * 138.375 / 250_000, rel=0.02)
    totals = monitored.at(12.0).totals
    assert (totals.frames, totals.frames_per_second, totals.load) == (1000, 0, 0)
