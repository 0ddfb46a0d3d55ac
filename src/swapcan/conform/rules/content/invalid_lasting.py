"""Signals do not say for long that they have no value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Occurrence, Subject
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.series import Series
from swapcan.conform.text import Text
from swapcan.conform.tolerance import Tolerance
from swapcan.messages import B2V_ST0, V2B_CMD, B2V_Temp, B2V_Ucell
from typedcan.logs.checks import PERIODS
from typedcan.wire.message import Field, FilledField, Message, SignalState

SECONDS = Tolerance(
    name="invalid-lasting.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "How long a signal may have no value, as while a node starts or measures",
        "信号连续没有有效值的允许时间,例如节点启动或测量期间",
    ),
)

_COMMANDS = ("hv_on_off", "hv_acc_on_off", "heat_on_off")
_LEFT_OUT = (B2V_ST0, B2V_Ucell, B2V_Temp)
"""Relay states, which the other side may measure, and items that pad a CSC's last frame."""

_LASTING = Text(
    "{state} for {seconds:.1f} s, allowed are {limit:g} s",
    "“{state}”持续 {seconds:.1f} s,允许 {limit:g} s",
)
_STATES = {
    SignalState.INVALID: Text("Signal Invalid", "信号无效"),
    SignalState.ABNORMAL: Text("Abnormal", "异常"),
}


def _is_judged(message: type[Message], field: Field) -> bool:
    if message.PERIOD is None or message in _LEFT_OUT or isinstance(field, FilledField):
        return False
    return bool(field.states) and (message is not V2B_CMD or field.name in _COMMANDS)


_FIELDS = tuple(
    (message, field)
    for message in PROTOCOL.messages
    for field in message.FIELDS.values()
    if _is_judged(message, field)
)


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

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._limit = findings.limit(SECONDS)
        self._open: dict[tuple[type[Message], str], _Run] = {}

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        for message, field in _FIELDS:
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

    def finish(self, end: float) -> None:  # noqa: ARG002
        """Judge what had no value until the end."""
        for message, field in _FIELDS:
            self._close(message, field)

    def _follow(self, series: Series, field: Field, none: NDArray[np.bool_]) -> None:
        """Go on with the run of before, and find those that begin among the new rows."""
        message, time = series.message, series.time[series.first :]
        silent = np.diff(time, prepend=series.time[0]) > PERIODS * (message.PERIOD or 0.0)
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


RULE = Rule(
    id="invalid-lasting",
    title=Text("Signals have a value", "信号有有效值"),
    purpose=Text(
        "Who relies on a signal must do without it as long as it is invalid. States of relays and "
        "contactors are left out, as the other side may measure them, and single cells and "
        "probes, as the last frame of a CSC may have no more of them.",
        "信号无效期间,依赖该信号的节点无法工作。继电器和接触器状态可能由对方检测,单体电压和探针温度"
        "可能是 CSC 末帧的填充,均不判定。",
    ),
    clause="Tables 1, 5 to 7, 11, 13 and 14",
    severity=Severity.SHOULD,
    judges=tuple(dict.fromkeys(message.SENDER for message, _ in _FIELDS)),
    tolerances=(SECONDS,),
    watch=InvalidLasting,
)
