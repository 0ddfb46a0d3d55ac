"""The report as a page for browsers."""

from typedcan.judge.report.html.page import to_html

__all__ = ["to_html"]
