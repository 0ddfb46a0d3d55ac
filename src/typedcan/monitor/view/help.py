"""The keys, on a screen of their own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

_HELP = """\
Tab 1 2 3      next pane: {panes}
j k, arrows    down and up; PgUp PgDn, g G: top, end
Enter          the signals of this message
left right     the message before, the one after
/              filter: Enter applies, Esc clears
n N            next and previous match
s F6           sort by the next column
space p        pause: counting and recording go on
r              record to a file; again: stop
c              count and measure anew
h ? F1         this help
q F10          quit

State: ! lost, ~ late, - never seen or ended.
Ended is what is sent only while asked for. Faults
are wrong lengths, checksums, counters. The load is
an estimate from the lengths of frames.

Any of h q Esc Enter goes back."""


class HelpScreen(ModalScreen[None]):
    """Shows the keys until one is pressed that goes back; ``panes`` are those that there are."""

    DEFAULT_CSS = """
    HelpScreen { align: center middle; background: ansi_default; }
    HelpScreen VerticalScroll {
        width: 58; max-width: 100%; height: auto; max-height: 100%;
        border: round ansi_default; padding: 0 1;
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("h,question_mark,f1,q,f10,escape,enter,space", "dismiss", show=False),
    ]

    def __init__(self, panes: Sequence[str]) -> None:
        super().__init__()
        self._text = _HELP.format(panes=", ".join(panes))

    def compose(self) -> ComposeResult:
        """The text in a box."""
        with VerticalScroll():
            yield Static(self._text, markup=False)
