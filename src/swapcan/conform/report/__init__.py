"""Reports on judgements, in English and in Chinese: functions from judgements to text.

The same judgements give the same bytes. Only `moments` reads a file: the log, once more.
"""

from swapcan.conform.report.as_json import to_json
from swapcan.conform.report.environment import environment
from swapcan.conform.report.facts import overall
from swapcan.conform.report.html import to_html
from swapcan.conform.report.junit import to_junit
from swapcan.conform.report.moments import Moment, Track, moments
from swapcan.conform.report.table import to_csv
from swapcan.conform.report.terminal import summary

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
