"""What `monitor` prints where there is no terminal: lines of text, or JSON.

Text has a line for each thing that happens, with the seconds since the start: a message is late,
lost or alive again, an alarm begins or ends, a frame has a fault (once per interval for each kind
of each message), a value over several frames is complete, the bus is lost or back. That a signal
is invalid is not told; JSON has it. At each interval there is a line that sums up.

JSON has one object per interval, one a line, and one at the end if frames came since:

    {"time": 2.0, "bus_lost": null, "recording": {"file": "drive.blf", "frames": 1680},
     "totals": {"seconds": 2.0, "frames": 1680, "messages": 1671, "length": 0, "checksum": 1,
                "counter": 2, "foreign": 6, "errors": 0, "frames_per_second": 840.2,
                "load": 0.47, "faults": 3},
     "messages": [{"name": "Motor_Status", "frame_id": 201, "is_extended": false,
                   "sender": "Motor", "receivers": ["Panel"], "state": "alive", "frames": 20,
                   "age": 0.05, "period": 0.1, "mean": 0.1001, "jitter": 0.0004, "worst": 0.1012,
                   "faults": {"length": 0, "checksum": 0, "counter repeated": 0, ...},
                   "wrong": 2, "last": {...}}, ...],
     "alarms": [{"message": "Motor_Status", "signal": "Motor_Heat", "title": "Motor too hot",
                 "text": "Too hot", "age": 1.5}],
     "transfers": {"serial": {"title": "Serial number", "text": "A7K2", "age": 0.8}, ...},
     "foreign": [{"frame_id": 419360512, "is_extended": true, "frames": 6, "age": 0.3}]}

Times are in seconds, ``time`` since the start, ``totals.seconds`` and all counts since counting
began. ``state`` is "alive", "late", "lost", "never seen", "ended" (what is sent only while asked
for) or "seen" (what is sent on events). ``mean``, ``jitter`` and ``worst`` are those of the
measured period, null before there is one. ``wrong`` counts signals that say something is wrong.
``last`` is the last frame as `listen --json` prints it, null where there was none. ``load`` is a
share of 1, and an estimate; null where the bit rate is not known. ``transfers`` has the last value
of each that was complete: a text, ``items``, or readings as ``groups``. A protocol with a glance of
its own has what that shows in place of ``alarms``, which are among it, and ``transfers``.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from typing import Any

from typedcan.commands.transcript import json_object
from typedcan.monitor.glance import Seen
from typedcan.monitor.picture import Picture
from typedcan.monitor.rows import MessageRow
from typedcan.monitor.session import Session, SessionEvent, Status
from typedcan.shell.console import say
from typedcan.supervise import NotSeen, SignalChanged, StateChanged
from typedcan.wire.link import Fault


class MonitorLines:
    """Prints a session.

    Parameters
    ----------
    session
        What is printed.
    as_json
        Whether the lines are JSON.
    name_filter
        Which messages are told of; empty for all.
    """

    def __init__(self, session: Session, *, as_json: bool, name_filter: str) -> None:
        self._session = session
        self._as_json = as_json
        self._filter = name_filter
        self._names = {row.name for row in session.picture().messages if row.matches(name_filter)}
        self._told: set[tuple[str, str]] = set()
        self._last_frames = -1

    def events(self) -> None:
        """Print what happened since the last call, unless the lines are JSON."""
        for at, event in self._session.events():
            if not self._as_json and (text := self._event_text(event)):
                say(f"{at - self._session.began:10.3f}  {text}", flush=True)

    def summary(self) -> None:
        """Print how things are now."""
        picture, status = self._session.picture(), self._session.status()
        rows = [row for row in picture.messages if row.matches(self._filter)]
        self._told.clear()
        self._last_frames = status.frames
        time = picture.time - self._session.began
        if self._as_json:
            told = {"time": _rounded(time), **_as_json(picture, status, rows)}
            say(json.dumps(told, allow_nan=False), flush=True)
        else:
            say(f"{time:10.3f}  {_summary(picture, status, rows)}", flush=True)

    def end(self) -> None:
        """Print what is left: also how things are, if frames came since that was told."""
        self.events()
        if self._session.status().frames != self._last_frames:
            self.summary()

    def _event_text(self, event: SessionEvent) -> str:
        if isinstance(event, Fault):
            key = (event.message, str(event.counter or event.kind))
            is_news = key not in self._told
            self._told.add(key)
            return str(event) if is_news and self._matches(event.message, str(event)) else ""
        if isinstance(event, StateChanged | NotSeen | SignalChanged):
            is_told = not isinstance(event, SignalChanged) or event.kind != "invalid"
            return str(event) if is_told and self._matches(event.message.NAME, str(event)) else ""
        return str(event)

    def _matches(self, message: str, text: str) -> bool:
        return message in self._names or self._filter.lower() in text.lower()


def _summary(picture: Picture, status: Status, rows: list[MessageRow]) -> str:
    totals = picture.totals
    states = Counter(row.state for row in rows)
    parts = [
        f"{totals.frames} frames",
        f"{totals.frames_per_second:.0f}/s",
        *([] if totals.load is None else [f"load about {100 * totals.load:.0f} %"]),
        *(f"{states[state]} {state}" for state in ("alive", "late", "lost") if states[state]),
    ]
    counts = (
        (totals.faults, "faults"),
        (len(picture.foreign), "foreign identifiers"),
        (totals.errors, "error frames"),
        (len(picture.alarms), "alarms"),
    )
    parts += [f"{count} {what}" for count, what in counts if count]
    parts += picture.look.summary()
    if status.bus_lost:
        parts.append(f"bus lost: {status.bus_lost}")
    return ", ".join(parts)


def _as_json(picture: Picture, status: Status, rows: list[MessageRow]) -> dict[str, Any]:
    names = {row.name for row in rows}
    last = {kind.NAME: seen for kind, seen in picture.last.items()}
    told = _rounded(picture.as_dict())
    # What a message said last is no measurement of ours: it keeps its digits.
    told["messages"] = [
        {**message, "last": _frame(last.get(message["name"]))}
        for message in told["messages"]
        if message["name"] in names
    ]
    recording = {"file": str(status.recording), "frames": status.recorded}
    return {
        "bus_lost": status.bus_lost or None,
        "recording": recording if status.recording else None,
        **told,
    }


def _frame(seen: Seen | None) -> dict[str, Any] | None:
    return json_object(seen.received) if seen else None


def _rounded(value: Any) -> Any:
    """The same with microseconds and the like, not more digits than were measured.

    A number that JSON has not, such as a float that is not a number, becomes null.
    """
    if isinstance(value, dict):
        return {key: _rounded(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(each) for each in value]
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    return value
