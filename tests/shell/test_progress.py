"""The line that says how far something is."""

from __future__ import annotations

import io

import pytest

from typedcan.shell.progress import StatusLine


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time that the line sees, as its only element."""
    now = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    return now


def on_screen(written: str) -> str:
    """The line that a terminal shows after all that was written."""
    cells: list[str] = []
    for piece in written.split("\r"):
        cells[: len(piece)] = piece
    return "".join(cells).rstrip()


def test_a_shorter_line_takes_the_whole_place_of_a_longer_one(clock: list[float]) -> None:
    stream = Terminal()
    line = StatusLine(stream)
    for text in ("a long line", "short"):
        clock[0] += 1.0
        line.draw(lambda text=text: text)  # type: ignore[misc]
        assert on_screen(stream.getvalue()) == text
    line.clear()
    assert on_screen(stream.getvalue()) == ""
    assert stream.getvalue().endswith("\r")


def test_it_is_drawn_five_times_a_second_at_most_and_not_at_once(clock: list[float]) -> None:
    line, drawn = StatusLine(Terminal()), []
    for _ in range(1000):
        line.draw(lambda: drawn.append(clock[0]) or "")  # type: ignore[func-returns-value]
        clock[0] += 0.001
    assert len(drawn) == 4
    assert drawn[0] == pytest.approx(100.2)


def test_nothing_in_it_is_obeyed_by_the_terminal(clock: list[float]) -> None:
    stream = Terminal()
    line = StatusLine(stream)
    clock[0] += 1.0
    line.draw(lambda: "can0\x1b[2J\n")
    assert on_screen(stream.getvalue()) == r"can0\x1b[2J\n"


def test_nothing_is_drawn_where_there_is_no_terminal(clock: list[float]) -> None:
    stream = io.StringIO()
    line = StatusLine(stream)
    clock[0] += 1.0
    line.draw(lambda: "text")
    line.clear()
    assert stream.getvalue() == ""
