"""The signals that a person means."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase

from typedcan.logs.plan import SelectionError
from typedcan.logs.protocol import Protocol

SignalName = tuple[str, str]
"""Names of message and signal."""

_SHOWN = 5


def find_signals(protocol: Protocol, names: Iterable[str]) -> list[SignalName]:
    """Find signals, in the order in which they are asked for, each once.

    Parameters
    ----------
    names
        Each the name of the database (``Pack_SOC``), with its message before a dot where it is
        wanted, or its end where only one signal ends so (``SOC``), in upper or lower case and with
        or without its underscores; or a pattern of these with ``*``, ``?`` and ``[...]``.

    Raises
    ------
    SelectionError
        There is none of that name, or several signals end so.
    """
    known = [
        (message.name, signal.name) for message in protocol.messages for signal in message.signals
    ]
    found: dict[SignalName, None] = {}
    for name in names:
        found.update(dict.fromkeys(_matching(name, known)))
    return list(found)


def _matching(name: str, known: list[SignalName]) -> list[SignalName]:
    if re.search(r"[*?\[]", name):
        pattern = name.casefold()
        found = [pair for pair in known if any(fnmatchcase(w, pattern) for w in _wholes(pair))]
    else:
        found = [pair for pair in known if name.casefold() in _wholes(pair)]
        if not found:
            found = [pair for pair in known if _plain(name) in _ends(pair[1])]
            if len(found) > 1:
                meant = ", ".join(signal for _, signal in found[:_SHOWN])
                more = ", ..." if len(found) > _SHOWN else ""
                raise SelectionError(
                    f"{len(found)} signals end in {name!r} ({meant}{more}): "
                    f"name one, or ask for '*{name}'"
                )
    if not found:
        raise SelectionError(f"there is no signal {name!r}{_close(name, known)}")
    return found


def _wholes(pair: SignalName) -> tuple[str, str]:
    return pair[1].casefold(), ".".join(pair).casefold()


def _ends(signal: str) -> Iterator[str]:
    parts = signal.split("_")
    return (_plain("".join(parts[first:])) for first in range(len(parts)))


def _plain(name: str) -> str:
    return name.replace("_", "").casefold()


def _close(name: str, known: list[SignalName]) -> str:
    """The names that it may have been meant to be."""
    spelt: dict[str, str] = {}
    for _, signal in known:
        for end in _ends(signal):
            spelt.setdefault(end, signal)
    close = difflib.get_close_matches(_plain(name.strip("*")), spelt, n=3)
    meant = list(dict.fromkeys(spelt[each] for each in close))
    return f"; did you mean {' or '.join(meant)}?" if meant else ""
