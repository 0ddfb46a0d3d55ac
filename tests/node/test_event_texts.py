"""What the events and errors of nodes say to people, in one line each."""

from __future__ import annotations

import dataclasses

import pytest
from node.rough_bus import ERRORS, MuteError

from swapcan import NodeFailed, ReceiveFailed, SendFailed, StillActingError
from swapcan.messages import V2B_CMD
from typedcan.model.errors import TypedcanError, one_line


def test_events_have_facts_and_a_line() -> None:
    events: dict[str, SendFailed | ReceiveFailed | NodeFailed] = {
        "V2B_CMD: not sent: KeyError: 'type'": SendFailed(V2B_CMD, "KeyError: 'type'", 1.5),
        "frame 0x1802F3D0 not handled: no": ReceiveFailed(V2B_CMD.FRAME_ID, "no", 1.5),
        "the node cannot go on and sends nothing more: SystemExit: 3": NodeFailed(
            "SystemExit: 3", 1.5
        ),
    }
    for text, event in events.items():
        assert str(event) == text
        assert event.at == 1.5
        assert dataclasses.replace(event, at=1.5) == event
        assert repr(event).startswith(f"{type(event).__name__}(")


def test_what_is_live_is_named_with_the_reason_and_what_to_do() -> None:
    error = StillActingError(["V2B_CMD", "B2C_Charger"], "Network is down")
    assert isinstance(error, TypedcanError)
    assert error.messages == ("V2B_CMD", "B2C_Charger")
    assert error.cause == "Network is down"
    assert str(error) == (
        "the safe codes of V2B_CMD, B2C_Charger could not be sent (Network is down):"
        " TAKE IT FOR LIVE, switch it off by other means"
    )


@pytest.mark.parametrize("make", ERRORS.values(), ids=ERRORS)
def test_every_error_has_one_line(make: type[Exception]) -> None:
    error = make()
    error.__cause__ = MuteError()
    text = one_line(error)
    assert "\n" not in text
    assert text.strip()
    assert len(text) < 120


def test_an_error_that_says_too_little_alone_says_what_it_is() -> None:
    assert one_line(IndexError("list index out of range")) == "IndexError: list index out of range"
    assert one_line(OSError(100, "Network is down")) == "[Errno 100] Network is down"
    assert one_line(MuteError()) == "MuteError"
    wrapped = RuntimeError("failed\n  twice")
    wrapped.__cause__ = OSError("Network is down")
    assert one_line(wrapped) == "RuntimeError: failed twice: Network is down"
