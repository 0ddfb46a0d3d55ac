"""Messages of which only what has to be given is given."""

from __future__ import annotations

import inspect
from typing import Any, TypeVar

from swapcan import Message

MessageT = TypeVar("MessageT", bound=Message)


def needed_by(kind: type[Message]) -> dict[str, Any]:
    """The fields of a message that have to be given, with their safe codes."""
    parameters = inspect.signature(kind).parameters
    return {
        name: part.acting.safe
        for name, part in kind.FIELDS.items()
        if part.acting and parameters[name].default is inspect.Parameter.empty
    }


def default_of(kind: type[MessageT], **values: Any) -> MessageT:
    """A message with these values, the rest as it is where it is not given, or safe."""
    return kind(**{**needed_by(kind), **values})
