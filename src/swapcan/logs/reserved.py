"""The reserved codes of this package's own protocol, as the decoder takes them."""

from __future__ import annotations

from swapcan.logs.columns import State
from swapcan.logs.plan import Reserved
from swapcan.messages import MESSAGES
from typedcan.wire.message import SignalState

_STATES = {SignalState.INVALID: State.INVALID, SignalState.ABNORMAL: State.ABNORMAL}


def reserved_codes() -> Reserved:
    """By names of message and signal, the raw codes that are no value."""
    return {
        (message.NAME, part.dbc_name): {code: _STATES[state] for code, state in part.states.items()}
        for message in MESSAGES
        for part in message.FIELDS.values()
        if part.states
    }
