"""The cooling unit takes over the mode that is asked for."""

from __future__ import annotations

import numpy as np

from swapcan.messages import BMS_TMS_0, TMS_BMS_0, HvRelayState, HvRequest, ThermalMode
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="cooling-mode-followed.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "for which the mode may be another: two messages of 1 s each, and what a compressor needs "
        "to start or stop",
        "工作状态允许不一致的时间:两种报文各 1 s 周期,以及压缩机启停所需时间",
    ),
)

_SUBJECT = Subject("TMS", "TMS_BMS_0", "TMS_WorkSts")

_MODES = {
    ThermalMode.OFF: Text("Off", "关机"),
    ThermalMode.COOLING: Text("Cooling", "制冷"),
    ThermalMode.HEATING: Text("Heating", "制热"),
    ThermalMode.SELF_CIRCULATION: Text("Self-circulation", "自循环"),
}

_OTHER = Text(
    "{does} where {wanted} is requested; for {seconds:.2f} s",
    "请求{wanted},实际为{does},持续 {seconds:.2f} s",
)


class CoolingModeFollowed(LastingWatcher):
    """Judges the mode of a unit without fault, and with high voltage where the mode needs it."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._other = self.lasting(_SUBJECT, findings.limit(_SECONDS), TMS_BMS_0)

    def feed(self, chunk: Chunk) -> None:
        """Judge the mode that the unit says it is in."""
        series = chunk.sound(TMS_BMS_0)
        order = LastKnown(chunk.sound(BMS_TMS_0), series)
        does, wanted = series.raw("work_sts"), order.raw("reqst_set_tms_sts")
        powered = order.raw("reqst_tms_hv_on") == HvRequest.REQUEST_HV_ON
        powered &= order.raw("hv_rly_sts") == HvRelayState.CLOSED
        without = np.isin(wanted, (ThermalMode.OFF, ThermalMode.SELF_CIRCULATION))
        judged = order.known & (without | powered)
        judged &= (series.raw("fault_lv") == 0) & (series.raw("fault_code") == 0)

        def describe(row: int) -> Said:
            modes = int(does[row]), int(wanted[row])
            return _OTHER, dict(zip(("does", "wanted"), map(_title, modes), strict=True))

        self._other.feed(series, judged, does != wanted, describe)


def _title(mode: int) -> Text:
    return _MODES[ThermalMode(mode)]


RULE = Rule(
    id="cooling-mode-followed",
    title=Text("The cooling unit follows the request", "水冷机组执行请求模式"),
    purpose=Text(
        "The BMS sets the mode; a unit that does something else, and reports no fault, leaves the "
        "cells too hot or too cold.",
        "模式由 BMS 请求设定;机组未执行且未报故障,会使电芯过热或过冷。",
    ),
    clause="Table 19 row 1 (5.5), Table 20 row 1 (5.6)",
    severity=Severity.SHOULD,
    judges=("TMS",),
    tolerances=(_SECONDS,),
    watch=CoolingModeFollowed,
)
