"""The protocol in another reading or edition: what a choice changes, made and applied.

Changes are kept as JSON over the JSON of `typedcan.model.serial`: a list of paths with new values.
A path names entries of lists by what identifies them, ``messages/Status/signals/Speed/factor``;
null takes a fact or an entry away, and a path that ends in ``/`` gives the order of its entries.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import Any

from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol, Variant
from typedcan.model.serial import from_plain, to_plain

_IDENTITIES = ("name", "id", "signal")
"""What entries of lists are known by, the first that all of them have."""

_ABOUT = ("chosen", "variants", "digest", "format", "made_from", "carries")
"""What is no part of the protocol itself."""

_MARKS = "errata"

Change = tuple[str, Any]


def changes_between(usual: Protocol, other: Protocol) -> str:
    """What turns one protocol into the other, as `Variant` keeps it."""
    return json.dumps(
        list(_changes("", _facts(usual), _facts(other))), ensure_ascii=False, separators=(",", ":")
    )


def changes_of(variant: Variant) -> Iterator[Change]:
    """What a choice changes: paths with their new values, None for what it takes away."""
    yield from map(tuple, json.loads(variant.changes))


def choose(protocol: Protocol, names: Iterable[str]) -> Protocol:
    """The protocol in the readings and the edition of these names.

    An edition brings its readings along; readings that are named beside it go before those. The
    number of an erratum is its usual reading. Raises `ReadError` for a name that there is not, for
    two readings of one erratum and for readings that change the same fact differently.
    """
    chosen = tuple(dict.fromkeys(names))
    if not chosen:
        return protocol
    if protocol.chosen:
        raise ReadError(f"{protocol.name} is {protocol.chosen} already: choose all at once")
    facts, usual = _facts(protocol), _facts(protocol)
    made: dict[str, tuple[str, Any]] = {}
    for each in _in_order(protocol, chosen):
        for path, value in changes_of(each):
            name, before = made.get(path, ("", value))
            new = value
            if path.rpartition("/")[2] == _MARKS:
                new = _marks(_at(facts, path), _at(usual, path), value)
            elif before != value and not path.endswith("/") and not each.is_edition:
                raise ReadError(f"{name} and {each.name} change {path} differently: choose one")
            made[path] = each.name, value
            _apply(facts, path.split("/"), new)
    numbers = [erratum.id for erratum in protocol.errata]
    facts.get(_MARKS, []).sort(key=lambda each: _place(numbers, erratum_of(protocol, each["id"])))
    facts["chosen"] = "+".join(chosen)
    other = from_plain(facts, f"{protocol.name} {facts['chosen']}")
    return replace(other, variants=protocol.variants)  # for who asks what others may speak


def variant(protocol: Protocol, name: str) -> Variant:
    """The reading or edition of that name; raises `ReadError`."""
    for each in protocol.variants:
        if each.name == name:
            return each
    known = [each.name for each in protocol.variants]
    close = get_close_matches(name, known, n=1)
    hint = f"did you mean {close[0]!r}?" if close else f"there are {', '.join(known)}"
    raise ReadError(
        f"{protocol.name} has no reading or edition {name!r}; {hint if known else 'it has none'}"
    )


def _in_order(protocol: Protocol, names: tuple[str, ...]) -> list[Variant]:
    """The readings, those of the edition among them, and then the edition itself."""
    usual = {each.id for each in protocol.errata}
    variants = [variant(protocol, name) for name in names if name not in usual]
    editions = [each for each in variants if each.is_edition]
    if len(editions) > 1:
        raise ReadError(f"{' and '.join(each.name for each in editions)}: choose one edition")
    taken: dict[str, str] = {}
    for name in names:
        number = erratum_of(protocol, name)
        if number and taken.setdefault(number, name) != name:
            raise ReadError(f"{taken[number]} and {name} are two readings of one erratum")
    of_edition = {erratum_of(protocol, name): name for each in editions for name in each.readings}
    readings = [name for name in (of_edition | taken).values() if name not in usual]
    return [*(variant(protocol, name) for name in readings), *editions]


def _marks(now: list[str], usual: list[str], then: list[str] | None) -> list[str]:
    """The errata that touch an entry, where several choices say so."""
    before, after = set(usual), set(then or [])
    return sorted((set(now) - (before - after)) | (after - before))


def _at(facts: Any, path: str) -> Any:
    """What is at a path; an empty list where nothing is."""
    for name in path.split("/"):
        if isinstance(facts, list):
            key = _identity(facts)
            facts = next((each for each in facts if key and each.get(key) == name), {})
        else:
            facts = facts.get(name, [])
    return facts or []


def _place(numbers: list[str], number: str) -> int:
    return numbers.index(number) if number in numbers else len(numbers)


def erratum_of(protocol: Protocol, name: str) -> str:
    """The number of the erratum that has a reading of that name; "" where none has."""
    for erratum in protocol.errata:
        if name == erratum.id or name in {each.id for each in erratum.alternatives}:
            return erratum.id
    return ""


def _facts(protocol: Protocol) -> dict[str, Any]:
    plain = to_plain(protocol)
    return {name: fact for name, fact in plain.items() if name not in _ABOUT}


def _identity(entries: list[Any]) -> str:
    """The fact that tells the entries apart; "" where there is none."""
    for key in _IDENTITIES:
        names = [each.get(key) for each in entries if isinstance(each, dict)]
        if len(names) == len(entries) and None not in names and len(set(names)) == len(names):
            return key
    return ""


def _by_name(value: Any, key: str) -> dict[str, Any]:
    return {each[key]: each for each in value}


def _changes(path: str, old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[Change]:
    for name in dict.fromkeys((*old, *new)):
        below = f"{path}/{name}" if path else name
        before, after = old.get(name), new.get(name)
        if before == after:
            continue
        if isinstance(before, dict) and isinstance(after, dict):
            yield from _changes(below, before, after)
        elif isinstance(before, list) and isinstance(after, list):
            yield from _list_changes(below, before, after)
        else:
            yield below, after


def _list_changes(path: str, old: list[Any], new: list[Any]) -> Iterator[Change]:
    key = _identity([*old]) if old else ""
    if not key or key != _identity([*new]):
        yield path, new
        return
    before, after = _by_name(old, key), _by_name(new, key)
    if any("/" in name for name in (*before, *after)):
        yield path, new
        return
    yield from _changes(path, before, after)
    usual = [name for name in before if name in after] + [
        each for each in after if each not in before
    ]
    if usual != list(after):
        yield f"{path}/", list(after)


def _apply(facts: dict[str, Any], path: list[str], value: Any) -> None:
    name, rest = path[0], path[1:]
    if rest == [""]:
        entries = facts[name]
        key = _identity(entries)
        places = {each: place for place, each in enumerate(value)}
        entries.sort(key=lambda entry: places.get(entry[key], len(places)))
    elif not rest:
        if value is None:
            facts.pop(name, None)
        else:
            facts[name] = value
    elif isinstance(facts.get(name), list):
        _apply_to_list(facts[name], rest, value)
    else:
        _apply(facts.setdefault(name, {}), rest, value)


def _apply_to_list(entries: list[Any], path: list[str], value: Any) -> None:
    key = _identity(entries) or _IDENTITIES[0]
    place = next((at for at, each in enumerate(entries) if each.get(key) == path[0]), None)
    if path[1:]:
        if place is not None:
            _apply(entries[place], path[1:], value)
    elif value is None:
        if place is not None:
            del entries[place]
    elif place is None:
        entries.append(value)
    else:
        entries[place] = value
