"""Frames made by hand, and logs of them by python-can's own writers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import can

ST2 = bytes.fromhex("c8ff5b22ffffffff")
"""B2V_ST2: SOC 200 x 0.4 %, current 8795 x 0.1 - 1000 A, the rest invalid."""


def frame(identifier: int, data: bytes, **options: Any) -> can.Message:
    """An extended data frame, if the options do not say otherwise."""
    return can.Message(arbitration_id=identifier, data=data, **options)


def st1(counter: int) -> can.Message:
    """B2V_ST1, all else 0, so that the checksum is the byte with the counter."""
    return frame(0x1881D0F3, bytes([counter, counter, 0, 0, 0, 0, 0, 0]))


def life(counter: int) -> can.Message:
    """BMS_TMS_0 with its counter in byte 6."""
    return frame(0x18FF45F4, bytes([0, 0, 0, 0, 0, 0, counter, 0]))


def live(counter: int) -> can.Message:
    """BSU_BMS_0 with its counter in byte 0."""
    return frame(0x18FFF8A7, bytes([counter, 0, 0, 0, 0, 0, 0, 0]))


FOREIGN = {
    "an_unknown_identifier": frame(0x18FEF100, bytes(8)),
    "an_identifier_that_differs_in_its_destination_only": frame(0x1882D1F3, ST2),
    "a_standard_frame_with_the_last_bits_of_the_number": frame(
        0x0F3, bytes(8), is_extended_id=False
    ),
    "a_known_number_without_the_extended_flag": frame(0x1882D0F3, ST2, is_extended_id=False),
    "a_remote_frame": can.Message(arbitration_id=0x1882D0F3, is_remote_frame=True, dlc=8),
    "an_error_frame": frame(0x1882D0F3, ST2, is_error_frame=True),
}


def logged(number: int, identifier: int, data: str, **options: Any) -> can.Message:
    """A frame a tenth of a second after the one before."""
    time = 1_700_000_000 + number / 10
    return frame(identifier, bytes.fromhex(data), timestamp=time, channel=0, **options)


DRIVE = [
    logged(0, 0x1882D0F3, "C8 FA 5B 22 FF FF BD 0B"),
    logged(1, 0x1881D0F3, "20 20 00 00 00 00 00 00"),
    logged(2, 0x1881D0F3, "00 21 00 00 00 00 00 00"),
    logged(3, 0x1882D0F3, "00 00 00 00 00 00 00"),
    logged(4, 0x123, "00", is_extended_id=False),
    logged(5, 0x18FEF100, "00 00"),
    logged(6, 0x1881D0F3, "20 20 00 00 00 00 00 00"),
    logged(7, 0x1881D0F3, "2F 2F 00 00 00 00 00 00"),
]
"""Good, a wrong checksum, a wrong length, two foreign ones, a repeated counter, an invalid one."""


def write(path: Path, frames: list[can.Message]) -> Path:
    """Write a log in the format of its suffix."""
    with can.Logger(str(path)) as log:
        for each in frames:
            log.on_message_received(each)
    return path
