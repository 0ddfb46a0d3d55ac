"""The line at the bottom: the keys, a remark, or a question that is answered there."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Label

from typedcan.shell.printing import printable

KEYS = "q quit  / filter  space pause  Tab pane  s sort  r record  c clear  h help"


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
