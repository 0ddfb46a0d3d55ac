"""The state of the high voltage is that of the main relays."""

from __future__ import annotations

from functools import partial

import numpy as np

from swapcan.messages import B2V_ST0, B2V_ST1, BmsState, RelayState
from swapcan.rules.voltage.charge_path import ChargePath
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_DELAY = Tolerance(
    name="hv-closed-relays.delay",
    value=0.25,
    unit="s",
    text=Text(
        "for which state and relays may differ, as their messages are not sent at the same moment",
        "状态与继电器允许不一致的时间,因两种报文并非同时发送",
    ),
)

_RELAYS = {
    "st_main_pos": Text("main positive relay", "主正继电器"),
    "st_main_neg": Text("main negative relay", "主负继电器"),
}

_OPEN = Text(
    "{relay} open for {seconds:.2f} s while the state is HV closed",
    "状态为 HV closed 时,{relay}断开达 {seconds:.2f} s",
)
_BOTH = Text(
    "both main relays closed for {seconds:.2f} s while the state is HV open",
    "状态为 HV open 时,主正、主负继电器同时闭合达 {seconds:.2f} s",
)


class HvClosedRelays(LastingWatcher):
    """Holds each B2V_ST0 against the last B2V_ST1."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        delay = findings.limit(_DELAY)
        self._open = {
            field: self.lasting(
                Subject("BMU", "B2V_ST0", B2V_ST0.FIELDS[field].dbc_name), delay, B2V_ST0
            )
            for field in _RELAYS
        }
        state = Subject("BMU", "B2V_ST1", "B2V_ST1_BMS")
        self._both = self.lasting(state, delay, B2V_ST0)
        self._path = ChargePath()

    def feed(self, chunk: Chunk) -> None:
        """Judge the relays under the states HV open and HV closed."""
        relays = chunk.sound(B2V_ST0)
        state = LastKnown(chunk.sound(B2V_ST1), relays)
        on = state.is_code("bms", BmsState.HV_CLOSED)
        off = state.is_code("bms", BmsState.HV_OPEN)
        for_charging = self._path.feed(chunk)
        both = np.ones(len(relays), np.bool_)
        shown = both.copy()
        for field, title in _RELAYS.items():
            code = relays.raw(field)
            is_open, is_closed = code == RelayState.OPEN, code == RelayState.CLOSED
            self._open[field].feed(
                relays,
                on & (is_open | is_closed) & ~for_charging[field],
                is_open,
                partial(_describe_open, title),
            )
            both &= is_closed
            shown &= is_open | is_closed
        self._both.feed(relays, off & shown, both, _describe_both)


def _describe_open(relay: Text, _: int) -> Said:
    return _OPEN, {"relay": relay}


def _describe_both(_: int) -> Said:
    return _BOTH, {}


RULE = Rule(
    id="hv-closed-relays",
    title=Text("State and main relays agree", "高压状态与主继电器状态一致"),
    purpose=Text(
        "The VCU drives by the state and watches the relays: they must tell the same. A relay that "
        "opened for the charge contactors is not judged until it closes again.",
        "VCU 依据高压状态行驶并监视继电器,两者必须一致。"
        "因使用充电接触器而断开的继电器,在其再次闭合之前不作判定。",
    ),
    clause="Table 1 row 9 (5.1.1), Table 2 rows 1 and 2 (5.1.2)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_DELAY,),
    watch=HvClosedRelays,
)
