"""What the benchmarks of live nodes send, and how."""

from __future__ import annotations

import dataclasses
import itertools
import random
import threading
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import can
from defaults import default_of

import swapcan
from swapcan import Message
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_BattInfo2, B2V_Ucell, Manufacturer
from swapcan.transfer import split_cell_voltages, split_pack_code, split_probe_temperatures
from typedcan.wire.fields import PhysicalField

_CELLS = {csc: [3.3 + n / 1000 for n in range(12)] for csc in range(1, 19)}
_PROBES = {csc: [25.0] * 6 for csc in range(1, 19)}
_READINGS: list[Message] = [*split_cell_voltages(_CELLS), *split_probe_temperatures(_PROBES)]
_CODE = split_pack_code("001PB0A1234567890123ABCD", Manufacturer.CATL)
_TOTALS = B2V_BattInfo2(tot_csc_num=18, tot_cell_num=18 * 12, tot_temp_num=18 * 6)
_FRAMES = 17 * 1200
_CHANNEL = "swapcan-benchmark"


def open_bus() -> can.BusABC:
    """Another bus on the channel of the benchmarks."""
    return can.Bus(_CHANNEL, "virtual", ignore_config=True)


def in_turn(*, changing: bool) -> list[can.Message]:
    """All messages that a VCU receives, in turn; those of a transfer are complete."""
    readings = itertools.cycle(_READINGS)
    known = {type(message) for message in (*_READINGS, *_CODE, _TOTALS)}
    others = [default_of(kind) for kind in PROTOCOL.received_by("VCU") if kind not in known]
    rounds = [(*others, *_CODE, _TOTALS, next(readings)) for _ in range(_FRAMES // 17)]
    return _frames(itertools.chain.from_iterable(rounds), changing=changing)


def of_a_pack(*, changing: bool) -> list[can.Message]:
    """What a pack of 18 CSCs sends by itself, as often as it does: mostly cell voltages."""
    slow = [kind for kind in PROTOCOL.received_by("VCU") if kind.PERIOD == 0.1]
    steady = [
        default_of(kind)
        for kind in slow
        if kind not in PROTOCOL.conditional and kind is not B2V_Ucell
    ]
    cells = [message for message in _READINGS if isinstance(message, B2V_Ucell)]
    probes = [message for message in _READINGS if not isinstance(message, B2V_Ucell)]
    second: list[Message] = []
    for tenth in range(10):
        second += [_TOTALS, *steady, *cells, *(probes if tenth % 2 else ())]
    return _frames(itertools.islice(itertools.cycle(second), _FRAMES), changing=changing)


def for_bmu() -> list[can.Message]:
    """What a BMU receives, over and over."""
    kinds = [kind for kind in PROTOCOL.received_by("BMU") if kind.PERIOD]
    return _frames((default_of(kind) for _ in range(15 * 256) for kind in kinds), changing=False)


def _frames(messages: Iterable[Message], *, changing: bool) -> list[can.Message]:
    """The frames of messages, with counters that go on; ``changing``: and measured values anew."""
    chance = random.Random(1)
    sent: Counter[type[Message]] = Counter()
    frames = []
    for message in messages:
        kind = type(message)
        counter = sent[kind] % kind.COUNTER.modulus if kind.COUNTER else None
        sent[kind] += 1
        said = _measured_anew(message, chance) if changing else message
        data = swapcan.encode(said, counter=counter)
        frames.append(can.Message(arbitration_id=kind.FRAME_ID, data=data))
    return frames


def _measured_anew(message: Message, chance: random.Random) -> Message:
    """The message with other measured values, within their range."""
    values: dict[str, Any] = {}
    for name, field in message.FIELDS.items():
        if isinstance(field, PhysicalField):
            steps = round((field.maximum - field.minimum) / field.factor)
            value = field.minimum + chance.randrange(steps) * field.factor
            if round((value - field.offset) / field.factor) not in field.states:
                values[name] = value
    return dataclasses.replace(message, **values)  # type: ignore[type-var]


@contextmanager
def sending(frames: Sequence[can.Message], rate: float | None = None) -> Iterator[None]:
    """A thread that sends so many frames a second, or as many as it can."""
    stopping = threading.Event()

    def send() -> None:
        with open_bus() as bus:
            start = time.perf_counter()
            for number, frame in enumerate(itertools.cycle(frames)):
                if rate and (left := start + number / rate - time.perf_counter()) > 0:
                    time.sleep(left)
                if stopping.is_set():
                    return
                bus.send(frame)

    thread = threading.Thread(target=send)
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join()
