"""The progress bar: on a terminal only, with share, rate and time left."""

from __future__ import annotations

import io

import pytest

from typedcan.logs.progress import Progress, bar


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_is_drawn_on_a_terminal_and_taken_away() -> None:
    stream = _Terminal()
    progress = Progress(1000, stream)
    progress._line._next = 0.0
    progress.update(500, 10)
    drawn = stream.getvalue()
    assert "50%" in drawn
    assert "10 frames" in drawn
    progress.clear()
    assert stream.getvalue().removeprefix(drawn).strip() == ""


def test_progress_is_silent_elsewhere() -> None:
    stream = io.StringIO()
    progress = Progress(1000, stream)
    progress._line._next = 0.0
    progress.update(500, 10)
    progress.clear()
    assert stream.getvalue() == ""


@pytest.mark.parametrize(
    ("position", "frames", "seconds", "expected"),
    [
        (250, 1000, 10.0, [" 25%", "1,000 frames", "100/s", "0:30 left"]),
        (1000, 7200, 3600.0, ["100%", "2/s", "0:00 left"]),
        (1, 10, 10.0, ["  0%", "2:46:30 left"]),
    ],
)
def test_the_bar_says_share_rate_and_time_left(
    position: int, frames: int, seconds: float, expected: list[str]
) -> None:
    text = bar(position, 1000, frames, seconds)
    for part in expected:
        assert part in text
