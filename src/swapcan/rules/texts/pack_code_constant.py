"""The pack code does not change while the pack stays the same."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST1
from swapcan.rules.texts.pack_code_parts import LENGTH, NODE, codes, lengths, positions
from swapcan.transfer.text import PACK_CODE
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SILENCE = Tolerance(
    name="pack-code-constant.silence",
    value=5.0,
    unit="s",
    text=Text(
        "Silence of the BMU after which it may be that of another pack; a swap takes longer",
        "BMU 静默超过该时间后可能已更换为另一电池包;换电所需时间更长",
    ),
)

_CHANGED = Text(
    "characters {first} to {last} were {before} and are {now}",
    "第 {first} 至 {last} 个字符由 {before} 变为 {now}",
)
_LENGTH_CHANGED = Text(
    "the length was {before} and is {now}",
    "长度由 {before} 变为 {now}",
)


class PackCodeConstant(Watcher):
    """Compares each message of the code with the one before it."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._limit = findings.limit(_SILENCE)
        self._heard = _Heard(np.inf, -np.inf)

    def feed(self, chunk: Chunk) -> None:
        """Judge the frames of the pack code that have one before them."""
        beats = chunk.frames(B2V_ST1)
        for message in PACK_CODE.messages:
            series = chunk.sound(message)
            if series.fresh:
                self._judge(chunk, series, beats)
        if beats.fresh:
            self._heard = self._heard_until(beats, len(beats))

    def _judge(self, chunk: Chunk, series: Series, beats: Series) -> None:
        length, given = lengths(chunk, series), codes(series)
        changed = np.zeros(given.shape, np.bool_)
        counts = positions(series.message) <= length[:, None]
        changed[1:] = (given[1:] != given[:-1]) & counts[1:]
        wrong: NDArray[np.bool_] = np.logical_or.reduce(changed, axis=1)
        longer = np.zeros(len(series), np.bool_)
        if series.message is LENGTH.message:
            longer[1:] = length[1:] != length[:-1]
            wrong |= longer
        for row in np.flatnonzero(wrong).tolist():
            wrong[row] = self._is_same_pack(series, row, beats)

        def describe(row: int) -> Said:
            if longer[row]:
                return _LENGTH_CHANGED, {"before": int(length[row - 1]), "now": int(length[row])}
            return _CHANGED, _characters(series, given, row)

        judged = length >= 0
        judged[0] = False
        fresh = int(judged[series.first :].sum())
        if fresh:
            self.findings.rows(Subject(NODE, series.message.NAME), series, wrong, describe)
            self.findings.examine(NODE, fresh - series.fresh)  # the others were not judged

    def _is_same_pack(self, series: Series, row: int, beats: Series) -> bool:
        """Whether the BMU was there all the time since the row before."""
        before, now = float(series.time[row - 1]), float(series.time[row])
        if now - before <= self._limit:
            return True
        heard = self._heard_until(beats, int(np.searchsorted(beats.order, series.order[row])))
        return heard.since - before <= self._limit and now - heard.last <= self._limit

    def _heard_until(self, beats: Series, row: int) -> _Heard:
        """When the BMU was heard without a silence, before a row of its status."""
        times = beats.time[:row]
        if not len(times):
            return self._heard
        begins = np.flatnonzero(np.diff(times) > self._limit) + 1
        if len(begins):
            return _Heard(float(times[begins[-1]]), float(times[-1]))
        return _Heard(min(self._heard.since, float(times[0])), float(times[-1]))


class _Heard(NamedTuple):
    """Since when a node was heard without a silence, and when last."""

    since: float
    last: float


def _characters(series: Series, given: NDArray[np.int64], row: int) -> dict[str, str | int]:
    places = positions(series.message)
    before, now = (
        bytes(given[at].astype(np.uint8)).decode("ascii", "replace").replace("\0", ".")
        for at in (row - 1, row)
    )
    return {"first": int(places[0]), "last": int(places[-1]), "before": before, "now": now}


RULE = Rule(
    id="pack-code-constant",
    title=Text("The pack code does not change", "电池包编码保持不变"),
    purpose=Text(
        "The code is the pack's name; another one is another pack, and that takes a swap.",
        "编码是电池包的唯一标识;编码不同即为另一电池包,而更换需要换电过程。",
    ),
    clause="5.1.7; Table 8",
    severity=Severity.MUST,
    judges=(NODE,),
    tolerances=(_SILENCE,),
    watch=PackCodeConstant,
)
