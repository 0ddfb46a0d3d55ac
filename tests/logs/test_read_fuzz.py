"""Whatever stands in a file, every reader ends, within bounds, with frames that a bus may have."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from logs.log_files import rows_in
from logs.test_read_other_programs import BUSMASTER, CASES
from logs.test_read_pcap import PACKETS, pcap, pcapng

from typedcan.logs.frames import FrameFlag as Flag
from typedcan.logs.read import LogError, open_log

MOST = 30_000_000
SEEDS = [
    *(path.read_bytes()[:3000] for path in sorted(CASES.iterdir())),
    BUSMASTER.format(mode="SYSTEM", times=["1:0:0:0000", "1:0:0:1", "1:0:1:0000"]).encode(),
    pcap(PACKETS),
    pcapng(PACKETS),
    CASES.joinpath("asc-relative.asc").read_text().encode("utf-16"),
]


@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
@pytest.mark.parametrize("seed", range(len(SEEDS)))
def test_no_content_leads_astray(tmp_path: Path, seed: int, data: st.DataObject) -> None:
    content = SEEDS[seed]
    for _ in range(data.draw(st.integers(0, 6))):
        place = data.draw(st.integers(0, len(content)))
        odd = data.draw(st.binary(max_size=6) | st.sampled_from([b"9" * 40, b"\n", b"-1", b"nan"]))
        content = content[:place] + odd + content[place + data.draw(st.integers(0, 6)) :]
    path = tmp_path / "bus.bin"
    path.write_bytes(content)
    tracemalloc.start()
    try:
        with open_log(path, 50) as source:
            rows = rows_in(source)
    except LogError:
        return
    finally:
        used = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    assert used < MOST
    assert len(rows) <= len(content)
    for time, frame_id, flags, _, length, _ in rows:
        assert time == time
        assert frame_id < 2**29
        assert length <= (64 if flags & (Flag.FD | Flag.REMOTE) else 8)
