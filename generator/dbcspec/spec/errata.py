"""Rows as printed to rows as read: applies each erratum, and refuses one that does nothing.

Paths: ``tables/07-status/4`` (a row by its number), ``messages/ECU1_Status/Speed``
(a field of the annex), ``standard/nodes/ECU1``, ``behaviour/checksums/CRC8``, ``tables``.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

from dbcspec.errors import Fault, SpecError
from dbcspec.spec.rows import ChangeRow, ErratumRow, SameCodes, SignalRow, Spec
from dbcspec.spec.schema import Record, expect_table, keys_of
from dbcspec.spec.source import Items

Edit = Callable[[Any], Any]


class _RefusedError(Exception):
    """The change cannot be made; the text says why."""


def apply_errata(spec: Spec) -> tuple[Spec, tuple[Fault, ...]]:
    """Apply all errata in order.

    Returns the corrected rows and a fault for each change that names nothing that exists or
    changes nothing; such a change is left out.
    """
    faults: list[Fault] = []
    seen: set[str] = set()
    for erratum in spec.errata:
        if erratum.id in seen:
            faults.append(Fault(erratum.where_is("id"), f"erratum {erratum.id} stands here twice"))
        seen.add(erratum.id)
        if not all(change.at for change in erratum.change) or not erratum.change:
            text = f"erratum {erratum.id}: names nothing to change"
            faults.append(Fault(erratum.where_is("change"), text))
        for change in erratum.change:
            for path in change.at:
                try:
                    spec = _edit_at(spec, path.split("/"), _edit_for(erratum, change))
                except _RefusedError as refused:
                    text = f"erratum {erratum.id}, {path}: {refused}"
                    faults.append(Fault(change.where_is("at"), text))
                except SpecError as error:
                    faults.extend(error.faults)
    return spec, tuple(faults)


def _edit_at(value: Any, path: list[str], edit: Edit) -> Any:
    """A copy of the frozen tree with the part at the path edited."""
    if not path:
        return edit(value)
    name, rest = path[0], path[1:]
    if isinstance(value, Spec):
        if name not in ("standard", "messages", "tables", "behaviour"):
            raise _RefusedError("a path begins with standard, messages, tables or behaviour")
        return dataclasses.replace(value, **{name: _edit_at(getattr(value, name), rest, edit)})
    if isinstance(value, Record):
        if name not in keys_of(type(value)) and value.MAIN:
            name, rest = value.MAIN, path
        if name not in keys_of(type(value)):
            raise _RefusedError(f"there is no {name!r} in {type(value).__name__}")
        return dataclasses.replace(value, **{name: _edit_at(getattr(value, name), rest, edit)})
    if isinstance(value, tuple):
        places = [
            index
            for index, item in enumerate(value)
            if isinstance(item, Record) and item.identity == name
        ]
        if len(places) != 1:
            count = "nothing" if not places else f"{len(places)} entries"
            raise _RefusedError(f"{count} named {name!r}")
        index = places[0]
        return (*value[:index], _edit_at(value[index], rest, edit), *value[index + 1 :])
    raise _RefusedError(f"nothing below it is named {name!r}")


def _edit_for(erratum: ErratumRow, change: ChangeRow) -> Edit:
    given = [
        name
        for name in ("set", "add", "relabel", "keep")
        if getattr(change, name) not in (None, {}, ())
    ]
    if len(given) != 1:
        raise _RefusedError("give exactly one of set, add, relabel, keep")
    if given == ["set"]:
        return lambda value: _set(value, erratum.id, change)
    if given == ["add"]:
        return lambda value: _add(value, erratum.id, change)
    if given == ["keep"]:
        return lambda value: _keep(value, erratum.id, change)
    return lambda value: _relabel(value, erratum.id, change.relabel)


def _marked(record: Record, erratum: str, **values: Any) -> Record:
    numbers = record.marks if erratum in record.marks else (*record.marks, erratum)
    return dataclasses.replace(record, marks=numbers, **values)


def _record(value: Any) -> Record:
    if not isinstance(value, Record):
        raise _RefusedError("the path does not lead to an entry with keys")
    return value


def _set(value: Any, erratum: str, change: ChangeRow) -> Record:
    record = _record(value)
    keys = keys_of(type(record))
    values: dict[str, Any] = {}
    places = dict(record.places)
    entries = expect_table(change.set).entries
    if not entries:
        raise _RefusedError("set gives no key: nothing changes")
    for name, node in entries:
        if name.text not in keys:
            raise _RefusedError(f"unknown key {name.text!r}")
        new = keys[name.text].kind.read(node)
        if isinstance(new, SameCodes):
            raise _RefusedError("same_as is for tables: give the codes")
        if new == getattr(record, name.text):
            raise _RefusedError(f"{name.text} is {node_text(new)} already: nothing changes")
        values[name.text] = new
        places[name.text] = node.where
    return _marked(record, erratum, places=places, **values)


def _add(value: Any, erratum: str, change: ChangeRow) -> Record:
    """Append to lists of the entry at the path: ``add: {counters: {signal: …}}``."""
    record = _record(value)
    keys = keys_of(type(record))
    values: dict[str, Any] = {}
    marked = False
    entries = expect_table(change.add).entries
    if not entries:
        raise _RefusedError("add gives no list: nothing changes")
    for name, node in entries:
        if name.text not in keys or not isinstance(getattr(record, name.text), tuple):
            raise _RefusedError(f"{name.text!r} is not a list")
        items = node.nodes if isinstance(node, Items) else (node,)
        new = keys[name.text].kind.read(Items(node.where, items))
        present = getattr(record, name.text)
        if not new or any(item in present for item in new):
            raise _RefusedError(f"{name.text} has that already: nothing changes")
        marked = marked or any(not isinstance(item, Record) for item in new)
        values[name.text] = present + tuple(
            _marked(item, erratum) if isinstance(item, Record) else item for item in new
        )
    return _marked(record, erratum, **values) if marked else dataclasses.replace(record, **values)


def _keep(value: Any, erratum: str, change: ChangeRow) -> Record:
    record = _record(value)
    for name in change.keep:
        if name not in record.places:
            raise _RefusedError(f"nothing is printed for {name!r}, so there is nothing to keep")
    return _marked(record, erratum)


def _relabel(value: Any, erratum: str, labels: Mapping[str, str]) -> Any:
    """Spell labels differently in every code cell at or below the path."""
    found: set[str] = set()
    if same := [label for label, new in labels.items() if label == new]:
        raise _RefusedError(f"{same[0]!r} is that already: nothing changes")

    def walk(part: Any) -> Any:
        if isinstance(part, tuple):
            return tuple(map(walk, part))
        if isinstance(part, SignalRow):
            hits = set(part.labels.values()) & set(labels)
            found.update(hits)
            if not hits:
                return part
            codes = {code: labels.get(label, label) for code, label in part.labels.items()}
            return _marked(part, erratum, codes=codes)
        if isinstance(part, Record) and part.MAIN:
            return dataclasses.replace(part, **{part.MAIN: walk(getattr(part, part.MAIN))})
        return part

    result = walk(value)
    if missing := [label for label in labels if label not in found]:
        raise _RefusedError(f"no code is labelled {missing[0]!r} there")
    return result


def node_text(value: object) -> str:
    """A value as a person would write it in the spec."""
    if isinstance(value, tuple):
        return "~".join(map(str, value))
    return repr(value) if isinstance(value, str) else str(value)
