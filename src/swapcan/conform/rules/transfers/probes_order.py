"""Within a cycle the frames of probe temperatures come by CSC and frame number."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.rule import Rule, Severity
from swapcan.conform.rules.transfers.cycle_watch import OUT_OF_ORDER, pause_of, watcher
from swapcan.conform.text import Text

_TRANSFER = PROTOCOL.transfer("probe_temperatures")
_PAUSE = pause_of("probes-order")

RULE = Rule(
    id="probes-order",
    title=Text("Probe temperatures come in the order of their numbers", "探针温度按编号顺序发送"),
    purpose=Text(
        "CSCs and frames are numbered. A receiver that takes a lower number for the beginning of a "
        "cycle would mix two cycles.",
        "CSC 和帧均有编号;接收方如以编号变小作为新周期的起点,会混淆两个周期的数据。",
    ),
    clause="5.1.9; Table 10 rows 1 and 2",
    severity=Severity.SHOULD,
    judges=(_TRANSFER.messages[0].SENDER,),
    tolerances=(_PAUSE,),
    watch=watcher(_TRANSFER, _PAUSE, OUT_OF_ORDER),
)
