"""Records of frames whose time stamps cannot be, as some drivers give them."""

from __future__ import annotations

import math
import time
from pathlib import Path

import can
import pytest

from typedcan.shell.recording import Recording, RecordingError

SUFFIXES = (".asc", ".blf", ".csv", ".db", ".log", ".trc")
IMPOSSIBLE = (math.inf, -math.inf, math.nan, -1.0, -1e300, 1e300, 2.0**32)


def frame(number: int, second: float) -> can.Message:
    return can.Message(timestamp=second, arbitration_id=0x1882D0F0 + number, data=bytes(8))


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("second", IMPOSSIBLE)
def test_a_frame_with_an_impossible_time_is_kept_with_the_one_of_its_arrival(
    second: float, suffix: str, tmp_path: Path
) -> None:
    path = tmp_path / f"drive{suffix}"
    recording = Recording(path)
    before = time.time()
    frames = [frame(0, before), frame(1, second), frame(2, second), frame(3, before + 1.0)]
    for each in frames:
        recording.write(each)
    recording.close()
    assert recording.frames == 4
    assert math.isnan(frames[1].timestamp) or frames[1].timestamp == second  # is not altered
    with can.LogReader(path) as reader:
        found = [(each.arbitration_id & 0xF, each.timestamp) for each in reader]
    assert sorted(number for number, _ in found) == [0, 1, 2, 3]
    first = dict(found)[0]
    for number in (1, 2):  # some formats count from the first frame, to the millisecond
        assert -0.002 < dict(found)[number] - first < 10.0


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("second", [0.0, 1e-9, 2.0**31, 2.0**32 - 1.0])
def test_a_time_that_can_be_is_written_as_it_is(second: float, suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"drive{suffix}"
    recording = Recording(path)
    for number, later in enumerate((0.0, 0.25)):
        recording.write(frame(number, second + later))
    recording.close()
    with can.LogReader(path) as reader:
        first, last = (each.timestamp for each in reader)
    assert last - first == pytest.approx(0.25, abs=0.001)


class Strange(Exception):
    """What no writer should raise."""


def test_what_a_format_cannot_hold_is_left_out_and_told_and_the_rest_is_recorded(
    tmp_path: Path,
) -> None:
    recording = Recording(tmp_path / "drive.trc")
    recording.write(frame(0, 1.0))
    for odd in ({"is_error_frame": True}, {"is_remote_frame": True}, {"is_fd": True}):
        recording.write(can.Message(timestamp=2.0, **odd))
    recording.write(frame(0, float("nan")))
    recording.close()
    told = list(recording.remarks())
    for what in ("1 error frames", "1 remote frames", "1 CAN FD frames", "1 frames without a time"):
        assert any(what in line for line in told), what
    with can.LogReader(tmp_path / "drive.trc") as reader:
        assert len(list(reader)) == recording.frames == 2


def test_a_frame_that_the_writer_refuses_is_counted_and_recording_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OverflowError("inf")

    recording = Recording(tmp_path / "drive.blf")
    with monkeypatch.context() as patch:
        patch.setattr(can.BLFWriter, "on_message_received", refuse)
        recording.write(frame(0, 1.0))
    recording.write(frame(0, 2.0))
    recording.close()
    assert recording.frames == 1
    assert "1 frames that the writer refuses (OverflowError: inf)" in " ".join(recording.remarks())


@pytest.mark.parametrize("error", [OSError(28, "full"), Strange()])
def test_whatever_a_writer_raises_names_the_file_in_one_line(
    error: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise error

    path = tmp_path / "drive.blf"
    recording = Recording(path)
    with monkeypatch.context() as patch:
        patch.setattr(can.BLFWriter, "on_message_received", fail)
        with pytest.raises(RecordingError, match=r"drive\.blf: \S") as caught:
            recording.write(frame(0, 1.0))
        assert "\n" not in str(caught.value)
        patch.setattr(can.BLFWriter, "stop", fail)
        with pytest.raises(RecordingError, match=r"drive\.blf: \S"):
            recording.close()
    assert recording.frames == 0
