"""A bus of python-can that tells what is received and sent on it, and can end what acts."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from copy import copy

import can

from typedcan.drive.frame_times import FrameTimes
from typedcan.drive.in_order import InOrder
from typedcan.model.editions import edition_of, signs_of_others, unsure_codes
from typedcan.model.errors import TypedcanError
from typedcan.node.clock import Clock, SystemClock
from typedcan.node.commanded import SentCommands
from typedcan.simulate.echoes import Echoes, Identifier, identifier_of
from typedcan.wire.acting import acting_fields, acts
from typedcan.wire.codec import Codec
from typedcan.wire.message import Message


class EndedError(TypedcanError):
    """What acts is not sent any more, since it was ended."""

    def __init__(self, kind: type[Message]) -> None:
        self.message = kind
        super().__init__(f"{kind.NAME} would act, and is not sent: what acts was ended")


class OtherEditionError(TypedcanError):
    """Another edition than the chosen one is spoken on a bus: ``edition`` is its name.

    The same code can mean the opposite there.
    """

    def __init__(self, edition: str, chosen: str, frame: can.Message) -> None:
        self.edition = edition
        number = f"0x{frame.arbitration_id:0{8 if frame.is_extended_id else 3}X}"
        super().__init__(
            f"edition {edition} is spoken on the bus: it alone has {number}; nothing that acts is"
            f" sent as {chosen or 'the usual edition'} has it"
        )


class NotingBus(can.BusABC):
    """Stands for a bus that is lent; `shutdown` leaves it open.

    An interface that gives back what was sent on it is no trouble: such frames are dropped. What
    is sent with a code that acts is kept in mind, whoever made the frame, so that
    `send_safe_codes` can end it whatever else has failed.

    Parameters
    ----------
    bus
        The bus to send and receive on.
    codec
        Of the protocol that says which codes act; checksums of safe codes are by its algorithms.
        Once another edition is recognised it is made unsure, see ``unsure`` of `Codec`.
    note
        Is told of each frame, received or sent, the latter with ``is_rx`` False, in the order of
        their times and in the thread that sends and receives. Once it raises it is told no more,
        and `failure` has the error.
    clock
        Of those who send; on a simulated one frames must have its times.
    played
        Messages that nobody else may send: ``intruder`` is one of somebody who does.
    echoes
        What was sent on the same bus before, and may still come back.

    ``may_act`` is called before a code that acts is sent, and keeps it back by raising. ``latest``
    is the last frame of others, by identifier and whether that has 29 bits; none from before the
    last code that acts. ``other_edition`` is what is wrong where a message comes that only another
    edition has than the chosen one: then no code that acts is sent any more.
    """

    def __init__(
        self,
        bus: can.BusABC,
        codec: Codec,
        note: Callable[[can.Message], object],
        *,
        clock: Clock | None = None,
        played: Collection[type[Message]] = (),
        echoes: Echoes | None = None,
    ) -> None:
        self._bus = bus
        self._clock = clock or SystemClock()
        self.played = tuple(played)
        self._times = FrameTimes(self._clock)
        self._record = InOrder(note)
        self._echoes = echoes or Echoes()
        self._codec = codec = codec.bare
        self._signs = signs_of_others(codec.protocol.model)
        # By identifier: what is matched by its PGN may be sent to several receivers.
        self._commands: dict[Identifier, SentCommands] = {}
        self._acting = frozenset(kind for kind in codec.protocol.messages if acting_fields(kind))
        self._trouble: dict[str, tuple[float, Exception]] = {}  # by direction
        self.may_act: Callable[[], object] = lambda: None
        self.latest: dict[Identifier, can.Message] = {}
        self.has_acted = False
        """Whether a code that acts was ever sent."""
        self.has_ended = False
        """Whether what acts was ended: then no code that acts is sent any more."""
        self.commanded_at = -math.inf
        """When the bus took the last message that can act, by the clock."""
        self.intruder: type[Message] | None = None
        self.other_edition: OtherEditionError | None = None
        self.channel_info = bus.channel_info
        super().__init__(channel=bus.channel_info)

    @property
    def acting(self) -> tuple[Message, ...]:
        """The messages that were sent last with a code that acts, as far as is known."""
        commands = tuple(self._commands.values())  # another thread may send a first one meanwhile
        return tuple(message for each in commands for message in each.acting)

    @property
    def failure(self) -> BaseException | None:
        """What ``note`` has raised."""
        return self._record.failure

    @property
    def trouble(self) -> tuple[float, Exception] | None:
        """Since when, by the clock, the bus refuses to send or to receive, and why."""
        return min(tuple(self._trouble.values()), key=lambda each: each[0], default=None)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame; raises as the bus does, and `EndedError` or as ``may_act``."""
        command = self._command_in(msg)
        if command is None:
            self._record.take(*self._sent(msg, timeout))
            return
        moves = acts(command)
        if moves:
            self.may_act()
            if self.other_edition:
                raise self.other_edition
            if self.has_ended:
                raise EndedError(type(command))
        commands = self._commands.setdefault(identifier_of(msg), SentCommands())
        obeyed = self._is_obeyed(msg, command, commands.last(type(command)))
        commands.begin(command)
        if self.acting:
            self.has_acted = True
            self.latest.clear()
        try:
            sent = self._sent(msg, timeout)
            self.commanded_at = self._clock.now()
            if obeyed:
                commands.end(command)
        finally:
            if moves and self.has_ended:  # by another thread, or by a signal, in the meantime
                self.send_safe_codes()
        self._record.take(*sent)

    def send_safe_codes(self) -> BaseException | None:
        """Send each message that can act and was sent, with its safe codes; none acts after that.

        Any thread may, in the middle of anything: nothing is received, noted or waited for.
        Returns what the first one raised that could not be sent; the others are sent all the same.
        """
        self.has_ended = True
        failure: BaseException | None = None
        for identifier, commands in tuple(self._commands.items()):
            for message in commands.all:
                try:
                    sent = self._sent(self._safe_frame(message, identifier, commands), 0)
                except BaseException as error:  # noqa: BLE001 - drivers raise what they like
                    failure = failure or error
                else:
                    self.commanded_at = self._clock.now()
                    commands.made_safe(message)
                    self._record.lay_aside(*sent)
        return failure

    def _command_in(self, frame: can.Message) -> Message | None:
        """The message that can act in a frame, if there is one."""
        number, extended = identifier_of(frame)
        if self._codec.kind(number, extended=extended) not in self._acting:
            return None
        try:
            return self._codec.decode(number, bytes(frame.data), verify=False, extended=extended)
        except TypedcanError:
            return None

    def _is_obeyed(self, frame: can.Message, command: Message, before: Message | None) -> bool:
        """Whether its receiver has no reason to pass over a frame: checksum and counter go on."""
        number, extended = identifier_of(frame)
        try:
            self._codec.decode(number, bytes(frame.data), extended=extended)
        except TypedcanError:
            return False
        counter = type(command).COUNTER
        if counter is None or before is None:
            return True
        field = command.field_of(counter.signal).name
        return bool(getattr(command, field) != getattr(before, field))

    def _safe_frame(
        self, message: Message, identifier: Identifier, commands: SentCommands
    ) -> can.Message:
        kind = type(message)
        counter = None
        if kind.COUNTER:
            last = getattr(message, kind.field_of(kind.COUNTER.signal).name)
            counter = kind.COUNTER.after(last) if isinstance(last, int) else kind.COUNTER.first
        frame = self._codec.frame(message, counter=counter, safe=True)
        frame.arbitration_id, extended = identifier
        data = bytes(frame.data)
        sent = self._codec.decode(frame.arbitration_id, data, verify=False, extended=extended)
        commands.begin(sent)
        return frame

    def _sent(self, msg: can.Message, timeout: float | None) -> tuple[can.Message, float]:
        """Send a frame; what there is to note of it, and its time."""
        try:
            self._bus.send(msg, timeout)
        except Exception as error:
            self._trouble.setdefault("send", (self._clock.now(), error))
            raise
        self._trouble.pop("send", None)
        self._echoes.sent(msg, self._clock.now())
        sent = copy(msg)
        sent.is_rx = False
        return sent, self._times.sent()

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        try:
            frame = self._bus.recv(timeout)
            while frame and self._echoes.is_one(frame, self._clock.now()):
                frame = self._bus.recv(0)
        except Exception as error:
            self._trouble.setdefault("receive", (self._clock.now(), error))
            raise
        self._trouble.pop("receive", None)
        if frame is None:
            self._echoes.heard_all(self._clock.now())
            return None, False
        self.latest[identifier_of(frame)] = frame
        if identifier_of(frame) in self._signs:
            self._doubt(frame)
        kind = self._codec.kind(frame.arbitration_id, extended=frame.is_extended_id)
        self.intruder = kind if kind in self.played else self.intruder
        received = copy(frame)
        received.is_rx = True
        self._record.take(received, self._times.received(frame))
        return frame, False

    def _doubt(self, frame: can.Message) -> None:
        """Take it that the edition that alone has a frame is spoken, and no longer the chosen."""
        protocol = self._codec.protocol.model
        if self.other_edition is None:
            edition, chosen = self._signs[identifier_of(frame)], edition_of(protocol)
            self._codec.unsure = unsure_codes(protocol)
            self.other_edition = OtherEditionError(edition, chosen, frame)

    def shutdown(self) -> None:
        """Tell of what still waits; the bus stays open."""
        if not self._is_shutdown:
            self._record.tell_all()
        super().shutdown()
