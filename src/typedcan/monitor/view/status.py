"""The two lines at the top: the panes and the bus, and how things are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from rich.text import Text
from textual.content import Content

from typedcan.monitor.picture import Picture
from typedcan.monitor.rows import LATE, LOST
from typedcan.monitor.session import Status
from typedcan.monitor.view.styles import ALERT, WARNING
from typedcan.shell.printing import printable

_GAP = "  "


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
