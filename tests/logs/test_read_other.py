"""Every log finds its reader; those without one of their own are read by python-can's."""

from __future__ import annotations

import errno
import gzip
import os
import sys
from pathlib import Path

import pytest
from logs.log_files import (
    NEEDS_ASAMMDF,
    mixed_frames,
    row_of,
    rows_by_python_can,
    rows_in,
    write_log,
)

from typedcan.logs.read import open_log
from typedcan.model.errors import TypedcanError


@pytest.mark.parametrize(
    "suffix",
    [
        *(".asc", ".blf", ".csv", ".db", ".log", ".trc", ".BLF"),
        pytest.param(".mf4", marks=NEEDS_ASAMMDF),
    ],
)
def test_a_log_of_any_kind_is_read_as_python_can_reads_it(tmp_path: Path, suffix: str) -> None:
    kinds = "classic" if suffix == ".trc" else "classic remote"
    path = write_log(tmp_path / f"bus{suffix}", mixed_frames(250, kinds=kinds))
    with open_log(path, 100) as source:
        blocks = list(source)
        assert [len(block) for block in blocks] == [100, 100, 50]
        assert rows_in(blocks) == rows_by_python_can(path)
        assert source.damage is None
        assert source.position == source.size == path.stat().st_size


@pytest.mark.parametrize("suffix", [".asc", ".csv", ".log", ".trc"])
def test_a_packed_text_log_is_read_as_python_can_reads_it(tmp_path: Path, suffix: str) -> None:
    plain = write_log(tmp_path / f"bus{suffix}", mixed_frames(250, kinds="classic"))
    path = tmp_path / f"bus{suffix}.gz"
    path.write_bytes(gzip.compress(plain.read_bytes()))
    with open_log(path) as source:
        assert rows_in(source) == rows_by_python_can(path)
        assert source.damage is None


def test_a_database_gives_every_kind_of_classic_frame(tmp_path: Path) -> None:
    frames = mixed_frames(400, kinds="classic remote error")  # its writer loses those above 500
    path = write_log(tmp_path / "bus.db", frames)
    with open_log(path) as source:
        found = rows_in(source)
    assert found == rows_by_python_can(path)
    assert [row[1] for row in found] == [row_of(frame)[1] for frame in frames]


def test_a_database_cut_anywhere_gives_the_frames_before_the_cut(tmp_path: Path) -> None:
    whole = write_log(tmp_path / "bus.db", mixed_frames(450, kinds="classic"))
    rows, content = rows_by_python_can(whole), whole.read_bytes()
    counts = set()
    for place in range(0, len(content), len(content) // 10):
        path = tmp_path / "cut.db"
        path.write_bytes(content[:place])
        with open_log(path) as source:
            found = rows_in(source)
            assert found == rows[: len(found)]
            assert len(found) < len(rows)
            assert source.damage is not None
            assert source.damage.where == f"frame {len(found) + 1}"
            counts.add(len(found))
    assert max(counts) > 0


def test_a_database_that_is_none_is_damage(tmp_path: Path) -> None:
    path = tmp_path / "bus.db"
    path.write_bytes(b"this is no database" * 100)
    with open_log(path) as source:
        assert list(source) == []
        assert source.damage is not None


def refusal(path: Path) -> str:
    """The one line that says why a log cannot be opened."""
    with pytest.raises(TypedcanError) as caught:
        open_log(path)
    text = str(caught.value)
    assert "\n" not in text
    assert text.startswith(f"{path}: ")
    return text


@pytest.mark.parametrize("name", ["none.blf", "none.mf4", "none.log", "none.db", "none.xyz"])
def test_a_log_that_is_not_there_is_refused(tmp_path: Path, name: str) -> None:
    assert refusal(tmp_path / name) == f"{tmp_path / name}: {os.strerror(errno.ENOENT)}"
    assert not (tmp_path / name).exists()


def test_a_folder_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bus.blf"
    path.mkdir()
    refusal(path)


def test_an_unknown_suffix_is_refused_with_those_that_are_known(tmp_path: Path) -> None:
    path = tmp_path / "bus.xyz"
    path.write_bytes(b"?")
    text = refusal(path)
    for suffix in (".asc", ".blf", ".csv", ".db", ".log", ".mf4", ".trc"):
        assert suffix in text


@pytest.mark.parametrize("suffix", [".blf", ".db", pytest.param(".mf4", marks=NEEDS_ASAMMDF)])
def test_a_packed_log_that_is_no_text_is_read(tmp_path: Path, suffix: str) -> None:
    plain = write_log(tmp_path / f"bus{suffix}", mixed_frames(250, kinds="classic"))
    rows = rows_by_python_can(plain)
    path = tmp_path / f"bus{suffix}.gz"
    path.write_bytes(gzip.compress(plain.read_bytes()))
    with open_log(path) as source:
        assert rows_in(source) == rows
        assert source.damage is None
        assert source.position == source.size == path.stat().st_size


def test_a_packed_log_that_is_cut_off_gives_the_frames_before(tmp_path: Path) -> None:
    plain = write_log(tmp_path / "bus.blf", mixed_frames(5000, kinds="classic"))
    rows = rows_by_python_can(plain)
    path = tmp_path / "bus.blf.gz"
    path.write_bytes(gzip.compress(plain.read_bytes())[: plain.stat().st_size // 2])
    with open_log(path) as source:
        found = rows_in(source)
        assert 0 < len(found) < len(rows)
        assert found == rows[: len(found)]
        assert source.damage is not None
        assert source.damage.path == path


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"MDF     3.30    TGT 12.0", "an MDF 3 file"),
        (b"PK\x03\x04\x14\x00\x06\x00", "a ZIP archive or a workbook"),
        (b'VERSION ""\n\nNS_ :\n\nBU_: A B\n', "a DBC database"),
        (b'<?xml version="1.0"?>\n<log/>', "an XML file"),
        (b'{"frames": []}', "a JSON file"),
        (b"\xa1\xb2\xc3\xd4\x00\x02\x00\x04" + bytes(15) + b"\x01", "another network than CAN"),
    ],
)
@pytest.mark.parametrize("suffix", [".asc", ".log", ".mdf", ""])
def test_what_is_no_log_that_is_read_is_named(
    tmp_path: Path, content: bytes, said: str, suffix: str
) -> None:
    path = tmp_path / f"bus{suffix}"
    path.write_bytes(content)
    assert said in refusal(path)


@pytest.mark.parametrize("suffix", [".asc", ".blf", ".csv", ".db", ".log", ".trc"])
@pytest.mark.parametrize("other", [".txt", "", ".dat", ".log"])
def test_a_log_is_known_by_what_it_holds(tmp_path: Path, suffix: str, other: str) -> None:
    plain = write_log(tmp_path / f"bus{suffix}", mixed_frames(50, kinds="classic"))
    rows = rows_by_python_can(plain)
    path = tmp_path / f"renamed{other}"
    path.write_bytes(plain.read_bytes())
    with open_log(path) as source:
        assert rows_in(source) == rows


def test_without_asammdf_an_mf4_log_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "bus.mf4"
    path.write_bytes(b"MDF     4.10    ")
    monkeypatch.setitem(sys.modules, "asammdf", None)
    assert "needs asammdf: pip install 'swapcan[mf4]'" in refusal(path)
