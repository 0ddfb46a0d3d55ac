"""The announced number of probes is that which is sent."""

from __future__ import annotations

from functools import partial
from operator import attrgetter

from swapcan.messages import B2V_Temp
from swapcan.rules.pack.announced import Announced
from swapcan.rules.shared import ANOTHER_PACK
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="probe-count-announced.seconds",
    value=1.0,
    unit="s",
    text=Text(
        "how long B2V_Temp must be seen, so that lost frames came at least once",
        "B2V_Temp 至少需观察的时间,使偶尔丢失的帧至少出现一次",
    ),
)

RULE = Rule(
    id="probe-count-announced",
    title=Text(
        "The announced number of probes is that which is sent",
        "上报的温度探针总数与探针温度报文一致",
    ),
    purpose=Text(
        "A receiver waits for as many readings as are announced, and knows none to be missing.",
        "接收方按上报的总数收集数据,并据此判断是否缺失。",
    ),
    clause="Table 13 row 8 (5.1.12), Table 10 (5.1.9)",
    severity=Severity.SHOULD,
    errata=("E50",),
    judges=("BMU",),
    tolerances=(_SECONDS, ANOTHER_PACK),
    watch=partial(
        Announced,
        message=B2V_Temp,
        totals={"tot_temp_num": attrgetter("readings")},
        seconds=_SECONDS,
    ),
)
