"""The frames of a log one by one, as python-can has them on a bus."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import can

from typedcan.logs.frames import FrameBlock, FrameFlag

_EXTENDED = int(FrameFlag.EXTENDED)
_REMOTE = int(FrameFlag.REMOTE)
_ERROR = int(FrameFlag.ERROR)
_FD = int(FrameFlag.FD)
_BIT_RATE_SWITCH = int(FrameFlag.BIT_RATE_SWITCH)
_ERROR_STATE = int(FrameFlag.ERROR_STATE)
_SENT = int(FrameFlag.SENT)


def frames_of(blocks: Iterable[FrameBlock]) -> Iterator[can.Message]:
    """Each frame of some blocks, in their order."""
    for block in blocks:
        rows = zip(
            block.timestamp.tolist(),
            block.frame_id.tolist(),
            block.flags.tolist(),
            block.channel.tolist(),
            block.length.tolist(),
            strict=True,
        )
        data, width = block.data.tobytes(), block.data.shape[1]
        for row, (timestamp, frame_id, flags, channel, length) in enumerate(rows):
            is_remote = bool(flags & _REMOTE)
            yield can.Message(
                timestamp=timestamp,
                arbitration_id=frame_id,
                is_extended_id=bool(flags & _EXTENDED),
                is_remote_frame=is_remote,
                is_error_frame=bool(flags & _ERROR),
                channel=block.channels[channel],
                dlc=length,
                data=b"" if is_remote else data[row * width : row * width + length],
                is_fd=bool(flags & _FD),
                is_rx=not flags & _SENT,
                bitrate_switch=bool(flags & _BIT_RATE_SWITCH),
                error_state_indicator=bool(flags & _ERROR_STATE),
            )
