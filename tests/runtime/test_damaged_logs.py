"""`swapcan decode` on logs that are absent, damaged, cut short, or something else."""

from __future__ import annotations

import errno
import os
import random
import re
import sqlite3
from pathlib import Path

import pytest
from runtime.frames import DRIVE, logged, write

from swapcan.cli import run


def refused(path: Path, capsys: pytest.CaptureFixture[str]) -> tuple[list[str], str]:
    """The lines on stdout, and the one line on stderr."""
    assert run(["decode", str(path)]) == 2
    out, errors = capsys.readouterr()
    assert errors.count("\n") == 1
    assert errors.startswith(f"swapcan: {path}: ")
    return out.splitlines(), errors.removeprefix(f"swapcan: {path}: ").rstrip()


@pytest.mark.parametrize("name", ["absent.blf", "absent.db", "absent.asc.gz"])
def test_an_absent_log_is_one_line_and_stays_absent(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert refused(tmp_path / name, capsys) == ([], os.strerror(errno.ENOENT))
    assert not (tmp_path / name).exists()


@pytest.mark.parametrize("name", ["drive.txt", "drive"])
def test_an_unknown_suffix_is_one_line_that_names_the_known_ones(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_text("")
    _, text = refused(tmp_path / name, capsys)
    kinds = ".asc, .blf, .csv, .db, .log, .mf4, .trc"
    assert text == f"no log of a known kind; known are {kinds}"


def test_a_folder_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "drive.asc").mkdir()
    refused(tmp_path / "drive.asc", capsys)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root reads all")
def test_an_unreadable_log_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path / "drive.asc", DRIVE).chmod(0)
    assert refused(tmp_path / "drive.asc", capsys) == ([], os.strerror(errno.EACCES))


@pytest.mark.parametrize("suffix", ["csv", "log", "trc"])
def test_frames_before_a_damaged_line_are_printed_and_counted(
    suffix: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / f"drive.{suffix}", DRIVE[:3])
    with path.open("a") as log:
        log.write("rubbish rubbish\n")
    lines, text = refused(path, capsys)
    assert len(lines) == 3
    assert text.startswith("damaged at ")
    assert "; read: frames 3, decoded 2, unknown 0 " in text


def test_a_blf_that_was_cut_short_says_so_after_its_frames(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # Incompressible payloads, so that a cut file still has whole frames in its compressed part.
    source = random.Random(3)
    frames = [logged(number, 0x18C1D0F3, source.randbytes(8).hex()) for number in range(400)]
    path = write(tmp_path / "drive.blf", frames)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    lines, text = refused(path, capsys)
    assert 0 < len(lines) < 400
    assert text.startswith(f"damaged at byte {len(whole) // 2}: the file ends within a container")
    assert f"lost: {len(whole) - len(whole) // 2:,} bytes; read: " in text
    assert f"frames {len(lines)}, decoded {len(lines)}," in text


@pytest.mark.parametrize("size", [0, 20, 100, 150, 170])
def test_a_blf_cut_in_its_headers_is_one_line(
    size: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "drive.blf", DRIVE)
    path.write_bytes(path.read_bytes()[:size])
    lines, text = refused(path, capsys)
    assert lines == []
    assert re.match(r"damaged at byte \d+: .*; lost: \d+ bytes; read: frames 0, ", text)


@pytest.mark.parametrize("suffix", ["asc", "blf", "csv", "db", "log", "trc", "asc.gz", "mf4"])
def test_a_file_of_something_else_is_one_line(
    suffix: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"drive.{suffix}"
    path.write_bytes(bytes(range(256)) * 8)
    assert refused(path, capsys)[0] == []


def test_a_database_with_empty_rows_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "drive.db", DRIVE[:1])
    connection = sqlite3.connect(path)
    with connection:
        connection.execute("INSERT INTO messages VALUES (NULL, NULL, 1, 0, 0, 8, x'00')")
    connection.close()
    lines, text = refused(path, capsys)
    assert len(lines) == 1
    assert text.startswith("damaged at frame 2: a frame without identifier or time; lost: all ")
    assert "; read: frames 1, decoded 1," in text


@pytest.mark.parametrize("suffix", ["asc", "blf", "csv", "log", "trc"])
def test_a_log_without_frames_is_no_error(
    suffix: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / f"drive.{suffix}", [])
    assert run(["decode", str(path)]) == 0
    out, errors = capsys.readouterr()
    assert out == ""
    assert errors.startswith("swapcan: frames 0, decoded 0, ")
