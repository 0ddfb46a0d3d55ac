"""Which readings and which edition a run takes: the errata in force, in order.

A choice is written ``v4.6``, ``E50b`` or ``v4.6+E50b``; the number of an erratum alone chooses its
usual reading, where an edition takes another one.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches

from dbcspec.spec.errata_rows import AlternativeRow, ChangeRow, ErratumRow
from dbcspec.spec.rows import Edition, Spec
from typedcan.model.errors import Location, ReadError


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadErratum:
    """An erratum in the reading that is in force; ``id`` is that of the reading."""

    id: str
    row: ErratumRow
    reading: str
    because: str
    source: str
    change: tuple[ChangeRow, ...]
    where: Location
    change_where: Location


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """An edition, "" for the standard, and the ids of readings."""

    edition: str = ""
    readings: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "+".join(filter(None, (self.edition, *self.readings)))


USUAL = Choice()
"""The standard, in the readings that the spec takes by itself."""


def usual_readings(spec: Spec) -> tuple[ReadErratum, ...]:
    """The errata of the standard as the spec reads them."""
    return tuple(map(_usual, spec.errata))


def choice_of(spec: Spec, text: str) -> Choice:
    """The choice that a text such as ``v4.6+E50b`` makes; raises `ReadError`."""
    names = [name for name in text.split("+") if name]
    editions = {edition.name for edition in spec.editions}
    chosen = [name for name in names if name in editions]
    if len(chosen) > 1:
        raise ReadError(f"{' and '.join(chosen)}: only one edition can be chosen")
    readings = tuple(name for name in names if name not in editions)
    choice = Choice(edition="".join(chosen), readings=readings)
    alternatives_of(spec, choice)
    return choice


def editions_of(spec: Spec, name: str) -> tuple[Edition, ...]:
    """The edition of that name with those that it changes, the lowest first; raises `ReadError`."""
    by_name = {edition.name: edition for edition in spec.editions}
    found: list[Edition] = []
    while name:
        if name not in by_name:
            raise ReadError(_unknown("edition", name, list(by_name)))
        if by_name[name] in found:
            raise ReadError(f"edition {name!r} lies over itself")
        found.append(by_name[name])
        name = by_name[name].head.over
    return tuple(reversed(found))


def alternatives_of(spec: Spec, choice: Choice) -> Mapping[str, AlternativeRow | None]:
    """By the number of an erratum the alternative taken, None for its usual reading.

    What a choice names goes before what its edition takes. Raises `ReadError` for names that there
    are not, and for two readings of one erratum.
    """
    known: dict[str, tuple[ErratumRow, AlternativeRow | None]] = {}
    for erratum in spec.errata:
        known[erratum.id] = erratum, None
        known.update((each.id, (erratum, each)) for each in erratum.alternatives)
    taken: dict[str, AlternativeRow | None] = {}
    for edition in editions_of(spec, choice.edition):
        taken |= _taken(edition.head.readings, known)
    return taken | _taken(choice.readings, known)


def _taken(
    readings: tuple[str, ...], known: Mapping[str, tuple[ErratumRow, AlternativeRow | None]]
) -> dict[str, AlternativeRow | None]:
    taken: dict[str, AlternativeRow | None] = {}
    by: dict[str, str] = {}
    for name in readings:
        if name not in known:
            raise ReadError(_unknown("reading or edition", name, list(known)))
        erratum, alternative = known[name]
        if by.setdefault(erratum.id, name) != name:
            raise ReadError(f"{by[erratum.id]} and {name} are two readings of one erratum")
        taken[erratum.id] = alternative
    return taken


def _unknown(what: str, name: str, known: list[str]) -> str:
    close = get_close_matches(name, known, n=1)
    alternatives = [each for each in known if not each[-1:].isdigit()] if len(known) > 20 else known
    hint = f"did you mean {close[0]!r}?" if close else f"there are {', '.join(alternatives)}"
    return f"there is no {what} {name!r}; {hint if known else 'the spec has none'}"


def errata_in_force(spec: Spec, choice: Choice) -> tuple[ReadErratum, ...]:
    """The errata of the standard and of the editions, in order; raises `ReadError`."""
    return tuple(_in_force(spec, choice))


def _in_force(spec: Spec, choice: Choice) -> Iterator[ReadErratum]:
    taken = alternatives_of(spec, choice)
    for erratum in spec.errata:
        yield _read_as(erratum, taken.get(erratum.id) or erratum)
    for edition in editions_of(spec, choice.edition):
        yield from map(_usual, edition.errata)


def with_editions(spec: Spec, choice: Choice) -> Spec:
    """The printed rows with the messages and tables that the chosen editions have besides."""
    editions = editions_of(spec, choice.edition)
    tables = {name: signal for each in editions for name, signal in each.head.value_tables.items()}
    messages = [*spec.messages.messages, *(row for each in editions for row in each.messages)]
    return dataclasses.replace(
        spec,
        standard=dataclasses.replace(
            spec.standard, value_tables={**spec.standard.value_tables, **tables}
        ),
        messages=dataclasses.replace(spec.messages, messages=tuple(messages)),
        tables=(*spec.tables, *(table for each in editions for table in each.tables)),
    )


def _usual(row: ErratumRow) -> ReadErratum:
    return _read_as(row, row)


def _read_as(row: ErratumRow, reading: ErratumRow | AlternativeRow) -> ReadErratum:
    """The erratum in its own reading, or in one of its alternatives."""
    return ReadErratum(
        id=reading.id,
        row=row,
        reading=reading.reading,
        because=reading.because,
        source=reading.source,
        change=reading.change,
        where=reading.where_is("id"),
        change_where=reading.where_is("change"),
    )
