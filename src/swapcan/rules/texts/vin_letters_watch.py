"""Finds characters of the VIN by their codes."""

from __future__ import annotations

from collections.abc import Collection
from functools import partial

import numpy as np
from numpy.typing import NDArray

from swapcan.transfer.text import VIN
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Watcher
from typedcan.judge.series import Series
from typedcan.report.language import Text
from typedcan.transfer import text_slots

_SLOTS = text_slots(VIN)
_NUMBER = VIN.frame_number.field if VIN.frame_number else ""


class VinLettersWatcher(Watcher):
    """Says which characters have certain codes; what is beyond character 17 is passed over.

    Parameters
    ----------
    codes
        Those that are wrong.
    text
        What to say of the first in a frame: ``position`` and ``code`` fill it in.
    """

    def __init__(self, findings: Findings, *, codes: Collection[int], text: Text) -> None:
        super().__init__(findings)
        self._text = text
        self._is_wrong = np.isin(np.arange(256), list(codes))

    def feed(self, chunk: Chunk) -> None:
        """Judge the characters of all frames that have a number of the set."""
        series = chunk.frames(VIN.messages[0])
        if not series.fresh:
            return
        wrong = self._wrong(series)
        count = np.count_nonzero(wrong, axis=1)
        subject = Subject(series.message.SENDER, series.message.NAME)
        describe = partial(self._describe, series, wrong)
        self.findings.rows(subject, series, count > 0, describe, count)

    def _wrong(self, series: Series) -> NDArray[np.bool_]:
        """Which characters are wrong, shape (rows, characters of the VIN)."""
        columns: list[NDArray[np.bool_]] = []
        for slot in _SLOTS:
            own = series.raw(_NUMBER) == slot.number
            columns += [own & self._is_wrong[series.raw(name)] for name in slot.used]
        return np.stack(columns, axis=1)

    def _describe(self, series: Series, wrong: NDArray[np.bool_], row: int) -> Said:
        position = int(wrong[row].argmax())
        name = [name for slot in _SLOTS for name in slot.used][position]
        return self._text, {"position": position + 1, "code": int(series.raw(name)[row])}
