"""Each cycle of probe temperatures has every frame once."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.rule import Rule, Severity
from swapcan.conform.rules.transfers.cycle_watch import MISSING_OR_DOUBLED, pause_of, watcher
from swapcan.conform.text import Text

_TRANSFER = PROTOCOL.transfer("probe_temperatures")
_PAUSE = pause_of("probes-complete")

RULE = Rule(
    id="probes-complete",
    title=Text("Each cycle has all probe temperatures", "每个周期包含全部探针温度"),
    purpose=Text(
        "The VCU passes the temperatures of all probes on; a missing frame leaves old ones.",
        "VCU 将全部探针温度上传云平台;缺帧时只能使用旧值。",
    ),
    clause="5.1.9; Table 10 rows 1 and 2",
    severity=Severity.MUST,
    judges=(_TRANSFER.messages[0].SENDER,),
    tolerances=(_PAUSE,),
    watch=watcher(_TRANSFER, _PAUSE, MISSING_OR_DOUBLED),
)
