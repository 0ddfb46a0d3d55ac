"""A current over the limit that the pack allows: what the two rules on limits share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST2, V2B_CMD
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text


@dataclass(frozen=True, slots=True)
class Slack:
    """What a current may be over its limit: a share of it and so many A, and for how long."""

    share: Tolerance
    current: Tolerance
    seconds: Tolerance

    @property
    def all(self) -> tuple[Tolerance, ...]:
        """The tolerances of the rule."""
        return self.share, self.current, self.seconds


def slack_of(rule: str) -> Slack:
    """The tolerances of a rule on a limit."""
    return Slack(
        Tolerance(
            name=f"{rule}.share",
            value=0.05,
            text=Text(
                "over the limit, as a share of it: control and sensor are not exact",
                "超出限值的比例,考虑控制与传感器误差",
            ),
        ),
        Tolerance(
            name=f"{rule}.current",
            value=5.0,
            unit="A",
            text=Text("over the limit, beside the share", "除比例外另可超出限值的电流"),
        ),
        Tolerance(
            name=f"{rule}.seconds",
            value=1.0,
            unit="s",
            text=Text(
                "for which it may be over, as a limit that falls has to be followed",
                "允许超出的时间,因限值下降后需要时间跟随",
            ),
        ),
    )


class OverLimit(LastingWatcher):
    """Compares a current of B2V_ST2 with a limit of the same frame, while the VCU is heard."""

    def __init__(self, findings: Findings, slack: Slack, limit: str, over: Text) -> None:
        super().__init__(findings)
        self._share, self._current = findings.limit(slack.share), findings.limit(slack.current)
        self._limit = limit
        self._text = over
        subject = Subject("VCU", "B2V_ST2", "B2V_ST2_Current")
        self._over = self.lasting(subject, findings.limit(slack.seconds), B2V_ST2)

    def judge(
        self, chunk: Chunk, series: Series, current: NDArray[np.float64], judged: NDArray[np.bool_]
    ) -> None:
        """Judge a current in A, positive in the direction of the limit."""
        limit = series.value(self._limit)
        excess = current - limit * (1 + self._share) - self._current
        truck = LastKnown(chunk.sound(V2B_CMD), series)

        def describe(row: int) -> Said:
            return self._text, {"current": float(current[row]), "limit": float(limit[row])}

        valid = judged & truck.known & ~np.isnan(excess)
        self._over.feed(series, valid, excess > 0, describe, excess)
