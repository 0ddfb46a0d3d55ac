"""The characters of the VIN are digits and capital letters."""

from __future__ import annotations

from functools import partial

from swapcan.rules.texts.vin_letters_watch import VinLettersWatcher
from swapcan.transfer.text import VIN
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text
from typedcan.transfer import characters

_ALLOWED = {ord(letter) for letter in characters(VIN)}

_WRONG = Text(
    "character {position} is 0x{code:02X}, allowed are 0 to 9 and A to Z in ASCII",
    "第 {position} 个字符为 0x{code:02X},允许 ASCII 字符 0~9 和 A~Z",
)

RULE = Rule(
    id="vin-characters",
    title=Text("The VIN has characters of table 15", "VIN 字符符合表 15"),
    purpose=Text(
        "A code that the table does not have cannot be shown as a character.",
        "表中没有的编码无法显示为字符。",
    ),
    clause="Table 15 rows 2 to 8 (5.2.2)",
    severity=Severity.MUST,
    judges=(VIN.messages[0].SENDER,),
    watch=partial(VinLettersWatcher, codes=set(range(256)) - _ALLOWED, text=_WRONG),
)
