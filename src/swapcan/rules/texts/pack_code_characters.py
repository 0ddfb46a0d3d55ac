"""The characters of the pack code are digits and capital letters, and there is room for them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.rules.texts.pack_code_parts import LENGTH, NODE, ROOM, codes, lengths, positions
from swapcan.transfer.text import PACK_CODE
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.report.language import Text
from typedcan.transfer import characters

_IS_WRONG = ~np.isin(np.arange(256), [ord(letter) for letter in characters(PACK_CODE)])

_WRONG = Text(
    "character {position} of {length} is 0x{code:02X}, allowed are 0 to 9 and A to Z in ASCII",
    "第 {position} 个字符(共 {length} 个)为 0x{code:02X},允许 ASCII 字符 0~9 和 A~Z",
)
_LONG = Text(
    "length {length}, the messages have room for {room} characters",
    "长度为 {length},报文最多容纳 {room} 个字符",
)


class PackCodeCharacters(Watcher):
    """Judges the characters that count, as soon as their number is known."""

    def feed(self, chunk: Chunk) -> None:
        """Judge the frames of the pack code."""
        for message in PACK_CODE.messages:
            series = chunk.sound(message)
            if series.fresh:
                self._judge(chunk, series)

    def _judge(self, chunk: Chunk, series: Series) -> None:
        length = lengths(chunk, series)
        places, given = positions(series.message), codes(series)
        wrong = _IS_WRONG[given] & (places <= length[:, None])
        some: NDArray[np.bool_] = np.logical_or.reduce(wrong, axis=1)
        long = (
            (length > ROOM) if series.message is LENGTH.message else np.zeros(len(series), np.bool_)
        )

        def describe(row: int) -> Said:
            said = {"length": int(length[row]), "room": ROOM}
            if long[row]:
                return _LONG, said
            column = int(wrong[row].argmax())
            said |= {"position": int(places[column]), "code": int(given[row, column])}
            return _WRONG, said

        unknown = int((length[series.first :] < 0).sum())
        if unknown < series.fresh:
            subject = Subject(NODE, series.message.NAME)
            self.findings.rows(subject, series, some | long, describe)
            self.findings.examine(NODE, -unknown)  # those were not judged


RULE = Rule(
    id="pack-code-characters",
    title=Text("The pack code has characters of table 8", "电池包编码字符符合表 8"),
    purpose=Text(
        "A code that the table does not have cannot be shown as a character; what stands beyond "
        "the length is not looked at.",
        "表中没有的编码无法显示为字符;长度以外的内容不作判定。",
    ),
    clause="Table 8 (5.1.7), the length in row 3",
    severity=Severity.MUST,
    judges=(NODE,),
    watch=PackCodeCharacters,
)
