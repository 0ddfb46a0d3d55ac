"""The base of the rules that hold a field of B2V_ST1 against the single alarms around it."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

from swapcan.messages import B2V_ST1
from swapcan.rules.pack.alarms import Alarms, AlarmStream
from swapcan.rules.pack.runs import Runs
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Subject
from typedcan.judge.rule import Watcher


class AlarmWatcher(Watcher):
    """Judges each B2V_ST1 once the alarms of the B2V_ST0 around it are known.

    ``field`` names what is judged.
    """

    field: ClassVar[str]

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._stream = AlarmStream(findings)
        signal = B2V_ST1.FIELDS[self.field].dbc_name
        self.runs = Runs(findings, Subject(B2V_ST1.SENDER, B2V_ST1.NAME, signal))

    @abstractmethod
    def judge(self, alarms: Alarms) -> None:
        """Judge frames around which all is known, by `runs`."""

    def feed(self, chunk: Chunk) -> None:
        """Judge the frames around which all is known by now."""
        self.judge(self._stream.feed(chunk))

    def finish(self, end: LogEnd) -> None:
        """Judge the rest."""
        del end
        if left := self._stream.finish():
            self.judge(left)
        self.runs.finish()
