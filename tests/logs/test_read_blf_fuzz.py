"""Whatever stands in a BLF log, its reader ends, with every frame before the first odd byte."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import can
import pytest
from can.io.blf import BLFParseError
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from logs.blf_bytes import (
    CAN_ERROR_EXT,
    CAN_FD_MESSAGE,
    CAN_FD_MESSAGE_64,
    CAN_MESSAGE,
    CAN_MESSAGE2,
    blf_file,
    blf_object,
    joined,
)
from logs.log_files import Row, row_of, rows_in

from typedcan.logs.read.blf import BlfSource

QUICK = settings(
    max_examples=150,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
BODY_SIZES = {
    CAN_MESSAGE: 16,
    CAN_MESSAGE2: 24,
    CAN_ERROR_EXT: 32,
    CAN_FD_MESSAGE: 84,
    CAN_FD_MESSAGE_64: 104,
    65: 21,  # some other object
}


@st.composite
def objects(draw: st.DrawFn) -> bytes:
    """A well-formed object with any content."""
    kind = draw(st.sampled_from(list(BODY_SIZES)))
    body = bytearray(draw(st.binary(min_size=BODY_SIZES[kind], max_size=BODY_SIZES[kind])))
    if kind == CAN_FD_MESSAGE_64:
        body[2] %= 65  # no frame has more bytes
        body[35] = 0  # nothing behind the payload
        body[34] %= 2  # no transmit requests, which python-can takes for frames
        body[12] &= 0x7F
    elif kind not in (CAN_ERROR_EXT, 65):
        body[2] &= 0xFD
    return blf_object(
        kind,
        bytes(body),
        draw(st.integers(0, 2**64 - 1)),
        unit=draw(st.sampled_from([1, 2])),
        version=draw(st.sampled_from([1, 2])),
    )


def read(path: Path) -> tuple[list[Row], bool]:
    """The frames, and whether there was damage."""
    with BlfSource(path, 7) as source:
        return rows_in(source), source.damage is not None


def read_by_python_can(path: Path, most: int) -> list[Row] | None:
    """The same by python-can; None where it gives up, or never would."""
    with can.BLFReader(path) as reader:
        try:
            frames = list(islice(reader, most + 1))
        except BLFParseError:
            return None
    return None if len(frames) > most else [row_of(frame) for frame in frames]


@QUICK
@given(
    parts=st.lists(objects(), max_size=12),
    container_size=st.integers(1, 400),
    stored=st.booleans(),
)
def test_frames_of_any_content_are_those_of_python_can(
    tmp_path: Path, parts: list[bytes], *, container_size: int, stored: bool
) -> None:
    path = tmp_path / "bus.blf"
    path.write_bytes(blf_file(joined(parts), container_size=container_size, stored=stored))
    found, damaged = read(path)
    assert not damaged
    assert found == read_by_python_can(path, len(parts))


@QUICK
@given(
    parts=st.lists(objects(), min_size=1, max_size=12),
    place=st.floats(0, 1),
    odd=st.one_of(st.binary(min_size=1, max_size=40), st.just(b""), st.just(bytes(8))),
    over=st.booleans(),
)
def test_frames_before_odd_objects_are_delivered(
    tmp_path: Path, parts: list[bytes], place: float, odd: bytes, *, over: bool
) -> None:
    """Bytes put over or between those of the objects; a file may be cut there, too."""
    stream = joined(parts)
    at = int(place * len(stream))
    rest = stream[at + len(odd) if over else at :] if odd else b""
    path = tmp_path / "bus.blf"
    path.write_bytes(blf_file(stream))
    whole, _ = read(path)
    path.write_bytes(blf_file(stream[:at]))
    before, _ = read(path)
    assert before == whole[: len(before)]
    path.write_bytes(blf_file(stream[:at] + odd + rest))
    found, _ = read(path)
    assert found[: len(before)] == before


@pytest.mark.parametrize("prefix", [b"", blf_file(b""), blf_file(b"", size=0) + b"LOBJ"])
@QUICK
@given(content=st.binary(max_size=300))
def test_any_bytes_are_read_to_some_end(tmp_path: Path, prefix: bytes, content: bytes) -> None:
    path = tmp_path / "bus.blf"
    path.write_bytes(prefix + content)
    assert read(path)[0] == []
