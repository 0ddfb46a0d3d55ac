"""A request keeps its codes and its answers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, listed, protocol_change
from typedcan.model.protocol import Aspect, Request


def _check(pairing: Pairing) -> Iterator[Change]:
    names = pairing.names
    old = {
        (names.get(request.signal, request.signal), request.code): request
        for request in pairing.old.requests
    }
    new = {(request.signal, request.code): request for request in pairing.new.requests}
    for key in dict.fromkeys((*old, *new)):
        before, after = old.get(key), new.get(key)
        if _meaning(before, names) != _meaning(after, {}) and not _follows(pairing, before, after):
            yield protocol_change(key[0], f"request by code {key[1]}", _text(before), _text(after))


def _meaning(request: Request | None, names: Mapping[str, str]) -> object:
    if request is None:
        return None
    return request.withdraw, {names.get(answer, answer) for answer in request.answers}


def _follows(pairing: Pairing, old: Request | None, new: Request | None) -> bool:
    """Whether the asking signal itself is gone or new, which other promises tell."""
    if old is None:
        return new is not None and new.signal in pairing.fresh
    return new is None and old.signal in pairing.gone


def _text(request: Request | None) -> str:
    if request is None:
        return ""
    withdraw = "" if request.withdraw is None else f", withdrawn by {request.withdraw}"
    return f"for {listed(request.answers)}{withdraw}"


PROMISE = Promise(
    "request-same",
    "A code that asks for messages asks for the same ones, and is withdrawn alike.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=Aspect.TRANSFERS,
)
