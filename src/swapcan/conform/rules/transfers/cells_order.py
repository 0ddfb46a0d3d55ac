"""Within a cycle the frames of cell voltages come by CSC and frame number."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.rule import Rule, Severity
from swapcan.conform.rules.transfers.cycle_watch import OUT_OF_ORDER, pause_of, watcher
from swapcan.conform.text import Text

_TRANSFER = PROTOCOL.transfer("cell_voltages")
_PAUSE = pause_of("cells-order")

RULE = Rule(
    id="cells-order",
    title=Text("Cell voltages come in the order of their numbers", "单体电压按编号顺序发送"),
    purpose=Text(
        "CSCs and frames are numbered. A receiver that takes a lower number for the beginning of a "
        "cycle would mix two cycles.",
        "CSC 和帧均有编号;接收方如以编号变小作为新周期的起点,会混淆两个周期的数据。",
    ),
    clause="5.1.8; Table 9 rows 1 and 2",
    severity=Severity.SHOULD,
    judges=(_TRANSFER.messages[0].SENDER,),
    tolerances=(_PAUSE,),
    watch=watcher(_TRANSFER, _PAUSE, OUT_OF_ORDER),
)
