"""Definitions of attributes of other tools stay, and so do the words of the version."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from typedcan.model.extras import AttributeDefinition
from typedcan.model.protocol import Aspect, Protocol


def _check(pairing: Pairing) -> Iterator[Change]:
    if pairing.old.version != pairing.new.version:
        yield protocol_change("version", "version", pairing.old.version, pairing.new.version)
    old, new = _definitions(pairing.old), _definitions(pairing.new)
    for key in dict.fromkeys([*old, *new]):
        was, now = _text(old.get(key)), _text(new.get(key))
        if was != now:
            of, name = key
            yield protocol_change(name, f"attribute {of} {name}".replace("  ", " "), was, now)


def _definitions(protocol: Protocol) -> dict[tuple[str, str], AttributeDefinition]:
    return {(each.of, each.name): each for each in protocol.definitions}


def _text(definition: AttributeDefinition | None) -> str:
    if definition is None:
        return ""
    default = definition.default
    return definition.type if default is None else f'{definition.type}, else "{default}"'


PROMISE = Promise(
    "attribute-definition-same",
    "Attributes of other tools are defined the same, in a file of the same version.",
    Class.COSMETIC,
    Breaks.NOBODY,
    _check,
    needs=Aspect.ATTRIBUTES,
)
