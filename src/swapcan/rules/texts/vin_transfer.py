"""The VIN comes whole: its frames in order, each once, soon after each other."""

from __future__ import annotations

from swapcan.rules.texts.vin_sets import NUMBERS, VinFrame, VinSets, is_whole
from swapcan.transfer.text import VIN
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="vin-transfer.seconds",
    value=1.0,
    unit="s",
    text=Text(
        "From the first frame of a VIN to the last: receivers wait no longer for the rest",
        "VIN 第一帧到最后一帧的时间:接收方不再等待更久",
    ),
)

_BROKEN = Text(
    "frames {numbers} in place of {right}",
    "收到帧 {numbers},应为 {right}",
)
_SLOW = Text(
    "{seconds:.3g} s from the first frame to the last, {limit:.3g} s are allowed",
    "第一帧到最后一帧历时 {seconds:.3g} s,允许 {limit:.3g} s",
)

_NODE = VIN.messages[0].SENDER


class VinTransfer(Watcher):
    """Judges each set of frames."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._sets = VinSets()
        self._limit = findings.limit(_SECONDS)
        self._first = True

    def feed(self, chunk: Chunk) -> None:
        """Judge the sets that are over."""
        for frames in self._sets.feed(chunk):
            self._judge(frames)

    def finish(self, end: LogEnd) -> None:
        """Judge the set under way where it should be over."""
        frames = self._sets.open
        if frames and end.time - frames[0].time > self._limit:
            self._judge(frames)

    def _judge(self, frames: list[VinFrame]) -> None:
        begun_before = self._first and frames[0].time < self._limit
        self._first = False
        if begun_before and _is_rest(frames):
            return
        self.findings.examine(_NODE)
        said = self._fault(frames)
        if said is None:
            return
        text, values = said
        found = Occurrence(
            subject=Subject(_NODE, VIN.messages[0].NAME),
            start=frames[0].time,
            end=frames[-1].time,
            order=frames[0].order,
            frames=len(frames),
            text=text,
            values=values,
        )
        self.findings.add(found)

    def _fault(self, frames: list[VinFrame]) -> Said | None:
        """What is wrong with a set."""
        if not is_whole(frames):
            numbers = ", ".join(str(frame.number) for frame in frames)
            return _BROKEN, {"numbers": numbers, "right": ", ".join(map(str, NUMBERS))}
        seconds = frames[-1].time - frames[0].time
        if seconds > self._limit:
            return _SLOW, {"seconds": seconds, "limit": self._limit}
        return None


def _is_rest(frames: list[VinFrame]) -> bool:
    """Whether a set can be the rest of one that began before the log."""
    numbers = tuple(frame.number for frame in frames)
    return len(numbers) < len(NUMBERS) and numbers == NUMBERS[-len(numbers) :]


RULE = Rule(
    id="vin-transfer",
    title=Text("The VIN comes whole", "VIN 完整发送"),
    purpose=Text(
        "The VIN has 17 characters in frames 1, 2 and 3: a receiver needs each of them once, in "
        "order and soon after each other.",
        "VIN 的 17 个字符分为第 1、2、3 帧:接收方需要按顺序、各一次并在短时间内收到全部帧。",
    ),
    clause="5.2.2; Table 15 rows 1 to 8",
    severity=Severity.MUST,
    judges=(_NODE,),
    tolerances=(_SECONDS,),
    watch=VinTransfer,
)
