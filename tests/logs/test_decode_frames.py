"""Which frames are decoded, and how the others are counted."""

from __future__ import annotations

import numpy as np
import pytest
from cantools.database.can import Message, Signal
from cantools.database.conversion import BaseConversion
from logs.decode_databases import Frame, block_of, model_of

from typedcan.logs.columns import Counts, State
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameFlag
from typedcan.logs.plan import Mode, ReservedCodeError, SelectionError

EXTENDED, REMOTE, ERROR = FrameFlag.EXTENDED, FrameFlag.REMOTE, FrameFlag.ERROR


def byte(name: str, at: int) -> Signal:
    return Signal(name, 8 * at, 8)


STANDARD = Message(0x123, "Standard", 2, [byte("A", 0), byte("B", 1)])
SAME_NUMBER = Message(0x123, "SameNumber", 2, [byte("C", 0)], is_extended_frame=True)
LONG = Message(0x20, "Long", 64, [byte("Last", 63)], is_fd=True)
DATABASE = model_of([STANDARD, SAME_NUMBER, LONG])


def test_the_same_number_with_11_and_with_29_bits_are_two_messages() -> None:
    frames = [Frame(0x123, b"\1\2"), Frame(0x123, b"\3\4", EXTENDED), Frame(0x123, b"\5\6")]
    found = Decoder(DATABASE).decode(block_of(frames)).messages
    assert found["Standard"].columns["B"].values.tolist() == [2, 6]
    assert found["SameNumber"].columns["C"].values.tolist() == [3]
    assert found["Standard"].rows.tolist() == [0, 2]


def test_rows_carry_time_and_channel_of_their_frames() -> None:
    frames = [Frame(0x7, b""), Frame(0x123, b"\1\2"), Frame(0x7, b""), Frame(0x123, b"\1\2")]
    found = Decoder(DATABASE).decode(block_of(frames)).messages["Standard"]
    assert found.timestamp.tolist() == [1.0, 3.0]
    assert found.channel.tolist() == [1, 0]
    assert len(found) == 2


def test_an_empty_block_gives_no_messages() -> None:
    decoded = Decoder(DATABASE).decode(block_of([]))
    assert decoded.messages == {}
    assert decoded.counts == Counts()


def test_a_database_without_messages_knows_no_frame() -> None:
    counts = Decoder([]).decode(block_of([Frame(0x123, b"")])).counts
    assert counts.unknown == {(0x123, False): 1}


def test_remote_and_error_frames_are_counted_and_not_decoded() -> None:
    frames = [
        Frame(0x123, b"\0\0", REMOTE),
        Frame(0x123, b"\0\0", ERROR),
        Frame(0x123, b"\0\0", EXTENDED | ERROR),
        Frame(0x7, b"", EXTENDED | REMOTE),
    ]
    decoded = Decoder(DATABASE).decode(block_of(frames))
    assert decoded.messages == {}
    assert decoded.counts == Counts(frames=4, remote=2, error=2)


def test_flags_that_do_not_change_the_payload_do_not_keep_a_frame_from_being_decoded() -> None:
    others = FrameFlag.FD | FrameFlag.BIT_RATE_SWITCH | FrameFlag.ERROR_STATE | FrameFlag.SENT
    decoded = Decoder(DATABASE).decode(block_of([Frame(0x123, b"\1\2", others)]))
    assert decoded.counts.decoded == {"Standard": 1}


def test_unknown_identifiers_are_counted_each_by_itself() -> None:
    frames = [Frame(0x7, b""), Frame(0x8, b""), Frame(0x7, b"\1"), Frame(0x7, b"", EXTENDED)]
    counts = Decoder(DATABASE).decode(block_of(frames)).counts
    assert counts.unknown == {(0x7, False): 2, (0x8, False): 1, (0x7, True): 1}


def test_short_frames_are_counted_and_bytes_too_many_do_not_matter() -> None:
    frames = [Frame(0x123, b"\1"), Frame(0x123, b"\1\2\3"), Frame(0x123, b"")]
    decoded = Decoder(DATABASE).decode(block_of(frames))
    assert decoded.counts.too_short == {"Standard": 2}
    assert decoded.messages["Standard"].rows.tolist() == [1]


def test_a_message_of_can_fd_in_a_log_of_short_frames_is_too_short() -> None:
    decoded = Decoder(DATABASE).decode(block_of([Frame(0x20, bytes(8))]))
    assert decoded.counts.too_short == {"Long": 1}


def test_the_last_byte_of_64_is_reached() -> None:
    decoded = Decoder(DATABASE).decode(block_of([Frame(0x20, bytes(63) + b"\7")]))
    assert decoded.messages["Long"].columns["Last"].values.tolist() == [7]


def test_only_the_messages_and_signals_asked_for_are_decoded() -> None:
    frames = [Frame(0x123, b"\1\2"), Frame(0x123, b"\3\4", EXTENDED), Frame(0x9, b"")]
    decoded = Decoder(DATABASE, wanted={"Standard": ["B"]}).decode(block_of(frames))
    assert list(decoded.messages) == ["Standard"]
    assert list(decoded.messages["Standard"].columns) == ["B"]
    assert decoded.counts.unwanted == 1
    assert decoded.counts.unknown == {(0x9, False): 1}


def test_asking_for_nothing_decodes_nothing() -> None:
    decoded = Decoder(DATABASE, wanted={}).decode(block_of([Frame(0x123, b"\1\2")]))
    assert decoded.messages == {}
    assert decoded.counts == Counts(frames=1, unwanted=1)


