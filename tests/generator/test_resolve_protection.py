"""Checksums and counters of behaviour.yaml, as docs/checksums.md shows them, become the model's."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import can
import pytest
from cantools.autosar import end_to_end
from oracles.bitwise_crc import Parameters, crc

import swapcan
from dbcspec.emit.spec import emit_spec
from dbcspec.errors import SpecError
from dbcspec.spec.compiled import compile_spec
from swapcan.messages import BMS_TMS_0
from typedcan.dynamic import typed_protocol
from typedcan.model.checksums.registry import names
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Message, Protocol
from typedcan.wire.codec import Codec
from typedcan.wire.errors import EncodeError

DOCS = (Path(__file__).parents[2] / "docs" / "checksums.md").read_text("utf-8")
(BEHAVIOUR,) = re.findall(r"^```yaml\n(.*?)^```", DOCS, re.DOTALL | re.MULTILINE)
(PYTHON,) = re.findall(r"^```python\n(.*?)^```", DOCS, re.DOTALL | re.MULTILINE)

J1850 = Parameters(width=8, poly=0x1D, init=0xFF, refin=False, refout=False, xorout=0xFF)
KERMIT = Parameters(width=16, poly=0x1021, init=0, refin=True, refout=True, xorout=0)
MIRROR = Parameters(width=8, poly=0x2F, init=0, refin=True, refout=True, xorout=0xFF)
STANDARD = """\
number: X 1
title: Car
english: Car
nodes: [{name: ECU, english: Unit}]
frame_format: StandardCAN
"""
# By message: its signals as name, start and length.
LAYOUT = {
    "Speed": [("Speed_CRC", 0, 8), ("Speed_Count", 8, 4)],
    "Lamp": [("Lamp_Sum", 56, 4), ("Lamp_Count", 0, 4)],
    "Door": [("Door_Sum", 56, 8)],
    "Seat": [("Seat_CRC", 32, 16)],
    "Mirror": [("Mirror_CRC", 8, 8)],
    "Brake": [("Brake_CRC", 0, 8), ("Brake_Count", 8, 4)],
    "Steer": [("Steer_CRC", 0, 16), ("Steer_Count", 16, 8)],
    "Old": [("Old_CRC", 56, 8)],
}


def spec(folder: Path, behaviour: str = BEHAVIOUR) -> Path:
    """A spec folder of the messages above with that behaviour."""
    (folder / "tables").mkdir(parents=True)
    rows, messages = (
        ["number: 1", "title: T", 'clause: "1"', "rows:"],
        ["annex: A", "byte_order: Intel", "messages:"],
    )
    for count, (name, signals) in enumerate(LAYOUT.items()):
        messages += [
            f"  - {{id: 0x{0x120 + count:X}, name: {name}, english: M, length: 8, type: Event,",
            "     period: 0, signals: [",
        ]
        for place, (signal, start, length) in enumerate(signals):
            messages.append(f"      {{name: {signal}, start: {start}, length: {length}}},")
            rows.append(
                f"  - {{no: {10 * count + place}, name: {signal}, english: S, length: {length},"
                f' factor: 1, offset: 0, unit: "", range: 0~{(1 << length) - 1}, route: ECU>ECU}}'
            )
        messages.append("    ]}")
    (folder / "standard.yaml").write_text(STANDARD, "utf-8")
    (folder / "messages.yaml").write_text("\n".join(messages) + "\n", "utf-8")
    (folder / "tables" / "01-all.yaml").write_text("\n".join(rows) + "\n", "utf-8")
    (folder / "behaviour.yaml").write_text(behaviour, "utf-8")
    return folder


@pytest.fixture(scope="module")
def car(tmp_path_factory: pytest.TempPathFactory) -> Protocol:
    folder = spec(tmp_path_factory.mktemp("car") / "spec")
    return compile_spec(folder, "spec", "car").protocol


def checksum(message: Message) -> Checksum:
    assert message.checksum
    return message.checksum


def test_what_is_covered_is_said_in_several_ways(car: Protocol) -> None:
    found = {message.name: checksum(message) for message in car.messages}
    assert found["Speed"].covered == tuple(range(1, 8))
    assert found["Lamp"].covered == tuple(range(8))  # its last byte has other bits too
    assert found["Mirror"].covered == (0, 2, 3, 4, 5, 6, 7)
    assert found["Door"].before == (0x01, 0x22, 8)
    assert found["Seat"].covered == (0, 1, 2, 3, 6, 7)
    assert found["Seat"].after == (0x5A, 0xA5)
    assert found["Brake"].covered == tuple(range(1, 8))
    assert found["Brake"].data_ids == (7, *range(1, 16))
    assert found["Steer"].covered == tuple(range(2, 8))
    assert found["Steer"].after == (0x34, 0x12)
    assert [name for name, each in found.items() if each.is_open] == ["Old"]


def test_algorithms_stand_by_their_names_in_the_catalogue(car: Protocol) -> None:
    assert {message.name: checksum(message).algorithm for message in car.messages} == {
        "Speed": "CRC-8/SAE-J1850",
        "Lamp": "sum complement=ones",
        "Door": "sum",
        "Seat": "CRC-16/KERMIT",
        "Mirror": "width=8 poly=0x2F init=0x0 refin=true refout=true xorout=0xFF",
        "Brake": "CRC-8/AUTOSAR",
        "Steer": "CRC-16/IBM-3740",
        "Old": "Old_CRC",
    }


@pytest.mark.parametrize(
    ("part", "before"),
    [("identifier", (0, 0, 0x01, 0x22)), ("identifier_reversed", (0x22, 0x01, 0, 0))],
)
def test_an_identifier_of_29_bits_has_four_bytes(
    part: str, before: tuple[int, ...], tmp_path: Path
) -> None:
    folder = spec(tmp_path / "spec", BEHAVIOUR.replace("[identifier, length]", f"[{part}]"))
    (folder / "standard.yaml").write_text(STANDARD.replace("StandardCAN", "ExtendedCAN"), "utf-8")
    door = compile_spec(folder, "spec", "car").protocol.message("Door")
    assert door.extended
    assert checksum(door).before == before


def test_the_bytes_that_a_profile_covers_can_be_given(tmp_path: Path) -> None:
    given = BEHAVIOUR.replace("PROFILE_02", "PROFILE_02\n    bytes: 1~5")
    given = given.replace("PROFILE_05,", "PROFILE_05, bytes: others,")
    protocol = compile_spec(spec(tmp_path / "spec", given), "spec", "car").protocol
    assert checksum(protocol.message("Brake")).covered == (1, 2, 3, 4, 5)
    assert checksum(protocol.message("Steer")).covered == (2, 3, 4, 5, 6, 7)


def test_the_others_are_the_bytes_that_a_checksum_does_not_take_whole(tmp_path: Path) -> None:
    given = BEHAVIOUR.replace("bytes: 0~3 6 7, after: [0x5A, 0xA5]", "bytes: others")
    given = given.replace(
        "signal: Old_CRC, algorithm: Old_CRC, open: yes, bytes: 0~6",
        "signal: Old_CRC, algorithm: Old_CRC, open: yes, bytes: others",
    )
    protocol = compile_spec(spec(tmp_path / "spec", given), "spec", "car").protocol
    assert checksum(protocol.message("Seat")).covered == (0, 1, 2, 3, 6, 7)
    assert checksum(protocol.message("Old")).covered == (0, 1, 2, 3, 4, 5, 6)


def test_counters_run_through_a_modulus_or_a_range(car: Protocol) -> None:
    assert car.message("Speed").counter == Counter(signal="Speed_Count", modulus=16)
    assert car.message("Steer").counter == Counter(signal="Steer_Count", modulus=255, first=1)
    lamp = car.message("Lamp").counter
    assert lamp == Counter(signal="Lamp_Count", modulus=8, first=14, step=-2)
    starts = {signal.name: signal.start_value for _, signal in car.signals()}
    assert (starts["Steer_Count"], starts["Lamp_Count"], starts["Speed_Count"]) == (1, 14, 0)


def test_typed_messages_have_the_checksums_that_another_computes(car: Protocol) -> None:
    protocol = typed_protocol(car)
    codec = Codec(protocol)
    sent = {name: codec.encode(protocol.message(name)(), counter=5) for name in LAYOUT}
    zeros = bytes(8)
    assert sent["Speed"][0] == crc(J1850, bytes([5, 0, 0, 0, 0, 0, 0]))
    assert sent["Lamp"] == bytes([5, 0, 0, 0, 0, 0, 0, 15 - 5])
    assert sent["Door"][7] == 0x01 + 0x22 + 8
    seat = crc(KERMIT, zeros[:6] + b"\x5a\xa5")
    assert sent["Seat"][4:6] == seat.to_bytes(2, "little")
    mirror = crc(MIRROR, zeros[:7])
    assert sent["Mirror"][1] == mirror
    assert bytearray(sent["Brake"]) == end_to_end.apply_profile2_crc(bytes([0, 5, *zeros[2:]]), 5)
    assert bytearray(sent["Steer"]) == end_to_end.apply_profile5_crc(
        bytes([0, 0, 5, *zeros[3:]]), 0x1234
    )
    assert sent["Old"] == zeros
    for message in car.messages:
        codec.decode(message.frame_id, sent[message.name])


def test_where_nobody_says_a_counter_stands_at_its_first_value(car: Protocol) -> None:
    protocol = typed_protocol(car)
    steer: Any = protocol.message("Steer")
    data = Codec(protocol).encode(steer())
    assert data[2] == 1
    given = Codec(protocol).encode(steer(count=9))
    assert given[2] == 9


def test_the_spec_that_is_written_says_the_same(car: Protocol, tmp_path: Path) -> None:
    for name, content in emit_spec(car).items():
        (tmp_path / "spec" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "spec" / name).write_bytes(content)
    again = compile_spec(tmp_path / "spec", "spec", "car").protocol
    for message in car.messages:
        assert again.message(message.name).checksum == message.checksum
        assert again.message(message.name).counter == message.counter


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("{signal: Door_Sum, algorithm: sum,", "{signal: Door_Sum,", "Door_Sum: algorithm is"),
        ("bytes: 0~3 6 7", "bytes: 0~3 6 6", "Seat_CRC: bytes 0~3 6 6 have one twice"),
        ("bytes: 0~3 6 7", "bytes: 0~3 8", "Seat_CRC: bytes 0~3 8 are not in the message"),
        ("after: [0x5A, 0xA5]", "after: [256]", "Seat_CRC: before, after and data_ids are bytes"),
        ("algorithm: CRC-16/KERMIT", "algorithm: CRC-32/MEF", "CRC-32/MEF makes 32 bits, its"),
        ("data_ids: [0x1234]", "data_ids: [1, 2]", "Steer_CRC: PROFILE_05 has 1 data_ids"),
        ("data_ids: [7, 1,", "data_ids: [", "Brake_CRC: PROFILE_02 has 16 data_ids"),
        ("  - {signal: Brake_Count, modulus: 16}\n", "", "Brake has no counter that chooses"),
        (
            "algorithm: Old_CRC",
            "algorithm: CRC-8/MAXIM",
            "CRC-8/MAXIM-DOW is known, so that nothing",
        ),
        ("modulus: 16}", "modulus: 17}", "Speed_Count: it runs 0 to 16, it may run within 0 to 15"),
        ("range: 14~0, step: -2", "range: 14~0, step: 4", "steps of 4 do not lead from 14 to 0"),
        ("range: 14~0, step: -2", "range: 14~0, step: 0", "steps of 0 do not lead from 14 to 0"),
        ("range: 1~255", "range: 1.5~255", "steps of 1 do not lead from 1.5 to 255"),
        ("range: 1~255", "range: 1~256", "it runs 1 to 256, it may run within 0 to 255"),
        ("signal: Door_Sum", "signal: Speed.Door_Sum", "there is no 'Speed.Door_Sum'"),
        ("signal: Door_Sum", "signal: Lamp_Count", "Lamp_Count: Lamp has Lamp_Sum already"),
        ("signal: Steer_Count", "signal: Steer_CRC", "is the checksum, and cannot be the counter"),
        ("signal: Lamp_Count", "signal: Speed_CRC", "Speed_CRC: Speed has Speed_Count already"),
    ],
)
def test_what_cannot_be_is_told_with_its_place(
    old: str, new: str, fault: str, tmp_path: Path
) -> None:
    assert old in BEHAVIOUR
    folder = spec(tmp_path / "spec", BEHAVIOUR.replace(old, new, 1))
    with pytest.raises(SpecError) as caught:
        compile_spec(folder, "spec", "car")
    assert fault in str(caught.value.faults[0])
    assert str(caught.value.faults[0]).startswith("spec/behaviour.yaml:")


def test_a_signal_may_be_named_with_its_message(tmp_path: Path) -> None:
    folder = spec(tmp_path / "spec", BEHAVIOUR.replace("signal: Door_Sum", "signal: Door.Door_Sum"))
    door = compile_spec(folder, "spec", "car").protocol.message("Door")
    assert checksum(door).signal == "Door_Sum"


def test_a_message_whose_algorithm_nothing_computes_is_not_sent(tmp_path: Path) -> None:
    behaviour = BEHAVIOUR.replace("open: yes, ", "")
    protocol = typed_protocol(compile_spec(spec(tmp_path / "spec", behaviour), "s", "car").protocol)
    old: Any = protocol.message("Old")
    with pytest.raises(EncodeError, match=r"Old\.crc: nothing here computes 'Old_CRC'"):
        Codec(protocol).encode(old())
    assert Codec(protocol).encode(old(crc=7)).hex() == "0000000000000007"
    assert Codec(protocol, {"Old_CRC": lambda data: 9}).encode(old())[7] == 9
    # What others send of it is read, though nothing tells whether it is right.
    assert Codec(protocol).decode(0x127, bytes(8)) == old(crc=0)


def test_the_docs_list_every_name_that_is_known() -> None:
    listed = re.findall(r"(?<![\w/])CRC-\d+/[A-Z0-9-]+(?=,|\n)", DOCS.split("another\nname", 1)[-1])
    assert set(names()) - {"xor", "sum"} <= set(listed)


def test_the_python_of_the_docs_runs() -> None:
    found: dict[str, Any] = {}
    exec(PYTHON, found)
    message = BMS_TMS_0(reqst_tms_hv_on=0)
    data = found["codec"].encode(message)
    assert data[7] == sum(data[:7]) & 0xFF
    other = found["other"].encode(message)
    assert other[7] == crc(J1850, other[:7])
    frame = can.Message(arbitration_id=BMS_TMS_0.FRAME_ID, data=data)
    with pytest.raises(swapcan.ChecksumError):
        found["other"].decode_frame(frame)
