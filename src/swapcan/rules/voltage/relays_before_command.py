"""The vehicle's relays are reported before high voltage is commanded."""

from __future__ import annotations

import numpy as np

from swapcan.messages import V2B_CMD, HvCommand, RelayState
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import KEPT, Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.report.language import Text

_RELAYS = ("main_pos_relay_st", "main_neg_relay_st", "prechg_relay_st", "att_relay_st")

_UNREPORTED = Text(
    "high voltage is commanded, though no frame before reported the relays: "
    "{names} had the reserved code 0",
    "发出上电指令之前没有任何报文汇报继电器状态:{names} 为保留值 0",
)


class RelaysBeforeCommand(Watcher):
    """Looks at each change of the command to on.

    A relay of which no frame of the log reports a state is one that the vehicle lacks.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._first: dict[str, int] = {}  # by relay, the first frame that reports it
        self._commands: list[tuple[float, int, int]] = []  # time and order, order of the one before

    def feed(self, chunk: Chunk) -> None:
        """Note the commands that begin here, and the reports."""
        series = chunk.sound(V2B_CMD)
        if not series.fresh:
            return
        on = series.raw("hv_on_off") == HvCommand.HV_ON
        for row in (np.flatnonzero(on[1:] & ~on[:-1]) + 1).tolist():
            if len(self._commands) < KEPT:
                order, before = int(series.order[row]), int(series.order[row - 1])
                self._commands.append((float(series.time[row]), order, before))
        for name in _RELAYS:
            told = series.raw(name) != RelayState.RESERVED
            if name not in self._first and told.any():
                self._first[name] = int(series.order[told.argmax()])

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Judge the commands: it is known now which relays there are."""
        for time, order, before in self._commands:
            self.findings.examine(V2B_CMD.SENDER)
            late = [name for name, first in self._first.items() if first > before]
            if late:
                names = [V2B_CMD.FIELDS[name].dbc_name for name in _RELAYS if name in late]
                self.findings.add(
                    Occurrence(
                        subject=Subject(V2B_CMD.SENDER, V2B_CMD.NAME, "V2B_CMD_HV_OnOff"),
                        start=time,
                        end=time,
                        order=order,
                        text=_UNREPORTED,
                        values={"names": ", ".join(names)},
                    )
                )


RULE = Rule(
    id="relays-before-command",
    title=Text("Relays are reported before high voltage is commanded", "上电指令前汇报继电器状态"),
    purpose=Text(
        "The BMU must know how the vehicle's relays stand before it switches high voltage on. A "
        "relay that is never reported is one that the vehicle lacks.",
        "电池管理系统接通高压前必须知道整车继电器状态;从未汇报的继电器视为整车未配置。",
    ),
    clause="5.2.1.2, Table 14 rows 7 to 10",
    severity=Severity.MUST,
    judges=(V2B_CMD.SENDER,),
    watch=RelaysBeforeCommand,
)
