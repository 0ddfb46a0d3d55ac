"""The vehicle's relays are reported before high voltage is commanded."""

from __future__ import annotations

import numpy as np

from swapcan.messages import V2B_CMD, HvCommand, RelayState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.report.language import Text

_RELAYS = ("main_pos_relay_st", "main_neg_relay_st", "prechg_relay_st", "att_relay_st")

_UNREPORTED = Text(
    "high voltage is commanded, though no frame before reported the relays: "
    "{names} had the reserved code 0",
    "发出上电指令之前没有任何报文汇报继电器状态:{names} 为保留值 0",
)


class RelaysBeforeCommand(Watcher):
    """Looks at each change of the command to on."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._reported = False

    def feed(self, chunk: Chunk) -> None:
        """Judge the commands that begin here."""
        series = chunk.sound(V2B_CMD)
        if not series.fresh:
            return
        on = series.raw("hv_on_off") == HvCommand.HV_ON
        commands = np.flatnonzero(on[1:] & ~on[:-1]) + 1
        first = 0 if self._reported else self._first_report(chunk)
        self._reported = self._reported or first < len(series)
        for row in commands.tolist():
            self.findings.examine(V2B_CMD.SENDER)
            if row <= first and first:
                self._found(chunk, row)

    @staticmethod
    def _first_report(chunk: Chunk) -> int:
        """The first row that reports all relays, one past the last where there is none."""
        series = chunk.sound(V2B_CMD)
        told = np.logical_and.reduce([series.raw(name) != RelayState.RESERVED for name in _RELAYS])
        return int(told.argmax()) if told.any() else len(series)

    def _found(self, chunk: Chunk, row: int) -> None:
        series = chunk.sound(V2B_CMD)
        fields = [
            V2B_CMD.FIELDS[name]
            for name in _RELAYS
            if series.raw(name)[row - 1] == RelayState.RESERVED
        ]
        self.findings.add(
            Occurrence(
                subject=Subject(V2B_CMD.SENDER, V2B_CMD.NAME, "V2B_CMD_HV_OnOff"),
                start=float(series.time[row]),
                end=float(series.time[row]),
                order=int(series.order[row]),
                text=_UNREPORTED,
                values={"names": ", ".join(field.dbc_name for field in fields)},
            )
        )


RULE = Rule(
    id="relays-before-command",
    title=Text("Relays are reported before high voltage is commanded", "上电指令前汇报继电器状态"),
    purpose=Text(
        "The BMU must know how the vehicle's relays stand before it switches high voltage on.",
        "电池管理系统接通高压前必须知道整车继电器状态。",
    ),
    clause="5.2.1.2, Table 14 rows 7 to 10",
    severity=Severity.MUST,
    judges=(V2B_CMD.SENDER,),
    watch=RelaysBeforeCommand,
)
