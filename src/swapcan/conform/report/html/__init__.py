"""The report as a page for browsers."""

from swapcan.conform.report.html.page import to_html

__all__ = ["to_html"]
