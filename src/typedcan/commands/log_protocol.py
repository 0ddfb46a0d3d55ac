"""The protocol of a command for whole logs, which needs the extra ``logs``."""

from __future__ import annotations

import argparse

from typedcan.commands.tool import Tool, dbc_of
from typedcan.logs.database import protocol_of
from typedcan.logs.protocol import Protocol, known


def log_protocol(tool: Tool, options: argparse.Namespace) -> Protocol:
    """The protocol that the options choose; see `Tool.protocol`."""
    own = tool.own_protocol(options)
    return protocol_of(dbc_of(options), known(own.model) if own else None)
