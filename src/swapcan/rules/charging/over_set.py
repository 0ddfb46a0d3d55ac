"""An output of the charger over its set point: what the rules on both of them share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from swapcan.messages import B2C_Charger, C2B_ACStatus, ChargeControl
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SHARE = 0.02
_SECONDS = 1.5


@dataclass(frozen=True, slots=True)
class Slack:
    """What an output may be over its set point: a share, so much more, and for how long."""

    share: Tolerance
    more: Tolerance
    seconds: Tolerance

    @property
    def all(self) -> tuple[Tolerance, ...]:
        """The tolerances of the rule."""
        return self.share, self.more, self.seconds


def slack_of(rule: str, word: str, more: float, unit: str) -> Slack:
    """The tolerances of a rule; ``more`` so many units beside the share of the set point."""
    return Slack(
        Tolerance(
            name=f"{rule}.share",
            value=_SHARE,
            text=Text(
                "over the set point, as a share of it: control and measurement are not exact",
                "超出设定值的比例,考虑控制与测量误差",
            ),
        ),
        Tolerance(
            name=f"{rule}.{word}",
            value=more,
            unit=unit,
            text=Text("over the set point, beside the share", "除比例外另可超出设定值的量"),
        ),
        Tolerance(
            name=f"{rule}.seconds",
            value=_SECONDS,
            unit="s",
            text=Text(
                "for which it may be over: three periods to follow a set point that falls",
                "允许超出的时间:设定值下降后有三个周期用于跟随",
            ),
        ),
    )


class OverSet(LastingWatcher):
    """Compares an output of C2B_ACStatus with what B2C_Charger sets."""

    def __init__(
        self, findings: Findings, slack: Slack, fields: tuple[str, str], over: Text
    ) -> None:
        super().__init__(findings)
        self._share, self._more = findings.limit(slack.share), findings.limit(slack.more)
        self._given, self._set = fields
        self._text = over
        signal = C2B_ACStatus.FIELDS[self._given].dbc_name
        subject = Subject("CHG", "C2B_ACStatus", signal)
        self._over = self.lasting(subject, findings.limit(slack.seconds), C2B_ACStatus)

    def feed(self, chunk: Chunk) -> None:
        """Judge the output while charging is asked for."""
        series = chunk.sound(C2B_ACStatus)
        order = LastKnown(chunk.sound(B2C_Charger), series)
        given, wanted = series.value(self._given), order.value(self._set)
        excess = given - wanted * (1 + self._share) - self._more
        judged = order.is_code("charge_control", ChargeControl.START_TO_CHARGE)

        def describe(row: int) -> Said:
            return self._text, {"given": float(given[row]), "set": float(wanted[row])}

        self._over.feed(series, judged & ~np.isnan(excess), excess > 0, describe, excess)
