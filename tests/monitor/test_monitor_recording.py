"""Recording: in every format that python-can writes, complete, and never over another file."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest
from monitor.monitored import Monitored, frame

from typedcan.shell.recording import RecordingError, free_name


def recorded(path: Path) -> list[tuple[int, bytes]]:
    """Identifiers and data of the frames in a log, by python-can's own readers."""
    with can.LogReader(path) as log:
        return [(each.arbitration_id, bytes(each.data)) for each in log]


@pytest.mark.parametrize("suffix", [".asc", ".blf", ".csv", ".db", ".log", ".trc", ".asc.gz"])
def test_everything_heard_while_recording_is_in_the_file(
    suffix: str, monitored: Monitored, tmp_path: Path
) -> None:
    path = tmp_path / f"drive{suffix}"
    before, *during, after = (frame("B2V_ST2", 1000 + n / 10, SOC=n) for n in range(10))
    during.append(can.Message(arbitration_id=0x18FEF100, data=b"\x01", timestamp=1000.85))
    monitored.hear(before)
    monitored.session.record(path)
    monitored.hear(*during)
    status = monitored.session.status()
    assert (status.recording, status.recorded) == (path, 9)
    monitored.session.stop_recording()
    monitored.hear(after)
    assert recorded(path) == [(each.arbitration_id, bytes(each.data)) for each in during]
    assert str(monitored.session.status().ended) == f"{path}: recorded 9 frames"


@pytest.mark.parametrize("suffix", [".asc", ".blf", ".csv", ".db", ".log", ".trc"])
@pytest.mark.parametrize("channel", [None, 3, "can0", "adapter-4294967295", "-"])
def test_the_name_of_the_channel_is_no_reason_to_lose_a_frame(
    channel: str | int | None, suffix: str, monitored: Monitored, tmp_path: Path
) -> None:
    path = tmp_path / f"drive{suffix}"
    heard = frame("B2V_ST2", 1000, SOC=80)
    heard.channel = channel
    monitored.session.record(path)
    monitored.hear(heard)
    monitored.session.stop_recording()
    assert recorded(path) == [(heard.arbitration_id, bytes(heard.data))]


def test_a_file_that_is_there_is_not_touched(monitored: Monitored, tmp_path: Path) -> None:
    path = tmp_path / "drive.blf"
    path.write_bytes(b"of another day")
    with pytest.raises(RecordingError, match="is there already, choose another name"):
        monitored.session.record(path)
    assert path.read_bytes() == b"of another day"


@pytest.mark.parametrize("name", ["drive.xyz", "drive", "drive.blf.gz", "drive.xyz.gz"])
def test_a_format_that_nobody_writes_is_refused_and_leaves_no_file(
    name: str, monitored: Monitored, tmp_path: Path
) -> None:
    with pytest.raises(RecordingError, match=name) as caught:
        monitored.session.record(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []
    assert monitored.session.status().recording is None


def test_a_folder_that_is_not_there_is_one_line(monitored: Monitored, tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=f"cannot be written: {os.strerror(errno.ENOENT)}"):
        monitored.session.record(tmp_path / "gone" / "drive.blf")


@contextmanager
def full_disk(size: int) -> Iterator[None]:
    """Let no file grow beyond so many bytes, which fails as a full disk does."""
    import resource

    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit for the size of files")
@pytest.mark.parametrize("suffix", [".blf", ".log", ".db"])
def test_a_full_disk_ends_the_recording_and_nothing_else(
    suffix: str, monitored: Monitored, tmp_path: Path
) -> None:
    path = tmp_path / f"drive{suffix}"
    with full_disk(16384):
        monitored.session.record(path)
        for n in range(3000):
            monitored.hear(frame("B2V_ST2", n / 10, SOC=n % 100, Current=n))
        monitored.session.stop_recording()
    ended = monitored.session.status().ended
    assert ended
    assert ended.problem
    assert str(path) in ended.problem
    assert monitored.at(300.0).totals.frames == 3000


def test_the_next_free_name_is_proposed(tmp_path: Path) -> None:
    assert free_name(tmp_path, "swapcan").name == "swapcan-1.blf"
    (tmp_path / "swapcan-1.blf").touch()
    assert free_name(tmp_path, "swapcan").name == "swapcan-2.blf"
