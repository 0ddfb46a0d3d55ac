"""Signals do not say for long that they have no value."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.content.codes import whole_fields
from typedcan.judge.scope import Scope
from typedcan.judge.series import Series
from typedcan.judge.tolerance import SILENCE, Tolerance
from typedcan.model.signal_state import SignalState
from typedcan.report.language import Text
from typedcan.wire.fields import Field, FilledField
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

SECONDS = Tolerance(
    name="invalid-lasting.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "How long a signal may have no value, as while a node starts or measures",
        "信号连续没有有效值的允许时间,例如节点启动或测量期间",
    ),
)

_LASTING = Text(
    "{state} for {seconds:.1f} s, allowed are {limit:g} s",
    "“{state}”持续 {seconds:.1f} s,允许 {limit:g} s",
)
_STATES = {
    SignalState.INVALID: Text("Signal Invalid", "信号无效"),
    SignalState.ABNORMAL: Text("Abnormal", "异常"),
}


def _judged(protocol: Protocol, scope: Scope) -> Iterator[tuple[type[Message], Field]]:
    for message, field in whole_fields(protocol):
        may_lack = isinstance(field, FilledField) or field.dbc_name in scope.without_value
        if message.PERIOD and field.states and not may_lack:
            yield message, field


@dataclass(slots=True)
class _Run:
    """Frames in a row whose signal has no value; ``code`` is the first one's."""

    start: float
    end: float
    order: int
    frames: int
    code: int


class InvalidLasting(Watcher):
    """Follows signals while they have no value; a silence of their message ends that."""

    def __init__(self, findings: Findings, fields: Sequence[tuple[type[Message], Field]]) -> None:
        super().__init__(findings)
        self._fields = fields
        self._limit, self._silent = findings.limit(SECONDS), findings.limit(SILENCE)
        self._open: dict[tuple[type[Message], str], _Run] = {}

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        for message, field in self._fields:
            series = chunk.sound(message)
            if not series.fresh:
                continue
            self.findings.examine(message.SENDER, series.fresh)
            raw = series.new_raw(field.name)
            none = np.zeros(len(raw), np.bool_)
            for code in field.states:
                none |= raw == code
            if none.any():
                self._follow(series, field, none)
            else:
                self._close(message, field)

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Judge what had no value until the end."""
        for message, field in self._fields:
            self._close(message, field)

    def _follow(self, series: Series, field: Field, none: NDArray[np.bool_]) -> None:
        """Go on with the run of before, and find those that begin among the new rows."""
        message, time = series.message, series.time[series.first :]
        silent = np.diff(time, prepend=series.time[0]) > self._silent * (message.PERIOD or 0.0)
        goes_on = none & ~silent
        begins = np.flatnonzero(none & ~(goes_on & np.append(False, none[:-1])))
        ends = np.flatnonzero(none & ~np.append(goes_on[1:], False))
        key = message, field.name
        if not goes_on[0]:
            self._close(message, field)
        kept = time[ends] - time[begins] > self._limit
        kept[0] |= key in self._open
        kept[-1] |= bool(none[-1])
        for begin, end in zip(begins[kept].tolist(), ends[kept].tolist(), strict=True):
            run = self._open.get(key)
            if run is None:
                start, order = float(time[begin]), int(series.order[series.first + begin])
                code = int(series.new_raw(field.name)[begin])
                run = self._open[key] = _Run(start, start, order, 0, code)
            run.end = float(time[end])
            run.frames += end - begin + 1
            if end < len(none) - 1:
                self._close(message, field)

    def _close(self, message: type[Message], field: Field) -> None:
        """Judge a run that is over."""
        run = self._open.pop((message, field.name), None)
        if run is None or run.end - run.start <= self._limit:
            return
        seconds = run.end - run.start
        found = Occurrence(
            subject=Subject(message.SENDER, message.NAME, field.dbc_name),
            start=run.start,
            end=run.end,
            order=run.order,
            frames=run.frames,
            measure=seconds,
            text=_LASTING,
            values={
                "state": _STATES[field.states[run.code]],
                "seconds": seconds,
                "limit": self._limit,
            },
        )
        self.findings.add(found)


def rule(protocol: Protocol, scope: Scope) -> Rule:
    """The rule of a protocol."""
    fields = tuple(_judged(protocol, scope))
    return Rule(
        id="invalid-lasting",
        title=Text("Signals have a value", "信号有有效值"),
        purpose=Text(
            "Who relies on a signal must do without it as long as it is invalid.",
            "信号无效期间,依赖该信号的节点无法工作。",
        ),
        severity=Severity.SHOULD,
        judges=tuple(dict.fromkeys(message.SENDER for message, _ in fields)),
        tolerances=(SECONDS,),
        watch=partial(InvalidLasting, fields=fields),
    )
