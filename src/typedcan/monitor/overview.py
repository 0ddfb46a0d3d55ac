"""What is shown of a protocol that has no glance of its own: what came over several frames."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

from typedcan.model.signal_state import SignalState
from typedcan.monitor.glance import Alarm, Known, Noticed
from typedcan.shell.printing import printable
from typedcan.transfer import Blocks, Problem, Readings, Text, Transfers, Value
from typedcan.wire.message import Message
from typedcan.wire.protocol import FieldRef, Protocol


@dataclass(frozen=True, slots=True)
class Complete:
    """A value of a transfer that came last, and how many seconds ago it was complete."""

    name: str
    title: str
    value: Value
    age: float

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it: its text, its items, or its readings by group."""
        content: dict[str, Any]
        if isinstance(self.value, Text):
            content = {"text": self.value.text}
        elif isinstance(self.value, Readings):
            groups = self.value.items()
            content = {"groups": {str(group): _plain(each.values()) for group, each in groups}}
        else:
            content = {"items": _plain(self.value.values)}
        return {"title": self.title, **content, "age": self.age}


@dataclass(frozen=True, slots=True)
class Overview:
    """The alarms of all nodes, and the last complete value of each transfer that has one."""

    alarms: tuple[Alarm, ...]
    complete: tuple[Complete, ...]

    @property
    def name(self) -> str:
        """What its pane is called."""
        return "overview"

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it, transfers by their names."""
        return {
            "alarms": [asdict(alarm) for alarm in self.alarms],
            "transfers": {each.name: each.as_dict() for each in self.complete},
        }

    def summary(self) -> list[str]:
        """Nothing: what is to be known first only a glance of its own can say."""
        return []

    def text(self, width: int) -> Any:
        """A line for each value, as a text of `rich`."""
        from rich.text import Text as RichText  # with the view alone there is rich

        from typedcan.monitor.view.styles import age

        lines = [
            RichText(printable(f"{_told(each.title, each.value)}, {age(each.age)} ago"))
            for each in self.complete
        ]
        for line in lines:
            line.truncate(width, overflow="ellipsis")
        return RichText("\n").join(lines)


class OverviewGlance:
    """Puts together what comes over several frames, for any protocol."""

    summed_up: tuple[FieldRef, ...] = ()
    """None: which alarm sums up others, no protocol says."""

    def __init__(self, protocol: Protocol) -> None:
        self._transfers = Transfers(protocol)
        self._titles = {each.name: each.title or each.name for each in protocol.transfers}
        self._complete: dict[str, tuple[Value, float]] = {}

    @property
    def next_check(self) -> float:
        """When `check` has something to do if nothing comes; infinite for never."""
        return self._transfers.next_deadline

    def take(self, message: Message, now: float) -> tuple[Noticed, ...]:
        """Take a message that came at ``now``, and tell what it brings about."""
        return tuple(self._noticed(self._transfers.take(message, now), now))

    def check(self, now: float) -> tuple[Noticed, ...]:
        """What time alone has changed up to now."""
        return tuple(self._noticed(self._transfers.expire(now), now))

    def look(self, known: Known) -> Overview:
        """What there is to be seen."""
        return Overview(
            known.alarms,
            tuple(
                Complete(name, self._titles[name], value, known.time - at)
                for name, (value, at) in self._complete.items()
            ),
        )

    def _noticed(self, outcomes: Iterable[Value | Problem], now: float) -> Iterator[Noticed]:
        for outcome in outcomes:
            if isinstance(outcome, Problem):
                yield Noticed(str(outcome))
                continue
            self._complete[outcome.transfer] = outcome, now
            if not isinstance(outcome, Readings):  # they come again and again
                yield Noticed(_told(self._titles[outcome.transfer], outcome))


def _told(title: str, value: Value) -> str:
    if isinstance(value, Readings):
        return f"{title}: {value.count} readings of {len(value)} groups"
    return f"{title}: {len(value)} items" if isinstance(value, Blocks) else f"{title}: {value}"


def _plain(values: Iterable[Any]) -> list[Any]:
    return [str(each) if isinstance(each, SignalState) else each for each in values]
