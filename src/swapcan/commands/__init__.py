"""The commands, one file each, imported when it is chosen: what each takes, and what it does."""

from __future__ import annotations

from collections.abc import Mapping

HELP: Mapping[str, str] = {
    "demo": "let a pack and a truck talk on a virtual bus and show what was received",
    "decode": "print the messages in a log file",
    "convert": "write log files as tables: Parquet, Arrow, CSV or MF4",
    "plot": "draw signals of a log file over time",
    "conform": "judge whether logs, or nodes on a bus, keep to the standard",
    "send": "send one message; what is not given goes out as invalid, or 0 if that is idle",
    "listen": "print the messages on a bus as they arrive, until Ctrl-C",
    "monitor": "watch a bus in the terminal: messages, signals, and the pack at a glance",
    "readings": "how the standard is read where it is open, and the editions to choose from",
    "simulate": "be nodes of the protocol on a bus: a truck, a pack, a charger that behave",
}
"""What each command does, in a line, in the order of the help."""
