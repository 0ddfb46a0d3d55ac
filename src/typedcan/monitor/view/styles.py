"""How things look: legible on dark and light terminals, and never told by colour alone."""

from __future__ import annotations

from rich.text import Text

from typedcan.monitor.rows import ENDED, LATE, LOST, NEVER_SEEN

# Both colours are given, or none: on its own, yellow is lost on white and blue on black.
ALERT = "white on red"
WARNING = "black on yellow"
_QUIET = "dim"

_STATES = {
    LOST: ("! ", ALERT),
    LATE: ("~ ", WARNING),
    NEVER_SEEN: ("- ", _QUIET),
    ENDED: ("- ", _QUIET),
}
_MARKS = {
    "alarm": ALERT,
    LOST: ALERT,
    LATE: WARNING,
    "abnormal": WARNING,
    "out of range": WARNING,
    "unknown code": WARNING,
    "invalid": _QUIET,
}


def state_text(state: str) -> Text:
    """The state of a message with its sign."""
    sign, style = _STATES.get(state, ("  ", ""))
    return Text(sign + state, style)


def mark_text(mark: str | None) -> Text:
    """What is wrong with a signal, with an exclamation mark; empty where nothing is."""
    return Text(f"! {mark}", _MARKS.get(mark, WARNING)) if mark else Text()


def number(text: str, style: str = "") -> Text:
    """A number, at the right."""
    return Text(text, style, justify="right")


def milliseconds(seconds: float | None) -> str:
    """A period, as short as it can be told."""
    if seconds is None:
        return ""
    return f"{1000 * seconds:.1f} ms" if seconds < 10 else f"{seconds:.2f} s"


def age(seconds: float | None) -> str:
    """How long ago something was, in five or six characters."""
    if seconds is None:
        return ""
    if seconds < 100:
        return f"{seconds:.2f} s" if seconds < 10 else f"{seconds:.1f} s"
    return f"{seconds:.0f} s" if seconds < 1000 else f"{seconds / 60:.0f} min"
