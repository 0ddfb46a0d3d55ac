"""Rule tables-agree: what two rows of the tables print of one signal is the same."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from dbcspec.lint.places import node_names
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.spec.rows import SignalRow, Spec

_KEYS = ("title", "length", "codes", "factor", "offset", "unit", "range", "route")


def _check(subject: Subject) -> Iterator[Found]:
    if subject.spec is None:
        return
    said = _sayings(subject.spec)
    first: dict[str, SignalRow] = {}
    for _, row in subject.spec.rows():
        other = first.setdefault(row.signal, row)
        if other is row or not row.name:
            continue
        here, there = said(row), said(other)
        for key in _KEYS:
            if here[key] != there[key]:
                text = (
                    f"{row.name}: {_difference(key, here[key], there[key])} at "
                    f"{other.where_is(key)}: correct one by an erratum"
                )
                yield Found(row.where_is(key), row.name, text)


def _sayings(spec: Spec) -> Callable[[SignalRow], dict[str, object]]:
    """What a row says, key by key, in one form for all spellings of the same."""
    nodes, units = node_names(spec), spec.standard.units

    def said(row: SignalRow) -> dict[str, object]:
        sender, receivers = row.route or ("", ())
        heard_by = sorted(nodes.get(name, name) for name in receivers)
        return {
            "title": "".join(row.title.split()),
            "length": row.length,
            "codes": dict(row.labels),
            "factor": row.factor,
            "offset": row.offset,
            "unit": units.get(row.unit, row.unit) if row.unit is not None else None,
            "range": row.range,
            "route": f"{nodes.get(sender, sender)}>{','.join(heard_by)}" if row.route else None,
        }

    return said


def _difference(key: str, here: object, there: object) -> str:
    if isinstance(here, Mapping) and isinstance(there, Mapping):
        code = min(code for code in {*here, *there} if here.get(code) != there.get(code))
        return f"code {code} is {_shown(here.get(code))}, but {_shown(there.get(code))}"
    return f"{key} is {_shown(here)}, but {_shown(there)}"


def _shown(value: object) -> str:
    if value is None:
        return "not given"
    if isinstance(value, tuple):
        return "~".join(map(str, value))
    return repr(value) if isinstance(value, str) else str(value)


RULE = Rule("tables-agree", "two rows of the tables say the same of one signal", _check)
