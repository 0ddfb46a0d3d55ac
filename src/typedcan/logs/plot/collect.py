"""Reads a log once and keeps of it what a plot shows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from typedcan.logs.checks import Checks, taken
from typedcan.logs.columns import MessageColumns, SignalInfo
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock
from typedcan.logs.part import ALL, LogPart, Window
from typedcan.logs.plan import Mode, SelectionError
from typedcan.logs.plot.heat import HeatMap
from typedcan.logs.plot.model import Band, Curve, Heat, Plot
from typedcan.logs.plot.names import SignalName
from typedcan.logs.plot.track import Track
from typedcan.logs.protocol import Protocol
from typedcan.logs.transfers import CycleCounts, CycleTable, ReadingColumns, Readings
from typedcan.model.checksums.methods import Algorithm
from typedcan.model.checksums.registry import Given
from typedcan.shell.printing import printable

_ABSOLUTE = 1e8
"""Time stamps from here on count from 1970."""

Watch = Callable[[int, int], None]
"""Is told, now and then, how many bytes of the log are read, and how many frames."""

Channel = int | str | None


@dataclass(frozen=True, slots=True)
class PlotRequest:
    """What to plot.

    Parameters
    ----------
    protocol
        What the log is decoded by.
    signals
        Names of messages and signals.
    readings
        What is shown as heat maps.
    window
        The part of the log.
    algorithms
        What computes checksums that are not known here, as `typedcan.wire.codec.Codec` has it.
    """

    protocol: Protocol
    signals: Sequence[SignalName] = ()
    readings: Sequence[Readings] = ()
    window: Window = ALL
    algorithms: Given = field(default_factory=dict[str, Algorithm | str])


def read_plot(path: Path, request: PlotRequest, watch: Watch | None = None) -> Plot:
    """Read a log, and keep what is to be shown.

    Parameters
    ----------
    path
        A log as `typedcan.logs.read.open_log` takes it. A damaged one gives what it has.
    request
        What to show.
    watch
        Is told how far it is.

    Raises
    ------
    LogError
        The log cannot be opened.
    SelectionError
        Readings are asked for, and the protocol has not their messages.
    TimeError
        The part of the log is given by dates, and the log has none.
    """
    wanted = _wanted(request)
    protocol = request.protocol
    decoder = Decoder(
        protocol.messages, mode=Mode.LABELS, reserved=protocol.reserved, wanted=wanted
    )
    checks = Checks(protocol, algorithms=request.algorithms)
    clock = _Clock()
    collection = _Collection(request, clock)
    with LogPart(path, window=request.window) as log:
        for block in clock.watched(log, watch):
            clock.shown(block)
            collection.add(checks.take(decoder.decode(block)).messages)
        faults = checks.finish()
        damage = log.damage
        log.check_found()
    curves, bands, heats = collection.finish()
    return Plot(
        title=printable(path.name),
        begin=clock.origin if clock.origin >= _ABSOLUTE else None,
        start=clock.start,
        end=max(clock.end, clock.start),
        curves=tuple(curves),
        bands=tuple(bands),
        heats=tuple(heats),
        absent=tuple(collection.absent()),
        cycles=collection.cycles,
        refused=faults.length.total() + faults.checksum.total(),
        damage=damage,
    )


def _wanted(request: PlotRequest) -> dict[str, list[str] | None]:
    wanted: dict[str, list[str] | None] = {}
    known = {message.name for message in request.protocol.messages}
    for message, signal in request.signals:
        wanted[message] = [*(wanted.get(message) or []), signal]
    for readings in request.readings:
        for name in (readings.message, readings.totals):
            if name not in known:
                raise SelectionError(f"the DBC has no {name}, which {readings.name} are made of")
            wanted[name] = None
    return wanted


class _Clock:
    """When the log begins, and the part of it that is shown; 0 is the log's first frame."""

    def __init__(self) -> None:
        self.origin = 0.0
        self.start = 0.0
        self.end = 0.0
        self._begun = self._is_shown = False

    def watched(self, log: LogPart, watch: Watch | None) -> Iterator[FrameBlock]:
        """The blocks of the log; notes when it begins, and says how far it is."""
        frames = 0
        for block in log:
            if not self._begun:
                self.origin = log.first
                self._begun = True
            yield block
            frames += len(block)
            if watch is not None:
                watch(log.position, frames)

    def shown(self, block: FrameBlock) -> None:
        """Note that these frames are shown."""
        first, last = float(block.timestamp.min()), float(block.timestamp.max())
        if not self._is_shown:
            self.start, self.end = first - self.origin, last - self.origin
            self._is_shown = True
        self.start = min(self.start, first - self.origin)
        self.end = max(self.end, last - self.origin)


