"""What the frames of a bus amount to: pure, without a bus, a thread or a clock of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import can

from typedcan.monitor.bus_load import BusLoad
from typedcan.monitor.glance import Alarm, Glance, Known, Noticed, Seen
from typedcan.monitor.overview import OverviewGlance
from typedcan.monitor.picture import ForeignRow, Picture, Totals
from typedcan.monitor.rows import message_row
from typedcan.supervise import SupervisionEvent, Supervisor
from typedcan.supervise.snapshot import MessageSnapshot
from typedcan.wire.codec import Codec
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import FieldRef, Protocol
from typedcan.wire.receiver import Receiver

WatchEvent = SupervisionEvent | Noticed
"""What a frame, or time alone, can bring about."""

_FOREIGN = 1000
"""How many foreign identifiers are told apart; a broken bus can have any number of them."""


class Watch:
    """Takes all frames of a bus, whoever sends them, and knows what they amount to.

    Every message that has a period at all times has to come. Times are seconds of one clock that
    never goes back.

    Parameters
    ----------
    now
        When watching begins.
    codec
        What decodes the messages, those of its protocol.
    glance
        What else is shown of the protocol; without it what came over several frames.
    bitrate
        Of the bus, for the estimate of its load; without it that of all buses of the protocol.
    """

    def __init__(
        self,
        now: float,
        codec: Codec,
        *,
        glance: Glance | None = None,
        bitrate: float | None = None,
    ) -> None:
        self.protocol = codec.protocol
        self._glance: Glance = glance or OverviewGlance(codec.protocol)
        self._bitrate = bitrate or _bitrate_of(codec.protocol)
        self._receiver = Receiver(codec)
        self._last: dict[type[Message], Seen] = {}
        self._branches: dict[type[Message], dict[str, Seen]] = {}
        self.clear(now)

    def clear(self, now: float) -> None:
        """Count and measure anew from now on; what the messages said last is kept."""
        self._supervisor = Supervisor(self.protocol, None)
        self._supervisor.start(now)
        self._began = now
        self._frames = 0
        self._errors = 0
        self._before = self._receiver.counts
        self._load = BusLoad(now, self._bitrate)
        self._foreign: dict[tuple[int, bool], list[float]] = {}  # frames, and when the last came

    @property
    def frames(self) -> int:
        """How many frames came since counting began."""
        return self._frames

    @property
    def messages(self) -> int:
        """How many of them were messages of the protocol."""
        return self._receiver.counts.received - self._before.received

    @property
    def next_check(self) -> float:
        """When `check` is due; infinite for never."""
        return min(self._supervisor.next_check, self._glance.next_check)

    def take(self, frame: can.Message, now: float) -> tuple[WatchEvent | Fault, ...]:
        """What a frame that came at ``now`` brings about."""
        self._frames += 1
        self._load.add(frame, now)
        taken = self._receiver.take(frame)
        if isinstance(taken, Received):
            return self._take_message(taken, now)
        if taken is None:
            self._take_foreign(frame, now)
            return ()
        return (taken, *self._supervisor.fault(taken, now))

    def check(self, now: float) -> tuple[WatchEvent, ...]:
        """What time alone has changed up to now."""
        if now < self.next_check:
            return ()
        return (*self._supervisor.check(now), *self._glance.check(now))

    def picture(self, now: float) -> Picture:
        """All that is known at ``now``."""
        snapshot = self._supervisor.snapshot(now)
        known = tuple(zip(self.protocol.messages, snapshot.messages, strict=True))
        rows = tuple(message_row(kind, message, self.protocol) for kind, message in known)
        alarms, last = tuple(self._alarms(known, now)), dict(self._last)
        states = {row.name: row.state for row in rows}
        return Picture(
            time=now,
            protocol=self.protocol,
            totals=self._totals(now),
            messages=rows,
            alarms=alarms,
            look=self._glance.look(Known(now, last, states, alarms)),
            foreign=tuple(
                ForeignRow(frame_id, is_extended, int(frames), now - at)
                for (frame_id, is_extended), (frames, at) in sorted(self._foreign.items())
            ),
            last=last,
            branches={kind: dict(fields) for kind, fields in self._branches.items()},
        )

    def _take_message(
        self, received: Received[Message], now: float
    ) -> tuple[WatchEvent | Fault, ...]:
        message = received.message
        seen = self._last[type(message)] = Seen(received, now)
        if message.SELECTED:
            there = (name for name in message.SELECTED if getattr(message, name) is not None)
            self._branches.setdefault(type(message), {}).update(dict.fromkeys(there, seen))
        events = (*received.faults, *self._supervisor.take(received, now))
        return (*events, *self._glance.take(message, now))

    def _take_foreign(self, frame: can.Message, now: float) -> None:
        if frame.is_error_frame:
            self._errors += 1
            return
        key = (frame.arbitration_id, frame.is_extended_id)
        known = self._foreign.get(key)
        if known:
            known[0] += 1
            known[1] = now
        elif len(self._foreign) < _FOREIGN:
            self._foreign[key] = [1, now]

    def _totals(self, now: float) -> Totals:
        counts, before = self._receiver.counts, self._before
        frames_per_second, load = self._load.rates(now)
        return Totals(
            seconds=now - self._began,
            frames=self._frames,
            messages=counts.received - before.received,
            length=counts.length - before.length,
            checksum=counts.checksum - before.checksum,
            counter=counts.counter - before.counter,
            format=counts.format - before.format,
            foreign=counts.foreign - before.foreign - self._errors,
            errors=self._errors,
            frames_per_second=frames_per_second,
            load=load,
        )

    def _alarms(
        self, messages: Iterable[tuple[type[Message], MessageSnapshot]], now: float
    ) -> Iterator[Alarm]:
        for kind, known in messages:
            for signal in known.signals:
                if (
                    signal.kind == "alarm"
                    and FieldRef(kind, signal.field) not in self._glance.summed_up
                ):
                    field = kind.FIELDS[signal.field]
                    age = now - signal.since
                    yield Alarm(kind.NAME, field.dbc_name, field.title, signal.text, age)


def _bitrate_of(protocol: Protocol) -> float | None:
    """The bit rate of all its buses, in bit/s; None where none is given or they differ."""
    rates = {bus.bit_rate for bus in protocol.model.buses if bus.bit_rate > 0}
    return rates.pop() if len(rates) == 1 else None
