"""Rows as printed to rows as read: applies each erratum, and refuses one that does nothing.

Paths: ``tables/07-status/4`` (a row by its number), ``messages/ECU1_Status/Speed``
(a field of the annex), ``messages/ECU1_Status/Reserved@12`` (the one of several that starts there),
``standard/nodes/ECU1``, ``behaviour/checksums/CRC8``, ``tables``.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from dbcspec.errors import Fault, SpecError
from dbcspec.spec.errata_rows import ChangeRow
from dbcspec.spec.readings import ReadErratum, usual_readings
from dbcspec.spec.rows import SameCodes, SignalRow, Spec
from dbcspec.spec.schema import Record, expect_table, expect_text, keys_of
from dbcspec.spec.source import Items

Edit = Callable[[Any], Any]


class _RefusedError(Exception):
    """The change cannot be made; the text says why."""


def apply_errata(
    spec: Spec, errata: Iterable[ReadErratum] | None = None
) -> tuple[Spec, tuple[Fault, ...]]:
    """Apply errata in order: those of the spec as it reads them, or others.

    Returns the corrected rows and a fault for each change that names nothing that exists or
    changes nothing; such a change is left out.
    """
    faults: list[Fault] = []
    seen: set[str] = set()
    for erratum in usual_readings(spec) if errata is None else errata:
        if erratum.id in seen:
            faults.append(Fault(erratum.where, f"erratum {erratum.id} stands here twice"))
        seen.add(erratum.id)
        if not all(change.at for change in erratum.change) or not erratum.change:
            text = f"erratum {erratum.id}: names nothing to change"
            faults.append(Fault(erratum.change_where, text))
        for change in erratum.change:
            for path in change.at:
                try:
                    spec = _edit_at(spec, path.split("/"), _edit_for(erratum.id, change))
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
        index = _place(value, name)
        return (*value[:index], _edit_at(value[index], rest, edit), *value[index + 1 :])
    raise _RefusedError(f"nothing below it is named {name!r}")


def _place(items: tuple[Any, ...], name: str) -> int:
    """The index of the one entry of that name, or of that name and start bit: ``Reserved@12``."""
    name, _, start = name.partition("@")
    places = [
        index
        for index, item in enumerate(items)
        if isinstance(item, Record)
        and item.identity == name
        and (not start or str(getattr(item, "start", "")) == start)
    ]
    if len(places) != 1:
        count = "nothing" if not places else f"{len(places)} entries"
        raise _RefusedError(f"{count} named {name!r}{f' at bit {start}' if start else ''}")
    return places[0]


_STEPS = ("set", "add", "remove", "relabel", "keep")


def _edit_for(erratum: str, change: ChangeRow) -> Edit:
    given = [name for name in _STEPS if getattr(change, name) not in (None, {}, ())]
    if len(given) != 1:
        raise _RefusedError(f"give exactly one of {', '.join(_STEPS)}")
    if given == ["set"]:
        return lambda value: _set(value, erratum, change)
    if given == ["add"]:
        return lambda value: _add(value, erratum, change)
    if given == ["remove"]:
        return lambda value: _remove(value, erratum, change)
    if given == ["keep"]:
        return lambda value: _keep(value, erratum, change)
    return lambda value: _relabel(value, erratum, change.relabel)


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
        if new == getattr(record, name.text) and name.text in record.places:
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


def _remove(value: Any, erratum: str, change: ChangeRow) -> Record:
    """Take entries out of lists of the entry at the path: ``remove: {signals: [Speed]}``."""
    record = _record(value)
    values: dict[str, Any] = {}
    entries = expect_table(change.remove).entries
    if not entries:
        raise _RefusedError("remove gives no list: nothing changes")
    for key, node in entries:
        left = getattr(record, key.text, None)
        if key.text not in keys_of(type(record)) or not isinstance(left, tuple):
            raise _RefusedError(f"{key.text!r} is not a list")
        names = node.nodes if isinstance(node, Items) else (node,)
        for name in map(expect_text, names):
            index = _place(left, name)
            left = (*left[:index], *left[index + 1 :])
        values[key.text] = left
    return _marked(record, erratum, **values)


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
