"""The text that an app of Textual has on its screen."""

from __future__ import annotations

from typing import Any

from textual.app import App

_FIRST_ROW = 3
_AFTER_ROWS = -1


def screen_lines(app: App[Any]) -> list[str]:
    """The lines of the screen, without the spaces at their ends."""
    strips = app.screen._compositor.render_strips()
    return ["".join(segment.text for segment in strip).rstrip() for strip in strips]


def rows_of(lines: list[str]) -> list[str]:
    """The rows of the table of messages."""
    return [line for line in lines[_FIRST_ROW:_AFTER_ROWS] if line]
