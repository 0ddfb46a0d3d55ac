"""Requests to other nodes: asked until they are answered, in time, and then withdrawn."""

from __future__ import annotations

import asyncio
import dataclasses
import math
import threading
from collections.abc import Callable, Generator
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from typing import Any, Generic, TypeVar

from typedcan.node.answers import Collector
from typedcan.node.errors import RequestError, RequestTimeoutError
from typedcan.wire.link import Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Request

T = TypeVar("T")


class Pending(Generic[T]):
    """The answer to a request that is under way: ``await`` it, or wait for its `result`."""

    def __init__(self, future: Future[T]) -> None:
        self._future = future

    def __await__(self) -> Generator[Any, None, T]:
        return asyncio.wrap_future(self._future).__await__()

    def result(self, timeout: float | None = None) -> T:
        """Wait for the answer.

        Raises `RequestTimeoutError` where it does not come in the time that the request has,
        `TimeoutError` where it is not there after ``timeout`` seconds, and
        `concurrent.futures.CancelledError`.
        """
        return self._future.result(timeout)

    def done(self) -> bool:
        """Whether the request has ended, be it with an answer or without."""
        return self._future.done()

    def cancel(self) -> bool:
        """Withdraw the request; False where it has ended."""
        return self._future.cancel()


class RequestHearer:
    """Hears what another node asks for, and asks for it no more."""

    def __init__(
        self,
        request: Request,
        ask: Callable[[type[Message]], object],
        withdraw: Callable[[type[Message]], object],
    ) -> None:
        self._request = request
        self._ask = ask
        self._withdraw = withdraw

    def __call__(self, received: Received[Message], now: float) -> None:  # noqa: ARG002 - a Hearer
        """Take the message with the request."""
        code = getattr(received.message, self._request.field.field)
        for answer in self._request.answers:
            if code == self._request.code:
                self._ask(answer)
            elif code == self._request.withdraw:
                self._withdraw(answer)


@dataclasses.dataclass(slots=True)
class _Conversation:
    """A request under way."""

    name: str
    request: Request
    collector: Collector[Any]
    future: Future[Any]
    timeout: float
    again: float
    deadline: float
    ask_at: float


class Requests:
    """The requests of one node that are under way.

    Parameters
    ----------
    protocol
        All its requests: a message that asks for one thing says of the others that it does not.
    say
        Sends a message once.
    last
        The message of a kind that the node sent last: its other fields stay as they are.
    """

    def __init__(
        self,
        protocol: Protocol,
        say: Callable[[Message], None],
        last: Callable[[type[Message]], Message | None],
    ) -> None:
        self._say = say
        self._last = last
        self._requests = protocol.requests
        self._under_way: dict[str, _Conversation] = {}
        self._lock = threading.RLock()

    @property
    def next_check(self) -> float:
        """When time alone changes something; `math.inf` for never."""
        if not self._under_way:
            return math.inf
        with self._lock:
            times = (min(each.deadline, each.ask_at) for each in self._under_way.values())
            return min(times, default=math.inf)

    def begin(
        self,
        name: str,
        request: Request,
        collector: Collector[T],
        *,
        timeout: float,
        again: float,
        now: float,
    ) -> Pending[T]:
        """Ask, and go on asking every ``again`` seconds, for ``timeout`` seconds.

        Raises `RequestError` where the same request is under way.
        """
        future: Future[T] = Future()
        conversation = _Conversation(
            name, request, collector, future, timeout, again, now + timeout, now + again
        )
        with self._lock:
            if name in self._under_way:
                raise RequestError(f"{name}: the same request is under way")
            self._under_way[name] = conversation
            self._put(request, request.code)
        future.add_done_callback(lambda _: self._withdraw(conversation))
        return Pending(future)

    def hear(self, received: Received[Message], now: float) -> None:
        """Take a message that may be an answer."""
        if not self._under_way:
            return
        message = received.message
        with self._lock:
            asking = [
                each for each in self._under_way.values() if type(message) in each.request.answers
            ]
            for each in asking:
                answer = each.collector.take(message, now)
                if answer is not None:
                    with suppress(InvalidStateError):  # cancelled at this moment
                        each.future.set_result(answer)

    def check(self, now: float) -> None:
        """Ask again where it is time to, and give up what has taken too long."""
        with self._lock:
            for each in tuple(self._under_way.values()):
                if now >= each.deadline:
                    missing = each.collector.missing()
                    self._fail(each, RequestTimeoutError(each.name, each.timeout, missing))
                elif now >= each.ask_at:
                    each.ask_at = now + each.again
                    self._put(each.request, each.request.code)

    def stop(self) -> None:
        """Withdraw all."""
        with self._lock:
            for each in tuple(self._under_way.values()):
                self._fail(each, RequestError(f"{each.name}: the node was stopped"))

    def _fail(self, conversation: _Conversation, error: RequestError) -> None:
        with suppress(InvalidStateError):
            conversation.future.set_exception(error)

    def _withdraw(self, conversation: _Conversation) -> None:
        with self._lock:
            del self._under_way[conversation.name]
            if conversation.request.withdraw is not None:
                self._put(conversation.request, conversation.request.withdraw)

    def _put(self, request: Request, code: int) -> None:
        """Send the message of a request with this code, and all else as it was last."""
        kind, field = request.field
        message = self._last(kind) or self._asking_nothing(kind)
        fields: dict[str, Any] = {field: code}
        self._say(dataclasses.replace(message, **fields))  # type: ignore[type-var]

    def _asking_nothing(self, kind: type[Message]) -> Message:
        fields = {
            request.field.field: request.withdraw
            for request in self._requests
            if request.field.message is kind and request.withdraw is not None
        }
        return kind(**fields)
