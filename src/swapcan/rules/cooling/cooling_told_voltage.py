"""The cooling unit is told the pack's voltage as it is."""

from __future__ import annotations

import numpy as np

from swapcan.messages import B2V_ST3, BMS_TMS_0, HvRelayState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SHARE = Tolerance(
    name="cooling-told-voltage.share",
    value=0.02,
    text=Text(
        "between the two, as a share: they are measured at different moments",
        "两者之差的比例,因测量时刻不同",
    ),
)
_VOLTAGE = Tolerance(
    name="cooling-told-voltage.voltage",
    value=5.0,
    unit="V",
    text=Text("between the two, beside the share", "除比例外允许的电压差"),
)
_SECONDS = Tolerance(
    name="cooling-told-voltage.seconds",
    value=1.5,
    unit="s",
    text=Text(
        "for which they may differ by more: a period and a half of BMS_TMS_0",
        "允许超出的时间:BMS_TMS_0 的一个半周期",
    ),
)

_SUBJECT = Subject("BMU", "BMS_TMS_0", "BMS_Volt")

_DIFFERS = Text(
    "{told:.0f} V told to the cooling unit, {battery:.1f} V at the battery and {out:.1f} V on the "
    "bus bar told to the VCU, for {seconds:.2f} s",
    "发给水冷机组的电压为 {told:.0f} V,发给 VCU 的电池端电压为 {battery:.1f} V、母线端电压为 "
    "{out:.1f} V,持续 {seconds:.2f} s",
)


class CoolingToldVoltage(LastingWatcher):
    """Holds each BMS_TMS_0 against the last B2V_ST3, on whichever side of the relays."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._share, self._voltage = findings.limit(_SHARE), findings.limit(_VOLTAGE)
        self._differs = self.lasting(_SUBJECT, findings.limit(_SECONDS), BMS_TMS_0)

    def feed(self, chunk: Chunk) -> None:
        """Judge the voltage."""
        series = chunk.sound(BMS_TMS_0)
        voltages = LastKnown(chunk.sound(B2V_ST3), series)
        told = series.value("volt")
        battery, out = voltages.value("upack_batt"), voltages.value("upack_out")
        excess = np.minimum(
            np.abs(told - battery) - self._share * battery, np.abs(told - out) - self._share * out
        )
        excess -= self._voltage
        # While the relays are open some tell that there is no voltage, or none to tell.
        nothing = np.isin(series.raw("volt"), (0, 0xFFFF))
        judged = ~np.isnan(excess) & ~(nothing & (series.raw("hv_rly_sts") == HvRelayState.OPEN))

        def describe(row: int) -> Said:
            return _DIFFERS, {
                "told": float(told[row]),
                "battery": float(battery[row]),
                "out": float(out[row]),
            }

        self._differs.feed(series, judged, excess > 0, describe, excess)


RULE = Rule(
    id="cooling-told-voltage",
    title=Text("The cooling unit is told the pack's voltage", "发给水冷机组的电压属实"),
    purpose=Text(
        "The unit guards its compressor against over- and undervoltage by it; byte order and "
        "scaling are easily mistaken, as its high byte comes first.",
        "机组据此对压缩机作过压、欠压保护;该信号高字节在前,字节序与分辨率容易出错。",
    ),
    clause="Table 19 row 5 (5.5), Table 1 rows 4 and 5 (5.1.1)",
    severity=Severity.SHOULD,
    errata=("E36",),
    judges=("BMU",),
    tolerances=(_SHARE, _VOLTAGE, _SECONDS),
    watch=CoolingToldVoltage,
)
