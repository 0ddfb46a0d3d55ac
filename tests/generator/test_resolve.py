"""Layout and meaning joined into the model, and everything that is missing said at once."""

from __future__ import annotations

import re
from decimal import Decimal
from pathlib import Path

import pytest
from generator.small_spec import edited, write_spec

from dbcspec.errors import SpecError
from dbcspec.spec.errata import apply_errata
from dbcspec.spec.folder import read_spec
from dbcspec.spec.resolve import resolve
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import (
    ByteOrder,
    Code,
    Message,
    Protocol,
    SendType,
    Signal,
)


def resolved(folder: Path, **changed: str) -> Protocol:
    spec, faults = apply_errata(read_spec(write_spec(folder, **changed), "spec"))
    assert faults == ()
    return resolve(spec, "thermo")


def refusals(folder: Path, **changed: str) -> list[str]:
    with pytest.raises(SpecError) as caught:
        resolved(folder, **changed)
    return [str(fault) for fault in caught.value.faults]


def signal(message: Message, name: str) -> Signal:
    (found,) = (each for each in message.signals if each.name == name)
    return found


def table(old: str, new: str) -> dict[str, str]:
    return {"01-heater": edited("tables/01-heater.yaml", old, new)}


def test_a_message_joins_annex_tables_and_behaviour(tmp_path: Path) -> None:
    message = resolved(tmp_path).message("Heater")
    assert message.frame_id == 0x18FF0120
    assert (message.extended, message.length, message.period) == (True, 8, 100)
    assert (message.sender, message.receivers) == ("HEATER", ("PANEL",))
    assert (message.send_type, message.condition) == (SendType.CYCLIC, "always")
    assert (message.title, message.english) == ("加热器状态", "Heater state")
    assert message.reference == "A, Table 1 (5.1)"
    expected = Checksum(signal="H_Sum", algorithm="xor", covered=(1, 2, 3, 4, 5, 6, 7))
    assert message.checksum == expected
    assert message.counter == Counter(signal="H_Live", modulus=16)
    assert str(message.where) == "spec/messages.yaml:4:5"


def test_reserved_fields_are_no_signals(tmp_path: Path) -> None:
    message = resolved(tmp_path).message("Heater")
    assert [each.name for each in message.signals] == ["H_Sum", "H_Live", "H_Mode", "H_Temp"]


def test_a_signal_joins_its_field_and_its_row(tmp_path: Path) -> None:
    temp = signal(resolved(tmp_path).message("Heater"), "H_Temp")
    assert (temp.start, temp.length, temp.byte_order) == (16, 8, ByteOrder.INTEL)
    assert (temp.factor, temp.offset) == (Decimal("0.5"), Decimal(-40))
    assert (temp.minimum, temp.maximum) == (Decimal(-40), Decimal("87.5"))
    assert (temp.title, temp.english) == ("温度", "Temperature")
    assert (temp.reference, temp.python_name) == ("Table 1 row 4 (5.1)", "temp")


def test_a_printed_unit_gets_its_ascii_form(tmp_path: Path) -> None:
    assert signal(resolved(tmp_path).message("Heater"), "H_Temp").unit == "degC"


def test_an_alias_is_its_node(tmp_path: Path) -> None:
    protocol = resolved(tmp_path)
    assert protocol.message("Heater").sender == "HEATER"
    assert protocol.message("Panel").receivers == ("HEATER",)


def test_codes_labelled_invalid_and_abnormal_are_known_as_such(tmp_path: Path) -> None:
    message = resolved(tmp_path).message("Heater")
    temp, mode, live = (signal(message, name) for name in ("H_Temp", "H_Mode", "H_Live"))
    assert (temp.invalid_code, temp.abnormal_code) == (255, 254)
    assert (mode.invalid_code, mode.abnormal_code) == (3, None)
    assert (live.invalid_code, live.abnormal_code) == (None, None)


def test_a_signal_starts_at_its_invalid_code_unless_it_is_filled_in(tmp_path: Path) -> None:
    changed = table("    range: 0~15\n", "    range: 0~15\n    codes: {15: Invalid}\n")
    message = resolved(tmp_path, **changed).message("Heater")
    starts = {each.name: each.start_value for each in message.signals}
    assert signal(message, "H_Live").invalid_code == 15
    assert starts == {"H_Sum": 0, "H_Live": 0, "H_Mode": 3, "H_Temp": 255}


