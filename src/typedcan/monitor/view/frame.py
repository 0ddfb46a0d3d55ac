"""What stands about the panes: two lines at the top, one at the bottom, the help."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, VerticalScroll
from textual.content import Content
from textual.message import Message
from textual.screen import ModalScreen
from textual.widgets import Input, Label, Static

from typedcan.monitor.picture import Picture
from typedcan.monitor.rows import LATE, LOST
from typedcan.monitor.session import Status
from typedcan.monitor.view.styles import ALERT, WARNING
from typedcan.shell.printing import printable

KEYS = "q quit  / filter  space pause  Tab pane  s sort  r record  c clear  h help"

_GAP = "  "

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


@dataclass(frozen=True, slots=True)
class Shown:
    """How the picture is shown: filtered by, sorted by; empty where it is not. And if it stands."""

    filter: str
    sort: str
    is_paused: bool


def panes_line(panes: Mapping[str, str], current: str, bus: str) -> Content:
    """The panes by their keys, of which one is shown, and the bus; a click on one shows it."""
    return Content.assemble(
        *(
            Content.from_markup(
                f"[{'reverse ' if pane == current else ''}@click=app.show_pane('{pane}')]"
                f" {number} {name} [/]"
            )
            for number, (pane, name) in enumerate(panes.items(), 1)
        ),
        f"{_GAP}{printable(bus)}",
    )


def status_line(picture: Picture, status: Status, shown: Shown) -> Text:
    """What is not as usual first, so that a narrow terminal has it too."""
    parts: list[Text] = []
    if status.bus_lost:
        parts.append(Text(f" bus lost: {printable(status.bus_lost)} ", ALERT))
    if shown.is_paused:
        behind = status.frames - picture.totals.frames
        parts.append(Text(f" PAUSED, {max(behind, 0)} frames since ", WARNING))
    if status.recording:
        parts.append(Text(f" REC {printable(status.recording.name)} {status.recorded} ", WARNING))
    parts.append(Text(_rates(picture)))
    parts += [Text(f"{name} {text}") for name, text in _choices(shown)]
    return Text(_GAP).join(parts)


def _rates(picture: Picture) -> str:
    totals = picture.totals
    states = Counter(row.state for row in picture.messages)
    counts = (
        (states[LATE], "late"),
        (states[LOST], "lost"),
        (totals.faults, "faults"),
        (len(picture.foreign), "foreign ids"),
        (totals.errors, "error frames"),
    )
    told = [f"{count} {what}" for count, what in counts if count]
    rates = [f"{totals.frames_per_second:.0f} frames/s"]
    if totals.load is not None:
        rates.append(f"load about {100 * totals.load:.0f} %")
    return _GAP.join((*rates, *told))


def _choices(shown: Shown) -> list[tuple[str, str]]:
    named = (("filter", shown.filter), ("sort", shown.sort))
    return [(name, text) for name, text in named if text]


class Prompt(Horizontal):
    """Shows the keys, a remark instead, or asks for a line of text."""

    DEFAULT_CSS = """
    Prompt { height: 1; }
    Prompt Label { width: auto; text-wrap: nowrap; }
    Prompt Input, Prompt Input:focus {
        height: 1; border: none; padding: 0; width: 1fr; background: ansi_default;
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "cancel", show=False)]

    class Answered(Message):
        """What was answered to the question of that name; None where it was cancelled."""

        def __init__(self, name: str, text: str | None) -> None:
            super().__init__()
            self.question = name
            self.text = text

    def __init__(self) -> None:
        super().__init__()
        self._label = Label(KEYS, markup=False)
        self._input = Input(compact=True)
        self._question: str | None = None

    @property
    def is_asking(self) -> bool:
        """Whether a question is open."""
        return self._question is not None

    def compose(self) -> ComposeResult:
        """The label, and the input that is there only while a question is open."""
        yield self._label
        yield self._input

    def on_mount(self) -> None:
        """Hide the input."""
        self._input.display = False

    def say(self, text: str) -> None:
        """Show a remark, or the keys where it is empty."""
        if not self.is_asking:
            self._label.update(printable(text) or KEYS)

    def ask(self, name: str, label: str, text: str) -> None:
        """Ask for a text; `Answered` tells what was answered."""
        self._question = name
        self._label.update(f"{label} ")
        self._input.value = text
        self._input.display = True
        # At once: keys that came in one go with the one that asks are for the input.
        self.screen.set_focus(self._input)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Enter was pressed."""
        event.stop()
        self._answer(event.value)

    def action_cancel(self) -> None:
        """Esc was pressed."""
        self._answer(None)

    def _answer(self, text: str | None) -> None:
        name, self._question = self._question, None
        self._input.display = False
        self._label.update(KEYS)
        if name is not None:
            self.post_message(self.Answered(name, text))


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
