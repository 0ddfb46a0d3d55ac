"""Judgements made by hand, for reports: a plain one, and one with all that could break a format."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import (
    Judgement,
    Occurrence,
    Rule,
    RuleResult,
    Severity,
    Subject,
    Tolerance,
)
from typedcan.judge.chunk import Chunk
from typedcan.judge.measure.load import Load
from typedcan.judge.measure.periods import Periods
from typedcan.judge.report.moments import Moment, Track
from typedcan.judge.rule import Watcher
from typedcan.report.language import Text

BEGIN = 1_700_000_000.0
"""2023-11-14 22:13:20 UTC."""

HOSTILE = (
    "</script><script>alert(1)</script><!-- --> ]]> </style> &amp; &#124;",
    "\"double\" 'single' `back` ${x} %s %(x)s {0} {name}",
    "=1+1",
    "电池 <b>管理</b> 100 %",
    "line\nbreak\r\nand\ttab, comma; semicolon",
    "\x00\x07\x1b[31mred\x7f\x9b\u202eright to left\u2028\ufffe\ud800",
    "x" * 500,
)
"""Names of files and texts that no report may take for anything but text."""


class _Idle(Watcher):
    def feed(self, chunk: Chunk) -> None:
        """Judge nothing."""


def rule(id_: str, severity: Severity, *tolerances: Tolerance, title: Text | None = None) -> Rule:
    """A rule that nothing watches for."""
    return Rule(
        id=id_,
        title=title or Text(f"Title of {id_}", f"{id_} 的标题"),
        purpose=Text(f"Why there is {id_}.", f"{id_} 的目的。"),
        clause="5.2.1, Table 14 row 3",
        severity=severity,
        judges=("BMU", "VCU"),
        tolerances=tolerances,
        watch=_Idle,
    )


SHARE = Tolerance(
    name="period-mean.share", value=0.1, text=Text("share of the period", "周期的比例")
)
DELAY = Tolerance(
    name="answer-in-time.delay", value=0.5, unit="s", text=Text("until the answer", "应答时限")
)


def occurrence(start: float, measure: float = 1.0, *, said: str = "", **values: Any) -> Occurrence:
    """One that says `` step of 0.25 s ``, or what it is told to."""
    text = Text("step of {step:.3g} s{said}", "间隔 {step:.3g} s{said}")
    return Occurrence(
        subject=Subject("BMU", "B2V_ST2", "B2V_ST2_SOC", "frame 3"),
        start=start,
        end=start + 0.25,
        order=int(start * 100),
        frames=3,
        measure=measure,
        text=text,
        values={"step": 0.25, "said": said, **values},
    )


def result(of: Rule, *found: Occurrence, examined: int = 1000, count: int = 0) -> RuleResult:
    """What a rule found; ``count`` where it found more than is kept."""
    return RuleResult(
        rule=of,
        examined=examined,
        count=count or len(found),
        frames=3 * (count or len(found)),
        occurrences=found,
        worst=max(found, key=lambda each: each.measure, default=None),
    )


def periods(message: str = "B2V_ST2", period: float = 0.1) -> Periods:
    """A message that comes in time, but for a gap and one late frame."""
    time = np.array([1.0, 2.0, 3.0, 7.0, 8.0, 9.0])
    return Periods(
        message=message,
        period=period,
        frames=600,
        mean=period * 1.01,
        deviation=period / 50,
        shortest=period * 0.8,
        longest=period * 5,
        time=time,
        low=np.full(6, period * 0.8),
        high=np.array([1.1, 1.2, 1.1, 5.0, 1.1, 1.1]) * period,
    )


LOAD = Load(
    channel="can0",
    measured=0.25,
    measured_stuffed=0.3,
    own=0.2,
    own_stuffed=0.24,
    expected=0.21,
    expected_stuffed=0.26,
    bit_rate=250_000,
)

FIRST = occurrence(2.5)
WORST = occurrence(5.0, 9.0)

PLAIN = Judgement(
    protocol=PROTOCOL,
    log="drive.blf",
    digest="ab" * 32,
    begin=BEGIN,
    seconds=10.0,
    frames={"B2V_ST2": 600, "": 12, "B2V_ST1": 100},
    nodes=("BMU", "VCU"),
    seen=("BMU", "CHG"),
    results=(
        result(rule("answer-in-time", Severity.MUST, DELAY), FIRST, WORST, count=1234),
        result(rule("period-mean", Severity.SHOULD, SHARE), occurrence(1.0)),
        result(rule("spare-bits", Severity.INFO), occurrence(0.5)),
        result(rule("checksum", Severity.MUST)),
        result(rule("never-seen", Severity.MUST), examined=0),
    ),
    periods=(periods(),),
    load=(LOAD,),
    limits={"answer-in-time.delay": 0.75},
    damage=("drive.blf: damaged at byte 17: no such object; lost: 3 bytes",),
)
"""One rule of each kind and with each status; it does not conform."""

GOOD = replace(
    PLAIN, log="good.log", begin=0.0, seen=("BMU", "VCU"), results=PLAIN.results[3:], damage=()
)
"""It conforms, and has no date."""

EMPTY = replace(
    PLAIN,
    log="empty.log",
    frames={},
    seen=(),
    results=PLAIN.results[4:],
    periods=(),
    load=(),
    seconds=0.0,
    damage=(),
)
"""Nothing in it."""

MOMENT = Moment(
    rule="answer-in-time",
    occurrence=FIRST,
    begin=1.5,
    end=3.75,
    tracks=(
        Track(
            name="B2V_ST2_SOC",
            unit="%",
            time=np.array([1.5, 1.6, 1.7, 3.0]),
            value=np.array([80.0, 80.4, np.nan, 81.2]),
        ),
        Track(
            name="B2V_ST1_BMSState",
            unit="",
            time=np.array([1.5, 2.0]),
            value=np.array([0.0, 2.0]),
            labels={0: "Off", 2: "<On>"},
        ),
        Track(name="B2V_ST2", unit="", time=np.array([1.5, 1.6]), value=None),
        Track(name="B2V_ST3", unit="", time=np.empty(0), value=None),
    ),
)
"""Around the first occurrence of `PLAIN`."""


def hostile(text: str) -> Judgement:
    """A judgement that says the text wherever the outside has a say."""
    of = rule("answer-in-time", Severity.MUST, DELAY, title=Text(text, text))
    found = replace(occurrence(2.5, said=text), subject=Subject("BMU", text, text, text))
    return replace(
        PLAIN,
        log=text,
        results=(result(replace(of, clause=text), found),),
        load=(replace(LOAD, channel=text),),
        periods=(periods(text),),
        damage=(text,),
    )


def odd(values: Mapping[str, Any]) -> Judgement:
    """A judgement whose one occurrence has these values too."""
    found = occurrence(1.0, **values)
    return replace(PLAIN, results=(result(rule("checksum", Severity.MUST), found),))
