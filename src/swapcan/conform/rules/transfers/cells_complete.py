"""Each cycle of cell voltages has every frame once."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.rule import Rule, Severity
from swapcan.conform.rules.transfers.cycle_watch import MISSING_OR_DOUBLED, pause_of, watcher
from swapcan.conform.text import Text

_TRANSFER = PROTOCOL.transfer("cell_voltages")
_PAUSE = pause_of("cells-complete")

RULE = Rule(
    id="cells-complete",
    title=Text("Each cycle has all cell voltages", "每个周期包含全部单体电压"),
    purpose=Text(
        "The VCU passes the voltages of all cells on; a missing frame leaves old ones.",
        "VCU 将全部单体电压上传云平台;缺帧时只能使用旧值。",
    ),
    clause="5.1.8; Table 9 rows 1 and 2",
    severity=Severity.MUST,
    judges=(_TRANSFER.messages[0].SENDER,),
    tolerances=(_PAUSE,),
    watch=watcher(_TRANSFER, _PAUSE, MISSING_OR_DOUBLED),
)
