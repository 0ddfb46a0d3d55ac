"""The check digit of the VIN is the one that its other characters make."""

from __future__ import annotations

from swapcan.rules.texts.vin_sets import VinFrame, VinSets, is_whole
from swapcan.transfer.text import VIN
from swapcan.transfer.vin import VIN_LENGTH, check_digit
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.report.language import Text

_WRONG = Text(
    "VIN {vin}: character 9 is {given}, the others make {right}",
    "VIN {vin}:第 9 位为 {given},按其余字符计算应为 {right}",
)

_NODE = VIN.messages[0].SENDER
_POSITION = 8
"""Of the check digit, counted from 0."""


class VinCheckDigit(Watcher):
    """Computes the check digit of each VIN that is whole and has all its characters."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._sets = VinSets()

    def feed(self, chunk: Chunk) -> None:
        """Judge the VINs that are whole with a chunk."""
        for frames in self._sets.feed(chunk):
            if is_whole(frames):
                self._judge(frames)

    def _judge(self, frames: list[VinFrame]) -> None:
        vin = b"".join(frame.data[1:] for frame in frames)[:VIN_LENGTH].decode("latin-1")
        try:
            right = check_digit(vin)
        except ValueError:  # other rules judge the characters
            return
        self.findings.examine(_NODE)
        given = vin[_POSITION]
        if given == right:
            return
        found = Occurrence(
            subject=Subject(_NODE, VIN.messages[0].NAME, detail="character 9"),
            start=frames[0].time,
            end=frames[-1].time,
            order=frames[0].order,
            frames=len(frames),
            text=_WRONG,
            values={"vin": vin, "given": given, "right": right},
        )
        self.findings.add(found)


RULE = Rule(
    id="vin-check-digit",
    title=Text("The check digit of the VIN is right", "VIN 检验位正确"),
    purpose=Text(
        "GB 16735 has a check digit at character 9; VINs from regions without one may pass for "
        "wrong, and this standard does not ask for it.",
        "GB 16735 规定第 9 位为检验位;无此要求的地区的 VIN 可能被误判,本标准也未要求。",
    ),
    clause="GB 16735 (5.2.2)",
    severity=Severity.INFO,
    judges=(_NODE,),
    watch=VinCheckDigit,
)
