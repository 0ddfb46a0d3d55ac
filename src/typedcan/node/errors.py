"""The errors of a live node: requests without an answer, and commands that could not be ended."""

from __future__ import annotations

from collections.abc import Sequence

from typedcan.model.errors import TypedcanError

LIVE = "TAKE IT FOR LIVE, switch it off by other means"
"""What people are told where it is not known that all is off."""


class StillActingError(TypedcanError):
    """What was commanded could not be ended: ``messages`` are those that act, ``cause`` says why.

    Whoever receives them goes on until its own timeout.
    """

    def __init__(self, messages: Sequence[str], cause: str) -> None:
        self.messages = tuple(messages)
        self.cause = cause
        names = ", ".join(messages)
        super().__init__(f"the safe codes of {names} could not be sent ({cause}): {LIVE}")


class RequestError(TypedcanError):
    """A request cannot be made: this node has no signal for it, or it is already under way."""


class RequestTimeoutError(RequestError, TimeoutError):
    """A request was not answered in full within ``timeout`` seconds; ``missing`` says in what."""

    def __init__(self, request: str, timeout: float, missing: str) -> None:
        self.request = request
        self.timeout = timeout
        self.missing = missing
        super().__init__(f"{request}: not answered within {timeout:g} s; {missing}")
