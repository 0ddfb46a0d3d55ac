"""What holds for text logs of every format: how lines end, compression, damage, bounds."""

from __future__ import annotations

import gzip
import random
import tracemalloc
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from logs.log_files import rows_by_python_can
from logs.text_log_files import TEXT_SUFFIXES, open_text, read_text, regular_log, sound_rows

pytestmark = pytest.mark.parametrize("suffix", TEXT_SUFFIXES)

SMALL = 12_000_000
"""Bytes: the buffers of a reader, and then some."""


def frame_ends(content: bytes, count: int) -> list[int]:
    """Where the text of each line with a frame ends."""
    ends, place = [], 0
    for line in content.splitlines(keepends=True):
        if line.strip()[:1] in b"(0123456789" and b"measurement" not in line:
            ends.append(place + len(line.rstrip()))
        place += len(line)
    assert len(ends) == count
    return ends


@pytest.mark.parametrize("newline", [b"\n", b"\r\n", b"\r"])
def test_lines_end_as_on_any_system(tmp_path: Path, suffix: str, newline: bytes) -> None:
    path = tmp_path / f"bus{suffix}"
    rows = regular_log(path, 3000)
    path.write_bytes(newline.join(path.read_bytes().splitlines()) + newline)
    assert sound_rows(path) == rows


def test_the_last_line_may_lack_its_end(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}"
    rows = regular_log(path, 50)
    path.write_bytes(path.read_bytes().removesuffix(b"End TriggerBlock\n").rstrip())
    assert sound_rows(path) == rows


def test_a_compressed_log_is_read_like_any(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}"
    rows = regular_log(path, 5000)
    content = path.read_bytes()
    packed = tmp_path / f"bus{suffix}.gz"
    half = len(content) // 2
    packed.write_bytes(gzip.compress(content[:half]) + gzip.compress(content[half:]) + bytes(100))
    assert sound_rows(packed) == rows == rows_by_python_can(packed)
    with open_text(packed) as source:
        assert source.position <= source.size == packed.stat().st_size
        list(source)
        assert source.position == source.size


def test_a_damaged_compressed_log_gives_the_frames_before(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}"
    rows = regular_log(path, 3000)
    content = gzip.compress(path.read_bytes())
    packed = tmp_path / f"bus{suffix}.gz"
    noise = random.Random(1)
    for share in (0.3, 0.6, 0.9, 0.999):
        cut = content[: int(share * len(content))]
        for damaged in (cut, cut + noise.randbytes(len(content) - len(cut))):
            packed.write_bytes(damaged)
            found, damage = read_text(packed)
            assert damage is not None
            assert len(found) > (share - 0.1) * len(rows)
            begin = found[: int((share - 0.1) * len(rows))]
            assert begin == rows[: len(begin)]


def test_a_log_that_is_cut_anywhere_gives_the_frames_before(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}"
    rows = regular_log(path, 60)
    content = path.read_bytes()
    ends = frame_ends(content, 60)
    for size in range(ends[-4], ends[-1]):
        path.write_bytes(content[:size])
        found, damage = read_text(path)
        assert found == rows[: sum(end <= size for end in ends)]
        begun = content[max(end for end in ends if end <= size) : size].strip()
        assert (damage is None) == (not begun)


def test_an_empty_log_has_no_frames(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}"
    for content in (b"", b"\n", b"\n \n\r\n"):
        path.write_bytes(content)
        assert sound_rows(path) == []


def test_a_line_without_end_takes_bounded_memory(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}"
    rows = regular_log(path, 100)
    with path.open("ab") as log:
        log.write(b"1" * 20_000_000 + b"\n" + path.read_bytes())
    tracemalloc.start()
    try:
        found, damage = read_text(path)
        assert tracemalloc.get_traced_memory()[1] < SMALL
    finally:
        tracemalloc.stop()
    assert found[:100] == rows
    assert len(found) in (100, 200)  # a header amid a log is damage to some formats
    assert damage is not None


def test_a_small_file_of_much_text_takes_bounded_memory(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}.gz"
    path.write_bytes(gzip.compress(b"\n" + bytes(50_000_000)))
    tracemalloc.start()
    try:
        found, damage = read_text(path, 65_536)
        assert tracemalloc.get_traced_memory()[1] < SMALL
    finally:
        tracemalloc.stop()
    assert found == []
    assert damage is not None
    assert damage.lost == "1 line"


def test_blocks_have_the_size_that_was_asked_for(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bus{suffix}"
    regular_log(path, 2500)
    with open_text(path, 1000) as source:
        assert [len(block) for block in source] == [1000, 1000, 500]


def test_lines_that_are_whole_are_read_whatever_happens_to_others(
    tmp_path: Path, suffix: str
) -> None:
    path = tmp_path / f"bus{suffix}"
    rows = regular_log(path, 400)
    content = path.read_bytes()
    begin = frame_ends(content, 400)[0]
    noise = random.Random(1)
    for _ in range(20):
        damaged = bytearray(content)
        hit = set()
        for _ in range(30):
            place = noise.randrange(begin + 2, len(content))
            damaged[place] = noise.randrange(256)
            hit.add(content.count(b"\n", begin, place))
            hit.add(content.count(b"\n", begin, place + 1))
        path.write_bytes(damaged)
        found, _ = read_text(path)
        whole = [row for number, row in enumerate(rows) if number not in hit]
        remaining = iter(found)
        assert all(row in remaining for row in whole)
        assert len(found) <= len(rows) + len(hit)


@settings(max_examples=50)
@given(st.data())
def test_no_content_leads_astray(
    tmp_path_factory: pytest.TempPathFactory, suffix: str, data: st.DataObject
) -> None:
    path = tmp_path_factory.mktemp("fuzz") / f"bus{suffix}"
    regular_log(path, 25)
    lines = path.read_bytes().splitlines(keepends=True)
    line = st.sampled_from([*lines, b"\r", b"\n", b"\0"]) | st.binary(max_size=80)
    path.write_bytes(content := _altered(b"".join(data.draw(st.lists(line, max_size=40))), data, 5))
    found, damage = read_text(path, 7)
    count = content.count(b"\n") + content.count(b"\r") + 1
    assert len(found) <= count
    if damage is not None:
        assert 1 <= int(damage.where.removeprefix("line ")) <= count


@settings(max_examples=50)
@given(st.data())
def test_lines_are_the_same_alone_and_among_their_like(
    tmp_path_factory: pytest.TempPathFactory, suffix: str, data: st.DataObject
) -> None:
    """Alone, python-can reads them; many are read together."""
    path = tmp_path_factory.mktemp("fuzz") / f"bus{suffix}"
    regular_log(path, 2)
    content = path.read_bytes().removesuffix(b"End TriggerBlock\n")
    *header, line, last = content.splitlines(keepends=True)
    changed = [_altered(line, data, 2) for _ in range(3)]
    whole = [one.translate(None, b"\r\n") + b"\n" for one in [line, last, *changed]]
    path.write_bytes(b"".join([*header, *whole]))
    alone, problem = read_text(path)
    path.write_bytes(b"".join([*header, *(one * 100 for one in whole)]))
    together, problems = read_text(path)
    assert together == [row for row in alone for _ in range(100)]
    assert (problem is None) == (problems is None)


def _altered(content: bytes, data: st.DataObject, most: int) -> bytes:
    """Some bytes replaced by ``most`` others, or fewer."""
    for _ in range(data.draw(st.integers(0, 5))):
        place = data.draw(st.integers(0, len(content)))
        content = content[:place] + data.draw(st.binary(max_size=most)) + content[place + 1 :]
    return content
