"""The pack code has the 24 characters of GB/T 34014."""

from __future__ import annotations

from swapcan.rules.texts.pack_code_parts import LENGTH, NODE, ROOM
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.report.language import Text

_CHARACTERS = 24
"""Of a code after GB/T 34014."""

_OTHER = Text(
    "length {length}, a code after GB/T 34014 has {right} characters",
    "长度为 {length},GB/T 34014 编码为 {right} 个字符",
)


class PackCodeLength(Watcher):
    """Judges the length in each first message of a code that is sent at all."""

    def feed(self, chunk: Chunk) -> None:
        """Judge the frames that tell the length; one without room is for another rule."""
        series = chunk.sound(LENGTH.message)
        if not series.fresh:
            return
        length = series.raw(LENGTH.field)
        wrong = (length != 0) & (length != _CHARACTERS) & (length <= ROOM)

        def describe(row: int) -> Said:
            return _OTHER, {"length": int(length[row]), "right": _CHARACTERS}

        name = LENGTH.message.FIELDS[LENGTH.field].dbc_name
        self.findings.rows(Subject(NODE, LENGTH.message.NAME, name), series, wrong, describe)


RULE = Rule(
    id="pack-code-length",
    title=Text("The pack code has 24 characters", "电池包编码为 24 个字符"),
    purpose=Text(
        "The code has to be one after GB/T 34014, which has 24 characters, though the messages "
        "have room for 27; 0 says that it is not sent.",
        "编码应符合 GB/T 34014(24 个字符),而报文可容纳 27 个字符;长度 0 表示不发送编码。",
    ),
    clause="5.1.7; Table 8 row 3; GB/T 34014",
    errata=("E33",),
    severity=Severity.SHOULD,
    judges=(NODE,),
    watch=PackCodeLength,
)
