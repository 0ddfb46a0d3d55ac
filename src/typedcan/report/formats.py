"""Every report format by name, and the one function that renders."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from typedcan.model.errors import ReadError
from typedcan.report.as_github import to_github
from typedcan.report.as_gitlab import to_gitlab
from typedcan.report.as_html import to_html
from typedcan.report.as_json import to_json
from typedcan.report.as_junit import to_junit
from typedcan.report.as_markdown import to_markdown
from typedcan.report.as_sarif import to_sarif
from typedcan.report.as_text import to_text
from typedcan.report.item import Report

FORMATS: Mapping[str, Callable[[Report], str]] = {
    "text": to_text,
    "json": to_json,
    "markdown": to_markdown,
    "sarif": to_sarif,
    "github": to_github,
    "gitlab": to_gitlab,
    "junit": to_junit,
    "html": to_html,
}
"""Each takes all findings to one text with LF line ends; the same findings make the same text."""


def render(report: Report, format: str, *, colour: bool = False, ascii_only: bool = False) -> str:
    """The report in one of `FORMATS`; raises `ReadError` for another.

    ``colour`` matters for text alone. With ``ascii_only`` the formats that can spell any
    character in ASCII (JSON, SARIF, Code Quality, Markdown, JUnit, HTML) do so and lose nothing;
    text and workflow commands cannot, and get arrows of ASCII only.
    """
    if format not in FORMATS:
        raise ReadError(f"there is no report format {format!r}: take one of {', '.join(FORMATS)}")
    if format == "text":
        return to_text(report, colour=colour, ascii_only=ascii_only)
    text = FORMATS[format](report)
    return _ASCII[format](text) if ascii_only else text


def _json(text: str) -> str:
    """Everything beyond ASCII in JSON stands in strings, which know escapes."""
    return re.sub(r"[^\x00-\x7f]", lambda found: _utf16(found[0]), text)


def _utf16(character: str) -> str:
    units = character.encode("utf-16-be").hex()
    return "".join(f"\\u{units[at : at + 4]}" for at in range(0, len(units), 4))


def _references(text: str) -> str:
    return text.encode("ascii", "xmlcharrefreplace").decode()


def _arrows(text: str) -> str:
    return text.replace("→", "->")


_ASCII: Mapping[str, Callable[[str], str]] = {
    "json": _json,
    "sarif": _json,
    "gitlab": _json,
    "markdown": _references,
    "junit": _references,
    "html": _references,
    "github": _arrows,
}
