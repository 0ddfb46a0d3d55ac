"""The view itself: its keys, and the picture that it shows ten times a second."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

from textual import events
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import ContentSwitcher, DataTable, Static

from typedcan.monitor.picture import Picture
from typedcan.monitor.session import Session
from typedcan.monitor.view.frame import HelpScreen, Prompt, Shown, panes_line, status_line
from typedcan.monitor.view.panes import GlancePane, MessagesPane, SignalsPane, Where
from typedcan.shell.recording import RecordingError, free_name

INTERRUPTED = 130
"""The exit status after Ctrl-C."""

_TICK = 0.1
_PANES = ("messages", "signals", "glance")


class MonitorApp(App[int]):
    """Shows a session until it is left; the result is the exit status.

    Parameters
    ----------
    session
        What is shown.
    bus
        The name of the bus.
    name_filter
        What the messages are filtered by at first.
    record_name
        What names of recordings begin with that are proposed.
    is_over
        Whether it is time to end.
    """

    CSS = """
    Screen { background: ansi_default; color: ansi_default; }
    #panes, #status { height: 1; text-wrap: nowrap; text-overflow: ellipsis; }
    ContentSwitcher { height: 1fr; }
    GlancePane { scrollbar-size: 1 1; background: ansi_default; }
    """
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("q,f10", "leave(0)", show=False),
        Binding("ctrl+c", f"leave({INTERRUPTED})", show=False, priority=True),
        Binding("tab", "next_pane(1)", show=False, priority=True),
        Binding("shift+tab", "next_pane(-1)", show=False, priority=True),
        *(Binding(str(n), f"show_pane('{p}')", show=False) for n, p in enumerate(_PANES, 1)),
        Binding("j", "move('down')", show=False),
        Binding("k", "move('up')", show=False),
        Binding("g", "move('top')", show=False),
        Binding("G", "move('end')", show=False),
        Binding("n", "match(1)", show=False),
        Binding("N", "match(-1)", show=False),
        # First of all, so that keys that come in one go with them are for the prompt.
        Binding("slash", "ask_filter", show=False, priority=True),
        Binding("r", "record", show=False, priority=True),
        Binding("escape", "clear_filter", show=False),
        Binding("space,p", "pause", show=False),
        Binding("s,f6", "sort", show=False),
        Binding("c", "clear_counts", show=False),
        Binding("h,question_mark,f1", "help", show=False),
    ]

    def __init__(
        self,
        session: Session,
        bus: str,
        *,
        name_filter: str = "",
        record_name: str = "recording",
        is_over: Callable[[], bool] = lambda: False,
    ) -> None:
        # The terminal's own colours, be it dark or light; said here too, for NO_COLOR.
        super().__init__(ansi_color=True)
        self.theme = "ansi-dark"
        self._session = session
        self._bus = bus
        self._record_name = record_name
        self._is_over = is_over
        self._picture: Picture = session.picture()
        self._is_paused = False
        self._ended = session.status().ended
        self._panes = {name: name for name in _PANES} | {"glance": self._picture.look.name}
        self._messages = MessagesPane(self._picture.protocol)
        self._messages.filter = name_filter
        self._signals = SignalsPane()
        self._glance = GlancePane()
        self._switcher = ContentSwitcher(initial=_PANES[0])
        self._panes_line = Static(id="panes")
        self._status_line = Static(id="status")
        self._prompt = Prompt()

    def compose(self) -> ComposeResult:
        """Two lines, a pane, and a line."""
        yield self._panes_line
        yield self._status_line
        with self._switcher:
            yield self._messages
            yield self._signals
            yield self._glance
        yield self._prompt

    def on_mount(self) -> None:
        """Begin to show."""
        self.action_show_pane(_PANES[0])
        self.set_interval(_TICK, self.renew)
        self.call_after_refresh(self.renew)

    def renew(self) -> None:
        """Take a new picture, unless this is paused, and show it."""
        if self._is_over():
            self.exit(0)
            return
        if not self._is_paused:
            self._picture = self._session.picture()
        self._show()

    def on_resize(self) -> None:
        """Other columns may fit."""
        self.call_after_refresh(self._show)

    def on_key(self, _event: events.Key) -> None:
        """What was said at the bottom is read."""
        self._prompt.say("")

    def on_data_table_row_selected(self, event: DataTable.RowSelected) -> None:
        """Enter or a click on a message: show its signals."""
        if event.data_table is self._messages.table:
            self.action_show_pane("signals")

    def on_prompt_answered(self, event: Prompt.Answered) -> None:
        """A filter or a file name was given."""
        self._focus()
        if event.question == "filter":
            self._set_filter(event.text or "")
        elif event.text:
            self._begin_recording(Path(event.text).expanduser())

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Whether a key does this now: where text is typed, or help shown, it does not."""
        if action in ("ask_filter", "record") and self._is_busy:
            return False
        return super().check_action(action, parameters)

    def action_leave(self, status: int) -> None:
        """End with that exit status."""
        self.exit(status)

    def action_show_pane(self, name: str) -> None:
        """Show a pane."""
        if not self._is_busy:
            self._switcher.current = name
            self._focus()
            self.call_after_refresh(self._show)

    def action_next_pane(self, step: int) -> None:
        """Show the next pane."""
        self.action_show_pane(_PANES[(_PANES.index(self._pane) + step) % len(_PANES)])

    def action_move(self, where: Where) -> None:
        """Move the cursor, or scroll."""
        (self._tables or self._glance).move(where)

    def action_match(self, step: int) -> None:
        """Go to the next match."""
        if self._tables:
            self._tables.step(step)

    def action_step(self, step: int) -> None:
        """Go to the next message."""
        self._messages.step(step)
        self._show()

    def action_ask_filter(self) -> None:
        """Ask what to filter by."""
        if self._tables:
            self._prompt.ask("filter", "filter:", self._tables.filter)

    def action_clear_filter(self) -> None:
        """Show all rows."""
        self._set_filter("")

    def action_sort(self) -> None:
        """Sort by the next column."""
        if self._tables:
            self._tables.sort_by_next()
            self._show()

    def action_pause(self) -> None:
        """Let the picture stand still, or go on."""
        self._is_paused = not self._is_paused
        self.renew()

    def action_clear_counts(self) -> None:
        """Count anew."""
        self._session.clear()
        self.renew()

    def action_record(self) -> None:
        """Ask where to record to, or end the recording."""
        if self._session.status().recording:
            self._session.stop_recording()
            self._show()
        else:
            self._prompt.ask("record", "record to:", str(free_name(Path(), self._record_name)))

    def action_help(self) -> None:
        """Show the keys."""
        self.push_screen(HelpScreen(tuple(self._panes.values())))

    @property
    def _pane(self) -> str:
        return self._switcher.current or _PANES[0]

    @property
    def _tables(self) -> MessagesPane | SignalsPane | None:
        """The pane with a table, if it is one that is shown."""
        if self._pane == "messages":
            return self._messages
        return self._signals if self._pane == "signals" else None

    @property
    def _is_busy(self) -> bool:
        """Whether keys are for something else than the panes."""
        return self._prompt.is_asking or len(self.screen_stack) > 1

    def _focus(self) -> None:
        self.screen.set_focus(self._tables.table if self._tables else self._glance)

    def _set_filter(self, text: str) -> None:
        if self._tables:
            self._tables.filter = text.strip()
            self._show()

    def _begin_recording(self, path: Path) -> None:
        try:
            self._session.record(path)
        except RecordingError as error:
            self._prompt.say(str(error))
        self._show()

    def _show(self) -> None:
        status = self._session.status()
        if status.ended is not None and status.ended is not self._ended:
            self._prompt.say(str(status.ended))
        self._ended = status.ended
        table = self._tables
        choices = (table.filter, table.sort) if table else ("", "")
        shown = Shown(*choices, is_paused=self._is_paused)
        self._panes_line.update(panes_line(self._panes, self._pane, self._bus))
        self._status_line.update(status_line(self._picture, status, shown))
        if table is self._messages:
            self._messages.show(self._picture)
        elif table is self._signals:
            self._signals.show(self._picture, self._messages.table.selected)
        else:
            self._glance.show(self._picture)
