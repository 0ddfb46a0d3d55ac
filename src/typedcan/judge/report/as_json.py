"""Judgements as JSON, for programs.

One object: ``format`` ("swapcan-conform"), ``version`` (1), ``language`` of all texts, ``protocol``
(``name``, ``digest``; null without logs), ``verdict`` of all logs together, and ``logs``, each of
them an object:

- ``log``, ``digest`` (SHA-256), ``verdict`` ("conforms", "violates", "not_judged");
- ``begin`` (time stamp of the first frame), ``begin_utc`` (null where it is no date), ``seconds``;
- ``frames`` (by message; the empty name counts those of none), ``nodes``, ``seen``, ``damage``,
  ``tolerances`` that several rules go by, as those of a rule;
- ``rules``: ``id``, ``title``, ``purpose``, ``clause``, ``severity`` ("must", "should", "info";
  that of what was found, where it is less), ``errata`` that it rests on, ``judges``,
  ``tolerances`` (``name``, ``value`` in force, ``default``, ``unit``, ``text``),
  ``status`` ("passed", "failed", "noted", "not_judged"), ``reason`` (why it was not judged, else
  empty), ``examined``, ``count``, ``frames``,
  ``worst`` (an occurrence or null), ``occurrences``: the first of them, by time;
- ``periods``: ``message``, ``period``, ``frames``, ``mean``, ``deviation``, ``shortest``,
  ``longest`` in seconds, and ``spans`` of ``time``, ``low``, ``high``;
- ``load``: per ``channel`` shares of the bit rate: ``measured``, ``own`` (of the protocol) and
  ``expected``, each without stuff bits, and as ``measured_stuffed``, ``own_stuffed`` and
  ``expected_stuffed`` with the most there can be.

An occurrence has ``node``, ``message``, ``signal``, ``detail``, ``start`` and ``end`` in seconds
since the log's begin, ``order`` (number of its first frame, from 0), ``frames``, ``measure``,
``text`` and the ``values`` in it; ``is_open``, whether the standard leaves open what is right, so
that no demand is broken, and the ``errata`` that it then rests on. What is no number is null.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from numbers import Integral, Real
from typing import Any

from typedcan.judge.findings import Occurrence
from typedcan.judge.judgement import Judgement, RuleResult
from typedcan.judge.measure.periods import Periods
from typedcan.judge.report import facts, figures
from typedcan.judge.tolerance import SHARED, Tolerance
from typedcan.report.language import Language, Text
from typedcan.shell.printing import printable_json


def to_json(judgements: Sequence[Judgement], language: Language) -> str:
    """The JSON text, its keys always in the same order; see this module for their meaning."""
    protocol = judgements[0].protocol if judgements else None
    document = {
        "format": "swapcan-conform",
        "version": 1,
        "language": language,
        "protocol": protocol and {"name": protocol.name, "digest": protocol.digest},
        "verdict": facts.overall(judgements).name.lower(),
        "logs": [_log(judgement, language) for judgement in judgements],
    }
    return printable_json(document, indent=1) + "\n"


def _log(judgement: Judgement, language: Language) -> dict[str, Any]:
    return {
        "log": judgement.log,
        "digest": judgement.digest,
        "verdict": judgement.verdict.name.lower(),
        "begin": _time(judgement.begin),
        "begin_utc": figures.utc(judgement.begin) or None,
        "seconds": _time(judgement.seconds),
        "frames": dict(sorted(judgement.frames.items())),
        "nodes": list(judgement.nodes),
        "seen": list(judgement.seen),
        "damage": list(judgement.damage),
        "tolerances": _tolerances(judgement, SHARED, language),
        "rules": [_rule(judgement, result, language) for result in judgement.results],
        "periods": [_periods(each) for each in judgement.periods],
        "load": [
            {name: _plain(value) for name, value in asdict(load).items() if name != "bit_rate"}
            for load in judgement.load
        ],
    }


def _rule(judgement: Judgement, result: RuleResult, language: Language) -> dict[str, Any]:
    rule = result.rule
    return {
        "id": rule.id,
        "title": rule.title.within(language),
        "purpose": rule.purpose.within(language),
        "clause": rule.clause,
        "severity": result.severity.name.lower(),
        "errata": list(rule.errata),
        "judges": list(rule.judges),
        "tolerances": _tolerances(judgement, rule.tolerances, language),
        "status": result.status.name.lower(),
        "reason": facts.reason(judgement, result, language),
        "examined": result.examined,
        "count": result.count,
        "frames": result.frames,
        "worst": None if result.worst is None else _occurrence(result.worst, language),
        "occurrences": [_occurrence(each, language) for each in result.occurrences],
    }


def _tolerances(
    judgement: Judgement, tolerances: Iterable[Tolerance], language: Language
) -> list[dict[str, Any]]:
    return [
        {
            "name": each.name,
            "value": _plain(facts.in_force(judgement, each)),
            "default": _plain(each.value),
            "unit": each.unit,
            "text": each.text.within(language),
        }
        for each in tolerances
    ]


def _occurrence(found: Occurrence, language: Language) -> dict[str, Any]:
    values = {
        name: value.within(language) if isinstance(value, Text) else _plain(value)
        for name, value in found.values.items()
    }
    return {
        **found.subject._asdict(),
        "start": _time(found.start),
        "end": _time(found.end),
        "order": found.order,
        "frames": found.frames,
        "measure": _plain(found.measure),
        "text": found.says(language),
        "values": values,
        "is_open": found.is_open,
        "errata": list(found.errata),
    }


def _periods(periods: Periods) -> dict[str, Any]:
    return {
        "message": periods.message,
        "period": _time(periods.period),
        "frames": periods.frames,
        "mean": _time(periods.mean),
        "deviation": _time(periods.deviation),
        "shortest": _time(periods.shortest),
        "longest": _time(periods.longest),
        "spans": {
            "time": _times(periods.time.tolist()),
            "low": _times(periods.low.tolist()),
            "high": _times(periods.high.tolist()),
        },
    }


def _times(times: Iterable[float]) -> list[float | None]:
    return [_time(time) for time in times]


def _time(time: float) -> float | None:
    """Seconds to the microsecond."""
    return round(float(time), 6) if math.isfinite(time) else None


def _plain(value: object) -> object:
    """A value as JSON has it; numbers to nine digits."""
    if isinstance(value, bool | str):
        return value
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        return float(f"{float(value):.9g}") if math.isfinite(value) else None
    return str(value)
