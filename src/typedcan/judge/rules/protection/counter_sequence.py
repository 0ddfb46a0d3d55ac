"""Alive counters run on by 1 with each frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.one_of import OneOf, Together, readings_of
from typedcan.judge.scope import Scope
from typedcan.judge.series import Series
from typedcan.judge.tolerance import SILENCE
from typedcan.logs.checksums import counter_places
from typedcan.model import protocol as model
from typedcan.model.protection import Counter
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_REPEATED = Text("repeated: the counter stays at {value}", "重复:计数值停在 {value}")
_SKIPPED = Text(
    "skipped: the counter goes from {before} to {value} instead of {due}",
    "跳变:计数值由 {before} 变为 {value},应为 {due}",
)


@dataclass(slots=True)
class _Place:
    """How far a message was followed.

    Parameters
    ----------
    frames, pauses
        All of its frames so far, and the pauses between them.
    sound_frames, sound_pauses
        The same up to the last frame with the right checksum, that one included.
    """

    frames: int = 0
    pauses: int = 0
    sound_frames: int = 0
    sound_pauses: int = 0


class CounterSequence(Watcher):
    """Compares the counter of each sound frame with that of the sound frame before.

    Frames with a wrong checksum in between count as steps. After a pause, and after a value that
    the counter must not have, it may begin anywhere.

    Parameters
    ----------
    open_ends
        Counters of which it is not said where they begin anew.
    """

    def __init__(
        self,
        findings: Findings,
        counters: Sequence[tuple[type[Message], Counter]],
        open_ends: frozenset[str] = frozenset(),
    ) -> None:
        super().__init__(findings)
        self._counters = counters
        self._open_ends = open_ends
        self._places = {message: _Place() for message, _ in counters}

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        for message, counter in self._counters:
            frames, sound = chunk.frames(message), chunk.sound(message)
            if not frames.fresh:
                continue
            number, pause = self._numbers(message, frames, sound)
            raw = counter_places(counter, sound.raw(message.field_of(counter.signal).name))
            steps = np.diff(number, prepend=number[:1])
            due = (np.roll(raw, 1) + steps) % counter.modulus
            sane = raw >= 0
            wrong = sane & np.roll(sane, 1) & (pause == np.roll(pause, 1)) & (raw != due)
            wrong[:1] = False  # there is nothing before
            if counter.signal in self._open_ends:
                wrong &= ~_begins_anew(counter, raw)
            subject = Subject(message.SENDER, message.NAME, counter.signal)
            described = partial(_describe, counter, raw, steps)
            self.findings.rows(subject, sound, wrong, described)

    def _numbers(
        self, message: type[Message], frames: Series, sound: Series
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """For each sound row, how many frames and how many pauses there were up to it."""
        place = self._places[message]
        steps = np.diff(frames.time, prepend=frames.time[:1])[frames.first :]
        pauses = (
            np.cumsum(steps > self.findings.limit(SILENCE) * (message.PERIOD or np.inf))
            + place.pauses
        )
        rows = np.arange(frames.fresh)
        if sound.fresh < frames.fresh:
            rows = np.searchsorted(frames.order[frames.first :], sound.order[sound.first :])
        number, pause = rows + place.frames + 1, pauses[rows]
        if sound.first:
            number = np.append(place.sound_frames, number)
            pause = np.append(place.sound_pauses, pause)
        place.frames += frames.fresh
        place.pauses = int(pauses[-1])
        if sound.fresh:
            place.sound_frames, place.sound_pauses = int(number[-1]), int(pause[-1])
        return number, pause


def _describe(counter: Counter, raw: NDArray[np.int64], steps: NDArray[np.int64], row: int) -> Said:
    before, at = int(raw[row - 1]), int(raw[row])
    due = (before + int(steps[row])) % counter.modulus
    value, *others = (counter.first + each * counter.step for each in (at, before, due))
    if at == before:
        return _REPEATED, {"value": value}
    return _SKIPPED, {"before": others[0], "value": value, "due": others[1]}


def _begins_anew(counter: Counter, raw: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Where it goes from one of its last two values to one of its first two."""
    anew: NDArray[np.bool_] = (np.roll(raw, 1) >= counter.modulus - 2) & (raw >= 0) & (raw <= 1)
    return anew


def _watch(
    findings: Findings,
    counters: Sequence[tuple[type[Message], tuple[Counter, ...]]],
    open_ends: frozenset[str],
) -> Watcher:
    """By each of the readings of a counter, where there are several."""
    plain = [(message, readings[0]) for message, readings in counters if len(readings) == 1]
    several = [
        OneOf(
            findings,
            [
                partial(CounterSequence, counters=[(message, counter)], open_ends=open_ends)
                for counter in readings
            ],
        )
        for message, readings in counters
        if len(readings) > 1
    ]
    return Together(findings, [CounterSequence(findings, plain, open_ends), *several])


def _read_otherwise(others: Sequence[model.Message], name: str) -> tuple[Counter, ...]:
    return tuple(each.counter for each in others if each.name == name and each.counter)


def rule(protocol: Protocol, scope: Scope) -> Rule:
    """The rule of a protocol."""
    others = tuple(readings_of(protocol.model, "counter"))
    counting = tuple(
        (message, (counter, *_read_otherwise(others, message.NAME)))
        for message in protocol.messages
        if (counter := message.COUNTER)
    )
    return Rule(
        id="counter-sequence",
        title=Text("Alive counters run on", "生命信号连续递增"),
        purpose=Text(
            "A counter that stays says that the sender hangs, one that leaves out values that "
            "frames were lost. After more than five periods without a frame it may begin anywhere.",
            "计数值不变说明发送方程序停滞,计数值跳变说明有帧丢失。超过五个周期没有报文后,计数可以从任意值开始。",
        ),
        severity=Severity.MUST,
        judges=tuple(dict.fromkeys(message.SENDER for message, _ in counting)),
        watch=partial(_watch, counters=counting, open_ends=scope.open_ends),
    )
