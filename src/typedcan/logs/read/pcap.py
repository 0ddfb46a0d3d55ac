"""Captures of SocketCAN, as Wireshark, tcpdump and dumpcap write them: pcap and pcapng."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.blocks import Channels
from typedcan.logs.read.columns import Columns
from typedcan.logs.read.frame import Frame
from typedcan.logs.read.pcap_blocks import BrokenCapture, Interface, Packet, packets
from typedcan.logs.read.pcap_frames import LINKS, frame_of
from typedcan.logs.read.source import BLOCK_SIZE, Damage, FileSource, LogError


class PcapSource(FileSource):
    """A capture of SocketCAN. What it holds of other networks is passed over.

    Parameters
    ----------
    path
        The capture.
    block_size
        Frames in a block.

    Raises
    ------
    OSError
        Where the file cannot be opened.
    LogError
        Where the capture is of another network.
    """

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size)
        self._check_network()
        self._file = path.open("rb")

    def _check_network(self) -> None:
        with self.path.open("rb") as file:
            try:
                links = [each.link for each in islice(packets(file), 64) if each is not None]
            except BrokenCapture:
                return
        if links and not any(isinstance(link, int) and link in LINKS for link in links):
            raise LogError(
                f"{self.path}: a capture of another network than CAN (link type {links[0]}): "
                "capture the CAN interface itself, such as can0"
            )

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in blocks."""
        channels = Channels()
        frames = self._frames(channels)
        while some := list(islice(frames, self._block_size)):
            columns = Columns(len(some))
            columns.put_frames([(row, *frame) for row, frame in enumerate(some)])
            yield columns.block(channels.known)

    def _frames(self, channels: Channels) -> Iterator[tuple[Frame, int]]:
        try:
            for packet in packets(self._file):
                self._position = min(packet.end, self._size)
                if isinstance(packet, Interface):
                    continue
                frame = self._frame(packet)
                if frame is not None:
                    yield frame, channels.index(frame.channel)
        except BrokenCapture as error:
            lost = f"{max(self._size - error.at, 0):,} bytes"
            self.damage = Damage(self.path, f"byte {error.at}", str(error), lost)
        except ValueError as error:
            lost = f"{max(self._size - self._position, 0):,} bytes"
            self.damage = Damage(self.path, f"byte {self._position}", str(error), lost)
        else:
            self._position = self._size

    def _frame(self, packet: Packet) -> Frame | None:
        try:
            frame = frame_of(packet)
        except ValueError as error:
            if self.damage is None:
                self.damage = Damage(self.path, f"byte {packet.at}", str(error), "1 packet")
            return None
        if frame is None:
            self._passed["packets of other networks"] += 1
        return frame
