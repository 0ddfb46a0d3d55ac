"""A tolerance: how far from what is printed still counts as right."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from typedcan.report.language import Text


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """A limit that a rule holds against what it measures.

    Parameters
    ----------
    name
        The id of its rule, or what several rules go by, a dot and a word, such as
        ``period-mean.share``; unique.
    value, unit
        The limit where none is given for a run, and its unit; a share has none.
    text
        What is allowed, in one line.
    """

    name: str
    value: float
    unit: str = ""
    text: Text


class Limits:
    """The values of tolerances in one run.

    Parameters
    ----------
    given
        By name, those that are not to have their own value.
    """

    def __init__(self, given: Mapping[str, float] | None = None) -> None:
        self.given = dict(given or {})

    def limit(self, tolerance: Tolerance) -> float:
        """The value of a tolerance."""
        return self.given.get(tolerance.name, tolerance.value)


LAST_KNOWN = Tolerance(
    name="last-known.periods",
    value=3.5,
    text=Text(
        "Periods for which what a message said last still counts: two frames in a row may be lost",
        "报文最后一次内容的有效周期数:允许连续丢失两帧",
    ),
)
SILENCE = Tolerance(
    name="silence.periods",
    value=5.0,
    text=Text(
        "Periods without a frame from which on a node or a message is silent, not late",
        "超过该周期数没有报文时视为沉默,而非延迟",
    ),
)
ASKED_ANEW = Tolerance(
    name="asked-anew.periods",
    value=3.0,
    text=Text(
        "Periods after which a message that is sent on request is taken to be asked for anew",
        "按请求发送的报文超过该周期数后视为重新请求",
    ),
)
SET_BACK = Tolerance(
    name="clock-set-back.seconds",
    value=1.0,
    unit="s",
    text=Text(
        "Times that go back by more say that the clock was set; by less, that channels were mixed",
        "时间倒退超过该值视为时钟被调整,否则视为通道间的乱序",
    ),
)
TURN_DOUBLED = Tolerance(
    name="turn-doubled.cycles",
    value=0.5,
    text=Text(
        "Cycles after which a frame of a group comes again at the earliest",
        "同一分组帧再次出现的最短间隔(周期的倍数)",
    ),
)
TURN_LATE = Tolerance(
    name="turn-late.cycles",
    value=1.5,
    text=Text(
        "Cycles within which a frame of a group that missed its turn is late, not the next one",
        "错过次序的分组帧在该周期数内视为迟到,而非下一帧",
    ),
)

SHARED = (LAST_KNOWN, SILENCE, ASKED_ANEW, SET_BACK, TURN_DOUBLED, TURN_LATE)
"""Those that several rules go by."""