def test_codes_have_the_printed_label_and_the_english_one(tmp_path: Path) -> None:
    mode = signal(resolved(tmp_path).message("Heater"), "H_Mode").value_table
    assert mode
    assert mode.name == "HeaterMode"
    assert mode.codes == (
        Code(0, "关", "Off"),
        Code(1, "开", "On"),
        Code(2, "ECO", "ECO"),
        Code(3, "Invalid", "Invalid"),
    )


def test_a_message_may_have_a_byte_order_of_its_own(tmp_path: Path) -> None:
    wanted = signal(resolved(tmp_path).message("Panel"), "P_WantedTemp")
    assert (wanted.byte_order, wanted.start) == (ByteOrder.MOTOROLA, 7)


def test_a_field_may_have_a_byte_order_a_type_and_a_start_value_of_its_own(tmp_path: Path) -> None:
    given = "name: H_Temp, type: signed, byte_order: Motorola, initial: 7"
    messages = edited("messages.yaml", "name: H_Temp", given)
    temp = signal(resolved(tmp_path, messages=messages).message("Heater"), "H_Temp")
    assert (temp.byte_order, temp.signed, temp.start_value) == (ByteOrder.MOTOROLA, True, 7)
    assert temp.raw_limits == (-128, 127)


def test_a_message_may_say_itself_who_sends_it_and_how_long_its_identifier_is(
    tmp_path: Path,
) -> None:
    messages = edited("messages.yaml", "name: Panel\n", "name: Panel\n    sender: HTR\n")
    messages = messages.replace("id: 0x18FF0210\n", "id: 0x210\n    extended: no\n")
    heater, panel = resolved(tmp_path, messages=messages).messages
    assert (panel.sender, panel.extended) == ("HEATER", False)
    assert (heater.sender, heater.extended) == ("HEATER", True)


def test_a_row_for_one_message_explains_the_signal_of_that_message_only(tmp_path: Path) -> None:
    messages = edited("messages.yaml", "P_WantedTemp, length: 16", "H_Temp, length: 16")
    panel = edited("tables/02-panel.yaml", "name: P_WantedTemp", "name: H_Temp\n    message: Panel")
    protocol = resolved(tmp_path, **{"messages": messages, "02-panel": panel})
    temps = [signal(message, "H_Temp") for message in protocol.messages]
    assert [temp.english for temp in temps] == ["Temperature", "Wanted temperature"]
    assert [temp.factor for temp in temps] == [Decimal("0.5"), Decimal("0.1")]


def test_a_period_of_0_is_none(tmp_path: Path) -> None:
    message = resolved(tmp_path).message("Panel")
    assert (message.period, message.send_type) == (None, SendType.EVENT)


def test_frames_of_a_standard_can_protocol_have_11_bits(tmp_path: Path) -> None:
    standard = edited("standard.yaml", "frame_format: ExtendedCAN", "frame_format: StandardCAN")
    assert [m.extended for m in resolved(tmp_path, standard=standard).messages] == [False, False]


def test_numbers_of_errata_follow_what_they_touch(tmp_path: Path) -> None:
    head = "kind: typo, place: p, printed: q, reading: r, because: b"
    errata = (
        f"errata:\n"
        f"  - {{id: E1, {head}, change: [{{at: [tables/01-heater/4], set: {{unit: K}}}}]}}\n"
        f"  - {{id: E2, {head}, change: [{{at: [messages/Heater/H_Temp], set: {{start: 24}}}}]}}\n"
        f"  - {{id: E3, {head}, change: [{{at: [messages/Panel], keep: [id]}}]}}\n"
        f"  - {{id: E4, {head}, change: [{{at: [standard/nodes/PANEL], keep: [address]}}]}}\n"
    )
    protocol = resolved(tmp_path, errata=errata)
    heater, panel = protocol.messages
    assert signal(heater, "H_Temp").errata == ("E1", "E2")
    assert (heater.errata, panel.errata) == ((), ("E3",))
    assert [node.errata for node in protocol.nodes] == [("E4",), ()]
    assert [each.id for each in protocol.errata] == ["E1", "E2", "E3", "E4"]


