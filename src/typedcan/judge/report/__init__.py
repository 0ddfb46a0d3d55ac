"""Reports on judgements, in English and in Chinese: functions from judgements to text.

The same judgements give the same bytes. Only `moments` reads a file: the log, once more.
"""

from typedcan.judge.report.as_json import to_json
from typedcan.judge.report.environment import environment
from typedcan.judge.report.facts import overall
from typedcan.judge.report.html import to_html
from typedcan.judge.report.junit import to_junit
from typedcan.judge.report.moments import Moment, Track, moments
from typedcan.judge.report.table import to_csv
from typedcan.judge.report.terminal import summary

__all__ = [
    "Moment",
    "Track",
    "environment",
    "moments",
    "overall",
    "summary",
    "to_csv",
    "to_html",
    "to_json",
    "to_junit",
]
