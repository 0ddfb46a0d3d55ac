"""Environment variables of a simulation stay what they are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from typedcan.model.extras import EnvironmentVariable
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    old = {each.name: each for each in pairing.old.variables}
    new = {each.name: each for each in pairing.new.variables}
    for name in dict.fromkeys([*old, *new]):
        was, now = _parts(old.get(name)), _parts(new.get(name))
        if was.keys() != now.keys():
            there = ("environment variable", "") if was else ("", "environment variable")
            yield protocol_change(name, "variable", *there)
            continue
        for part in was:
            if was[part] != now[part]:
                yield protocol_change(name, f"{part} of environment variable", was[part], now[part])


def _parts(variable: EnvironmentVariable | None) -> dict[str, str]:
    """What it says, by the words for it."""
    if variable is None:
        return {}
    return {each.name: _text(getattr(variable, each.name)) for each in fields(variable)}


def _text(value: object) -> str:
    if isinstance(value, tuple):
        return "; ".join(_text(each) for each in value)
    return "" if value is None else f"{value}"


PROMISE = Promise(
    "environment-variable-same",
    "Variables of a simulation are there and are the same.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
    needs=Aspect.ATTRIBUTES,
)
