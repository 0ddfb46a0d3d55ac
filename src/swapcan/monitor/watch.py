"""What the frames of a bus amount to: pure, without a bus, a thread or a clock of its own."""

from __future__ import annotations

from collections.abc import Iterator

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_BattInfo2, B2V_Ucell
from swapcan.monitor.bus_load import BITRATE, BusLoad
from swapcan.monitor.cells import Cells
from swapcan.monitor.pack import Alarm, Pack, is_alarm_level, sections
from swapcan.monitor.picture import ForeignRow, Picture, Totals
from swapcan.monitor.rows import Seen, message_row
from swapcan.transfer import CellVoltages, Outcome, PackCode, Transfers, Vin
from swapcan.wire import Codec, Receiver
from typedcan.supervise import SupervisionEvent, Supervisor
from typedcan.supervise.snapshot import Snapshot
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

WatchEvent = SupervisionEvent | Outcome
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
    protocol, codec
        Whose messages, and what decodes them.
    bitrate
        Of the bus, for the estimate of its load.
    """

    def __init__(
        self,
        now: float,
        *,
        protocol: Protocol = PROTOCOL,
        codec: Codec | None = None,
        bitrate: float = BITRATE,
    ) -> None:
        self.protocol = protocol
        self._bitrate = bitrate
        self._receiver = Receiver(codec or Codec(protocol=protocol))
        self._last: dict[type[Message], Seen] = {}
        self._transfers = Transfers(protocol)
        self._cells = Cells()
        self._vin = ""
        self._pack_code = ""
        self.clear(now)

    def clear(self, now: float) -> None:
        """Count and measure anew from now on; what the messages said last is kept."""
        always = set(self.protocol.messages).difference(self.protocol.conditional)
        self._supervisor = Supervisor(
            self.protocol,
            self.protocol.nodes[0],
            expect=[kind for kind in always if kind.PERIOD is not None],
        )
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
        return min(self._supervisor.next_check, self._transfers.next_deadline)

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
        return (*self._supervisor.check(now), *self._transfers.expire(now))

    def picture(self, now: float) -> Picture:
        """All that is known at ``now``."""
        snapshot = self._supervisor.snapshot(now)
        known = {message.name: message for message in snapshot.messages}
        rows = tuple(
            message_row(kind, known.get(kind.NAME), self.protocol)
            for kind in self.protocol.messages
        )
        states = {row.name: row.state for row in rows}
        return Picture(
            time=now,
            protocol=self.protocol,
            totals=self._totals(now),
            messages=rows,
            pack=Pack(
                tuple(sections(self.protocol, self._last, states)),
                tuple(self._alarms(snapshot, now)),
            ),
            cells=self._cells.map(now),
            vin=self._vin,
            pack_code=self._pack_code,
            foreign=tuple(
                ForeignRow(frame_id, is_extended, int(frames), now - at)
                for (frame_id, is_extended), (frames, at) in sorted(self._foreign.items())
            ),
            last=dict(self._last),
        )

    def _take_message(self, received: Received, now: float) -> tuple[WatchEvent | Fault, ...]:
        message = received.message
        self._last[type(message)] = Seen(received, now)
        events = (*received.faults, *self._supervisor.take(received, now))
        outcomes = self._transfers.take(message, now)
        for outcome in outcomes:
            self._keep(outcome)
        if isinstance(message, B2V_Ucell):
            self._cells.take(message, now)
        elif isinstance(message, B2V_BattInfo2):
            self._cells.take_totals(message)
        return (*events, *outcomes)

    def _keep(self, outcome: Outcome) -> None:
        if isinstance(outcome, Vin):
            self._vin = outcome.text
        elif isinstance(outcome, PackCode):
            self._pack_code = outcome.text
        elif isinstance(outcome, CellVoltages):
            self._cells.take_set(outcome)

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
            foreign=counts.foreign - before.foreign - self._errors,
            errors=self._errors,
            frames_per_second=frames_per_second,
            load=load,
        )

    def _alarms(self, snapshot: Snapshot, now: float) -> Iterator[Alarm]:
        for known in snapshot.messages:
            for signal in known.signals:
                if signal.kind == "alarm" and not is_alarm_level(known.name, signal.field):
                    field = self.protocol.message(known.name).FIELDS[signal.field]
                    age = now - signal.since
                    yield Alarm(known.name, field.dbc_name, field.title, signal.text, age)
