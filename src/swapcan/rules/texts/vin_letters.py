"""The VIN has no I, O and Q."""

from __future__ import annotations

from functools import partial

from swapcan.rules.texts.vin_letters_watch import VinLettersWatcher
from swapcan.transfer.text import VIN
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_WRONG = Text(
    "character {position} is {code:c}; a VIN has no I, O and Q",
    "第 {position} 个字符为 {code:c};VIN 不使用 I、O、Q",
)

RULE = Rule(
    id="vin-letters",
    title=Text("The VIN has no I, O and Q", "VIN 不含 I、O、Q"),
    purpose=Text(
        "ISO 3779 and GB 16735 leave them out, since they are mistaken for 1 and 0; table 15 "
        "prints codes for them all the same.",
        "ISO 3779 和 GB 16735 不使用易与 1、0 混淆的这三个字母;但表 15 列出了其编码。",
    ),
    clause="ISO 3779; Table 15 rows 2 to 8 (5.2.2)",
    severity=Severity.SHOULD,
    judges=(VIN.messages[0].SENDER,),
    watch=partial(VinLettersWatcher, codes=b"IOQ", text=_WRONG),
)
