"""Which messages and signals a person asks for by name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from typedcan.logs.plan import SelectionError
from typedcan.logs.protocol import Protocol

Selection = Mapping[str, tuple[str, ...] | None]
"""Names of messages, and of their signals or None for all."""


def select(
    protocol: Protocol, messages: Iterable[str] = (), signals: Iterable[str] = ()
) -> Selection:
    """Find messages and signals by their names.

    Parameters
    ----------
    messages
        Names of messages; none: all.
    signals
        Names of signals to look for in those messages; none: all. A name is that of the database
        (``Pack_SOC``), with its message (``Status.Pack_SOC``), or its end (``SOC``, for
        every signal whose name ends so), in upper or lower case.

    Raises
    ------
    SelectionError
        There is none of that name.
    """
    known = {message.name: message for message in protocol.messages}
    wanted = list(dict.fromkeys(messages)) or list(known)
    for name in wanted:
        if name not in known:
            raise SelectionError(f"there is no message {name!r}; known: {', '.join(known)}")
    names = {name: [signal.name for signal in known[name].signals] for name in wanted}
    asked = list(signals)
    if not asked:
        return dict.fromkeys(wanted)
    found: dict[str, set[str]] = {}
    for text in asked:
        for message, signal in _matching(text, names):
            found.setdefault(message, set()).add(signal)
    return {
        message: tuple(name for name in names[message] if name in found[message])
        for message in names
        if message in found
    }


def _matching(text: str, names: Mapping[str, list[str]]) -> list[tuple[str, str]]:
    """The signals that a text means: those named so, else those whose name ends so."""
    pairs = [(message, signal) for message, signals in names.items() for signal in signals]
    exact = [pair for pair in pairs if text in (pair[1], ".".join(pair))]
    ending = f"_{text}".lower()
    found = exact or [pair for pair in pairs if f"_{pair[1]}".lower().endswith(ending)]
    if not found:
        where = "" if len(names) > 1 else f" in {next(iter(names), '')}"
        raise SelectionError(f"there is no signal {text!r}{where}")
    return found