@pytest.mark.parametrize("wanted", [{"Nowhere": None}, {"Standard": ["C"]}])
def test_asking_for_what_the_database_has_not_is_refused(
    wanted: dict[str, list[str] | None],
) -> None:
    with pytest.raises(SelectionError, match=r"'Nowhere'|'C'"):
        Decoder(DATABASE, wanted=wanted)


def test_of_two_messages_with_one_identifier_the_later_counts() -> None:
    later = Message(0x123, "Later", 1, [byte("A", 0)])
    decoded = Decoder([*DATABASE, *model_of([later])]).decode(block_of([Frame(0x123, b"\1\2")]))
    assert decoded.counts.decoded == {"Later": 1}


def test_a_mask_makes_identifiers_with_other_sources_the_same_message() -> None:
    status = Message(0x18FEF1FE, "Status", 1, [byte("A", 0)], is_extended_frame=True)
    decoder = Decoder(model_of([status]), frame_id_mask=0x1FFFFF00)
    frames = [Frame(0x18FEF103, b"\1", EXTENDED), Frame(0x18FEF203, b"\1", EXTENDED)]
    decoded = decoder.decode(block_of(frames))
    assert decoded.messages["Status"].rows.tolist() == [0]


@pytest.mark.parametrize("count", [1, 254, 255, 256, 4000])
def test_all_of_many_messages_are_told_apart(count: int) -> None:
    database = [
        Message(77 * n, f"M{n}", 2, [Signal("N", 0, 16)], is_extended_frame=True)
        for n in range(count)
    ]
    frames = [Frame(77 * n, n.to_bytes(2, "little"), EXTENDED) for n in range(count)]
    frames += [Frame(77 * n + 1, b"\0\0", EXTENDED) for n in range(count)]
    decoded = Decoder(model_of(database)).decode(block_of(frames))
    assert decoded.counts.unknown.total() == count
    assert len(decoded.messages) == count
    for n in range(count):
        assert decoded.messages[f"M{n}"].columns["N"].values.tolist() == [n]


def test_the_next_block_is_decoded_into_the_same_memory() -> None:
    decoder = Decoder(DATABASE)
    first = decoder.decode(block_of([Frame(0x123, b"\1\2")])).messages["Standard"].columns["B"]
    second = decoder.decode(block_of([Frame(0x123, b"\3\4")])).messages["Standard"].columns["B"]
    assert np.shares_memory(first.values, second.values)
    assert second.values.tolist() == [4]


def test_counts_of_blocks_add_up() -> None:
    decoder = Decoder(DATABASE)
    frames = [Frame(0x123, b"\1\2"), Frame(0x123, b"\1"), Frame(0x7, b""), Frame(1, b"", ERROR)]
    total = Counts()
    for _ in range(2):
        total.add(decoder.decode(block_of(frames)).counts)
    assert total.frames == 8
    assert total.decoded == total.too_short == {"Standard": 2}
    assert total.unknown == {(0x7, False): 2}
    assert total.error == 2


def test_signals_that_overlap_are_decoded_and_one_outside_is_left_out() -> None:
    signals = [Signal("A", 0, 9), Signal("B", 8, 8), Signal("C", 12, 5)]
    message = Message(1, "M", 2, signals, strict=False)
    decoded = Decoder(model_of([message])).decode(block_of([Frame(1, b"\1\3")]))
    assert decoded.counts.decoded == {"M": 1}
    found = {name: each.values.tolist() for name, each in decoded.messages["M"].columns.items()}
    assert found == {"A": [0x101], "B": [3]}


@pytest.mark.parametrize(
    ("signal", "payload", "raw", "physical", "state"),
    [
        (Signal("S", 0, 8), b"\xff", 255, None, State.INVALID),
        (Signal("S", 0, 8), b"\xfe", 254, None, State.ABNORMAL),
        (Signal("S", 0, 8), b"\x01", 1, 1, State.VALUE),
        (Signal("S", 4, 4, conversion=BaseConversion.factory(0.5)), b"\xf0", 15, None, 1),
        (Signal("S", 0, 8, is_signed=True), b"\xff", -1, None, State.INVALID),
    ],
)
def test_a_reserved_code_is_null_and_says_why(
    signal: Signal, payload: bytes, raw: int, physical: int | None, state: int
) -> None:
    codes = {
        (False, 8): {255: State.INVALID, 254: State.ABNORMAL},
        (False, 4): {15: State.INVALID},
        (True, 8): {-1: State.INVALID},
    }[signal.is_signed, signal.length]
    message = Message(1, "M", 1, [signal])
    block = block_of([Frame(1, payload)])
    messages, reserved = model_of([message]), {("M", "S"): codes}
    column = Decoder(messages, reserved=reserved).decode(block).messages["M"].columns["S"]
    assert column.valid is not None
    assert column.state is not None
    assert bool(column.valid[0]) is (physical is not None)
    assert column.state[0] == state
    in_raw = Decoder(messages, mode=Mode.RAW, reserved=reserved).decode(block)
    assert in_raw.messages["M"].columns["S"].values.tolist() == [raw]
    assert in_raw.messages["M"].columns["S"].valid is None


def test_a_reserved_code_that_the_signal_cannot_have_is_refused() -> None:
    with pytest.raises(ReservedCodeError, match=r"Standard\.A: raw value 256 .* 0 to 255"):
        Decoder(DATABASE, reserved={("Standard", "A"): {256: State.INVALID}})