class _Collection:
    """Tracks of signals and heat maps, by channel."""

    def __init__(self, request: PlotRequest, clock: _Clock) -> None:
        self._request = request
        self._clock = clock
        self._tracks: dict[SignalName, dict[Channel, Track]] = {
            name: {} for name in request.signals
        }
        self._cells = ReadingColumns(request.readings)
        self._maps: dict[tuple[str, Channel], HeatMap] = {}
        self._readings: dict[tuple[str, Channel], Readings] = {}
        self._steps: dict[str, float] = {}

    def add(self, messages: dict[str, MessageColumns]) -> None:
        """Take the messages of a block."""
        for name, tracks in self._tracks.items():
            if name[0] in messages:
                self._add_signal(name, tracks, messages[name[0]])
        for readings in self._request.readings:
            if readings.message in messages:
                info = messages[readings.message].columns[readings.items[0]].signal
                self._steps[readings.name] = info.factor
        if self._request.readings:
            self._add_cycles(self._cells.add(messages))

    @property
    def cycles(self) -> dict[str, CycleCounts]:
        """What became of the cycles, by name of the readings."""
        return self._cells.counts

    def absent(self) -> list[str]:
        """The signals that were asked for, and have not one frame."""
        return [signal for (_, signal), tracks in self._tracks.items() if not tracks]

    def finish(self) -> tuple[list[Curve], list[Band], list[Heat]]:
        """What is to be drawn."""
        end = self._clock.end
        curves: list[Curve] = []
        bands: list[Band] = []
        for (_, signal), tracks in self._tracks.items():
            for channel, track in tracks.items():
                title = _title(signal, channel, alone=len(tracks) == 1)
                if track.info.encoded:
                    bands.append(track.band(end, title))
                else:
                    curves.append(track.curve(end, title))
        self._add_cycles(self._cells.finish())
        return curves, bands, self._heats()

    def _heats(self) -> list[Heat]:
        found: list[Heat] = []
        for readings in self._request.readings:
            own = [key for key in self._maps if self._readings[key] == readings]
            for key in own:
                name = key[0].replace("_", " ")
                title = _title(name, key[1], alone=len({channel for _, channel in own}) == 1)
                found.append(self._maps[key].heat(title, self._steps[readings.name]))
        return found

    def _add_signal(
        self, name: SignalName, tracks: dict[Channel, Track], columns: MessageColumns
    ) -> None:
        column = columns.columns.get(name[1])
        if column is None:
            return
        time = columns.timestamp - self._clock.origin
        channel = columns.channel
        for number in np.unique(channel).tolist():
            key = columns.block.channels[number]
            if key not in tracks:
                tracks[key] = self._track(name, column.signal)
            own = channel == number
            tracks[key].add(time[own], column if own.all() else taken(column, own))

    def _track(self, name: SignalName, info: SignalInfo) -> Track:
        protocol = self._request.protocol
        message = next(each for each in protocol.messages if each.name == name[0])
        branch = message.signal(name[1]).selectors
        period = None if branch else protocol.periods.get(name[0])
        return Track(info, protocol.reserved.get(name, {}), period, self._clock.start)

    def _add_cycles(self, tables: list[CycleTable]) -> None:
        for table in tables:
            key = table.name, table.channel
            if key not in self._maps:
                self._maps[key] = HeatMap(table.readings, table.columns, self._clock.origin)
                self._readings[key] = table.readings
            self._maps[key].add(table)


def _title(name: str, channel: Channel, *, alone: bool) -> str:
    return name if alone or channel is None else f"{name} (channel {channel})"
