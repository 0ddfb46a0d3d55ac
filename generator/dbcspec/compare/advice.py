"""What summaries call each broken promise, and what whoever reviews it does about it."""

from __future__ import annotations

from collections.abc import Mapping

_TURN_ROUND = "change both sides together, or one does the opposite"
_BOTH = "change both sides together"
_OLD_RECEIVERS = "bring every receiver up to date first"
_OLD_SENDERS = "read the old form too until every sender is up to date"
_NODES = "tell those who build these nodes"
_PROGRAMS = "regenerate, and adapt the programs that use the old name"
_TOOLS = "see which tools go by them"
_NOTHING_TO_DO = "nothing to do on the bus"
_OLD_IGNORE = "harmless where old receivers ignore what they do not know"

_ADVICE: Mapping[str, tuple[str, str]] = {
    "code-meaning-not-reversed": ("codes mean the opposite", _TURN_ROUND),
    "code-meaning-same": ("codes mean something else", _BOTH),
    "code-no-value-same": ("invalid and abnormal codes differ", "take both forms for no value"),
    "signal-invalid-code-same": ("invalid codes differ", "take both forms for no value"),
    "signal-acts-same": ("codes that act differ", "look at what moves before anything is sent"),
    "code-present": ("codes are gone", _OLD_SENDERS),
    "signal-present": (
        "signals are gone",
        "the bits may be in use",
    ),
    "signal-bits-free": ("new signals lie on bits of others", _BOTH),
    "signal-scale-same": ("scales differ", _BOTH),
    "signal-offset-same": ("offsets differ", _BOTH),
    "signal-start-same": ("start bits differ", _BOTH),
    "signal-length-same": ("lengths of signals differ", _BOTH),
    "signal-byte-order-same": ("byte orders differ", _BOTH),
    "signal-sign-same": ("signs differ", _BOTH),
    "signal-float-same": ("whole numbers against floats", _BOTH),
    "signal-multiplexing-same": ("multiplexing differs", _BOTH),
    "message-present": ("messages are gone", "make sure that nobody waits for them"),
    "message-identifier-same": ("identifiers differ", _BOTH),
    "message-extended-same": ("11 against 29 bits", _BOTH),
    "message-frame-format-same": ("classic CAN against CAN FD", _BOTH),
    "frame-format-same": ("formats of frames differ", _BOTH),
    "message-length-same": ("lengths of messages differ", _BOTH),
    "message-sender-same": ("senders differ", _NODES),
    "message-period-same": ("periods differ", "look at the timeouts of the receivers"),
    "message-send-type-same": ("send types differ", "look at the timeouts of the receivers"),
    "message-checksum-same": ("checksums differ", _BOTH),
    "message-counter-same": ("counters differ", _BOTH),
    "transfer-layout-same": ("transfers differ", _BOTH),
    "request-same": ("requests differ", _BOTH),
    "node-present": ("nodes are gone", _NODES),
    "node-address-same": ("addresses differ", _NODES),
    "bus-present": ("buses are gone", _NODES),
    "bus-bit-rate-same": ("bit rates differ", "nodes of both kinds disturb each other on one bus"),
    "bus-nodes-same": ("nodes on a bus differ", _NODES),
    "signal-unit-same": ("units differ", "see whether it is another spelling or another quantity"),
    "signal-range-not-narrowed": ("ranges are narrower", _OLD_SENDERS),
    "signal-receivers-same": ("receivers differ", _NODES),
    "signal-start-value-same": ("start values differ", "see what is sent before values are known"),
    "signal-group-same": ("signal groups differ", _TOOLS),
    "attribute-same": ("attributes of other tools differ", _TOOLS),
    "environment-variable-same": ("environment variables differ", _TOOLS),
    "attribute-definition-same": ("definitions of attributes differ", _NOTHING_TO_DO),
    "message-added": ("messages are new", _OLD_IGNORE),
    "signal-added": ("signals are new", _OLD_IGNORE),
    "signal-range-not-widened": ("ranges are wider", _OLD_RECEIVERS),
    "code-added": ("codes are new", _OLD_RECEIVERS),
    "node-added": ("nodes are new", _NODES),
    "bus-added": ("buses are new", _NODES),
}

_NAMES: Mapping[str, str] = {
    "message-name-same": "messages are called otherwise",
    "signal-name-same": "signals are called otherwise",
    "node-name-same": "nodes are called otherwise",
    "bus-name-same": "buses are called otherwise",
    "reserved-signal-present": "reserved fields are gone",
}


def advice_on(promise: str) -> tuple[str, str]:
    """Heading and advice of a broken promise; names and texts share theirs."""
    if promise in _ADVICE:
        return _ADVICE[promise]
    if promise in _NAMES:
        return _NAMES[promise], _PROGRAMS
    words = promise.removesuffix("-same").removesuffix("-present").replace("-", " ")
    texts = promise in ("comment-same", "reference-same", "erratum-same", "code-label-same")
    last = _NOTHING_TO_DO if texts or promise == "order-same" else _PROGRAMS
    return f"{words}: changed", last