def test_signals_with_the_same_codes_share_one_value_table(tmp_path: Path) -> None:
    codes = "    codes: {0: 关, 1: 开, 2: ECO, 3: Invalid}\n"
    panel = edited("tables/02-panel.yaml", "    length: 16\n", f"    length: 16\n{codes}")
    protocol = resolved(tmp_path, **{"02-panel": panel})
    wanted = signal(protocol.message("Panel"), "P_WantedTemp")
    assert wanted.value_table is signal(protocol.message("Heater"), "H_Mode").value_table
    assert [each.name for each in protocol.value_tables] == ["HeaterMode", "TemperatureState"]


def test_codes_that_nobody_named_are_called_after_their_first_signal(tmp_path: Path) -> None:
    standard = edited("standard.yaml", "HeaterMode: H_Mode, ", "")
    mode = signal(resolved(tmp_path, standard=standard).message("Heater"), "H_Mode")
    assert mode.value_table
    assert mode.value_table.name == "H_Mode"


def test_every_value_that_is_missing_is_named_at_once(tmp_path: Path) -> None:
    heater = edited("tables/01-heater.yaml", "    factor: 0.5\n    offset: -40\n", "")
    heater = heater.replace("    range: 0~15\n", "")
    messages = edited("messages.yaml", "P_WantedTemp, length: 16, start: 7", "P_WantedTemp")
    found = refusals(tmp_path, **{"01-heater": heater, "messages": messages})
    assert [re.sub(r"(: )[^:]*: (.*) is missing, and .*", r"\1\2", text) for text in found] == [
        "spec/messages.yaml:25:9: length",
        "spec/messages.yaml:25:9: start",
        "spec/tables/01-heater.yaml:16:5: range",
        "spec/tables/01-heater.yaml:37:5: factor",
        "spec/tables/01-heater.yaml:37:5: offset",
    ]


def test_a_factor_of_0_is_refused(tmp_path: Path) -> None:
    assert refusals(tmp_path, **table("factor: 0.5", "factor: 0")) == [
        "spec/tables/01-heater.yaml:44:13: H_Temp: factor is 0"
    ]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (
            "signal: H_Sum",
            "signal: H_Live",
            "H_Live: is the checksum, and cannot be the counter too",
        ),
        ("bytes: 1~7", "bytes: 1~8", "H_Sum: bytes 1~8 are not in the message"),
        ("bytes: 1~7", "bytes: 3~2", "H_Sum: covers no byte: ranges rise, such as 1~7"),
        (", bytes: 1~7", "", "H_Sum: bytes is missing, and no erratum gives it"),
        (", modulus: 16", "", "H_Live: modulus is missing, and no erratum gives it"),
        ("signal: H_Live", "signal: H_Alive", "signal: there is no 'H_Alive'"),
        ("messages: [Panel]", "messages: [Pannel]", "messages: there is no 'Pannel'"),
    ],
)
def test_behaviour_that_cannot_be_is_refused(
    old: str, new: str, fault: str, tmp_path: Path
) -> None:
    found = refusals(tmp_path, behaviour=edited("behaviour.yaml", old, new))
    assert [text.split(": ", 1)[1] for text in found] == [fault]
    assert all(text.startswith("spec/behaviour.yaml:") for text in found)


@pytest.mark.parametrize(
    ("row", "fault"),
    [
        ("Other: H_Mode", "Other has the same codes as HeaterMode"),
        ("Other: H_Live", "Other: no signal 'H_Live' with codes"),
        ("Other: H_Missing", "Other: no signal 'H_Missing' with codes"),
    ],
)
def test_a_name_for_codes_that_are_none_or_have_one_is_refused(
    row: str, fault: str, tmp_path: Path
) -> None:
    standard = edited("standard.yaml", "HeaterMode: H_Mode,", f"HeaterMode: H_Mode, {row},")
    (found,) = refusals(tmp_path, standard=standard)
    assert found == f"spec/standard.yaml:14:15: {fault}"


def test_a_spec_without_behaviour_and_errata_is_a_spec(tmp_path: Path) -> None:
    message = resolved(tmp_path, behaviour="").message("Heater")
    assert (message.checksum, message.counter, message.condition) == (None, None, "")
