"""Records of channels whose names end in long numbers, such as serial numbers of adapters."""

from __future__ import annotations

from pathlib import Path

import can
import pytest

from typedcan.shell.recording import Recording

NAME = "adapter-827551260"


@pytest.mark.parametrize(("suffix", "channel"), [(".log", NAME), (".blf", 0)])
def test_a_name_that_ends_in_a_long_number_is_kept_where_the_format_has_names(
    suffix: str, channel: str | int, tmp_path: Path
) -> None:
    path = tmp_path / f"record{suffix}"
    recording = Recording(path)
    recording.write(
        can.Message(timestamp=1.0, arbitration_id=0x1882D0F3, data=bytes(8), channel=NAME)
    )
    recording.close()
    with can.LogReader(path) as reader:
        assert [frame.channel for frame in reader] == [channel]
