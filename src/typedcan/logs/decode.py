"""Blocks of frames to columns of signals, for the messages of any protocol."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.buffers import Buffers
from typedcan.logs.columns import Column, Counts, DecodedBlock, MessageColumns, SignalInfo
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.identifiers import Identifiers, groups, split_key
from typedcan.logs.kernel import FRAMES, Values, bytes_of, values_of
from typedcan.logs.multiplexing import Presence
from typedcan.logs.plan import SHORT, MessagePlan, Mode, Reserved, SelectionError, plan_of
from typedcan.logs.wide import wide_values
from typedcan.model.j1939 import ByPgn
from typedcan.model.protocol import Message

_BUFFER = 256

Wanted = Mapping[str, Collection[str] | None]
"""Names of messages, and of their signals or None for all."""


class Decoder:
    """Decodes block after block of frames into the same memory.

    What `decode` returns holds until it is called again; copy what is to last longer. Not for
    several threads at once.

    Parameters
    ----------
    messages
        Of the model of a protocol. Of two with the same identifier of the same width the later
        one counts, as in cantools. By its PGN a frame counts that is no other message.
    mode
        What the columns hold.
    reserved
        Raw codes that are no value, by names of message and signal.
    wanted
        The messages and signals to decode, None for all.
    frame_id_mask
        Bits of identifiers that count.

    Raises
    ------
    SelectionError
        A wanted message or signal is not in the database.
    ReservedCodeError
        A reserved code is none that its signal can have.
    """

    def __init__(
        self,
        messages: Iterable[Message],
        *,
        mode: Mode = Mode.PHYSICAL,
        reserved: Reserved | None = None,
        wanted: Wanted | None = None,
        frame_id_mask: int = 0xFFFFFFFF,
    ) -> None:
        messages = tuple(messages)
        known = {
            (message.frame_id & frame_id_mask, message.extended): message for message in messages
        }
        names = {message.name for message in messages}
        for name in wanted or ():
            if name not in names:
                raise SelectionError(f"there is no message {name!r} in the database")
        asked = [m for m in known.values() if wanted is None or m.name in wanted]
        others = [m for m in known.values() if wanted is not None and m.name not in wanted]
        self._plans = [
            plan_of(message, mode, reserved, wanted[message.name] if wanted else None)
            for message in asked
        ]
        self._identifiers = Identifiers(
            [(message.frame_id, message.extended) for message in (*asked, *others)],
            frame_id_mask,
            ByPgn((message, place) for place, message in enumerate((*asked, *others))),
        )
        self._known = len(known)
        self._buffers = Buffers()

    def decode(self, block: FrameBlock) -> DecodedBlock:
        """Decode the data frames of a block that have a known identifier and enough bytes."""
        counts = Counts(frames=len(block))
        rows, bounds = groups(self._identifiers.places(block), self._known)
        asked = bounds[len(self._plans)]
        counts.unwanted = bounds[self._known] - asked
        unknown = rows[bounds[self._known] :]
        if len(unknown):
            keys = self._identifiers.keys(block.frame_id[unknown], block.flags[unknown])
            _count_unknown(keys, counts)
        shortest = int(block.length.min(initial=0xFF))
        messages: dict[str, MessageColumns] = {}
        # Floats in random bytes overflow or are no numbers; cantools hands them on as well.
        with np.errstate(all="ignore"):
            # Rows shorter than this buffer are copied where an operand is a number per row, which
            # costs more than the arithmetic. Leaving errstate restores the size.
            np.setbufsize(_BUFFER)
            for place, plan in enumerate(self._plans):
                own = rows[bounds[place] : bounds[place + 1]]
                if len(own) and shortest < plan.length:
                    own = _long_enough(plan, block, own, counts)
                if not len(own):
                    continue
                messages[plan.name] = self._message(place, plan, block, own, counts)
        return DecodedBlock(messages, counts)

    def _message(
        self,
        place: int,
        plan: MessagePlan,
        block: FrameBlock,
        rows: NDArray[np.int64],
        counts: Counts,
    ) -> MessageColumns:
        """Decode the frames of one message."""
        payload = self._payload(plan, block, rows)
        decoded = self._values(place, plan, payload, len(rows))
        selecting = {name: decoded[raw][0] for name, raw in plan.selecting.items()}
        presence = Presence(plan.multiplexing, selecting)
        columns = {
            info.name: _column(info, decoded[info.name], presence.of(info.name))
            for info in plan.columns
        }
        counts.decoded[plan.name] += len(rows)
        if lost := presence.without_branch():
            counts.without_branch[plan.name] += lost
        return MessageColumns(
            plan.name, plan.frame_id, plan.is_extended, block, rows, columns, plan.by_pgn
        )

    def _payload(
        self, plan: MessagePlan, block: FrameBlock, rows: NDArray[np.int64]
    ) -> NDArray[np.uint8]:
        """The payloads of those rows, one behind the other, and what rounds their number up."""
        size = block.data.shape[1] if plan.length > SHORT else SHORT
        words = block.data.view(np.uint64)[:, : size // 8]
        frames = -len(rows) % FRAMES + len(rows)
        payload = self._buffers.array("payload", (frames, size // 8), words.dtype)
        if words.shape[1] * 8 == block.data.shape[1]:
            # With its default mode, take would go through a copy.
            np.take(words, rows, axis=0, out=payload[: len(rows)], mode="clip")
        else:
            payload[: len(rows), 0] = words[:, 0][rows]
        return payload.view(np.uint8)

    def _values(
        self, place: int, plan: MessagePlan, payload: NDArray[np.uint8], frames: int
    ) -> dict[str, Values]:
        decoded: dict[str, Values] = {}
        loaded = bytes_of(plan.loads, payload, self._buffers)
        for level, stack in enumerate(plan.stacks):
            values, states, valid = values_of(stack, payload, loaded, self._buffers, (place, level))
            none = (None,) * len(stack.names)
            rows = zip(
                values[:, :frames],
                none if states is None else states[:, :frames],
                none if valid is None else valid[:, :frames],
                strict=True,
            )
            decoded.update(zip(stack.names, rows, strict=True))
        for wide in plan.wide:
            decoded[wide.name] = wide_values(wide, payload[:frames])
        return decoded


def _column(info: SignalInfo, values: Values, there: NDArray[np.bool_] | None) -> Column:
    numbers, states, valid = values
    if there is None:
        return Column(info, numbers, valid, states)
    if states is None or valid is None:
        return Column(info, numbers, there, None)
    return Column(info, numbers, np.logical_and(valid, there, out=valid), states * there)


def _long_enough(
    plan: MessagePlan, block: FrameBlock, rows: NDArray[np.int64], counts: Counts
) -> NDArray[np.int64]:
    """The rows whose frames have all bytes of the message; the others are counted."""
    if plan.length > block.data.shape[1]:
        kept = rows[:0]
    else:
        kept = rows[block.length[rows] >= plan.length]
    if len(kept) < len(rows):
        counts.too_short[plan.name] += len(rows) - len(kept)
    return kept


def _count_unknown(keys: NDArray[np.uint32], counts: Counts) -> None:
    for key, frames in zip(*np.unique_counts(keys), strict=True):
        identifier, kind = split_key(int(key))
        if FrameFlag.ERROR in kind:
            counts.error += int(frames)
        elif FrameFlag.REMOTE in kind:
            counts.remote += int(frames)
        else:
            counts.unknown[identifier, FrameFlag.EXTENDED in kind] += int(frames)
