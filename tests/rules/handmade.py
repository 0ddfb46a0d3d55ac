"""Logs of a few frames written by hand, and judging them however they are cut."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import can
from rules.altered import database, sealed
from rules.in_blocks import judged
from rules.recorded import written

from swapcan.conform import Judgement, Rule

CASES = Path(__file__).with_name("cases")

Sketch = tuple[float, str, Mapping[str, int]]
"""When, which message, and the raw values of its signals that are not 0."""


def at(times: Iterable[float], message: str, **signals: int) -> list[Sketch]:
    """The same values at several times."""
    return [(time, message, signals) for time in times]


def every(step: float, begin: float, end: float) -> list[float]:
    """Times from begin to end."""
    return [begin + step * number for number in range(round((end - begin) / step) + 1)]


def frames_of(*sketches: Iterable[Sketch], stuck: bool = False) -> list[can.Message]:
    """Frames in the order of their times, with checksums and alive counters that run, or not."""
    frames: list[can.Message] = []
    counts: Counter[str] = Counter()
    for time, name, signals in sorted((each for some in sketches for each in some), key=_time):
        message = database().get_message_by_name(name)
        raw = {signal.name: 0 for signal in message.signals} | dict(signals)
        if name in ("B2V_ST1", "V2B_CMD"):
            raw[f"{name}_ALIV"] = 0 if stuck else counts[name] % 15
            counts[name] += 1
        data = message.encode(raw, scaling=False, strict=False)
        if f"{name}_ALIV" in raw:
            data = sealed(name, data)
        frames.append(
            can.Message(timestamp=time, arbitration_id=message.frame_id, data=data, channel="can0")
        )
    return frames


def _time(sketch: Sketch) -> float:
    return sketch[0]


def found(judgement: Judgement) -> dict[str, list[str]]:
    """What was found, by rule: signal and times; an empty list where a rule passed.

    A rule that could not judge anything is left out.
    """
    return {
        result.rule.id: [
            f"{each.subject}: {each.start:.2f} to {each.end:.2f} s" for each in result.occurrences
        ]
        for result in judgement.results
        if result.examined
    }


class Bench:
    """Judges handmade frames by some rules, in one folder."""

    def __init__(self, folder: Path, rules: Sequence[Rule]) -> None:
        self._log = folder / "handmade.log"
        self._rules = rules

    def finds(
        self,
        *sketches: Iterable[Sketch],
        stuck: bool = False,
        block: int = 1 << 17,
        limits: Mapping[str, float] | None = None,
    ) -> dict[str, list[str]]:
        """See `found`."""
        frames = frames_of(*sketches, stuck=stuck)
        return found(judged(written(frames, self._log), self._rules, block, limits))
