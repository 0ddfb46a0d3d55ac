"""The rows of errata.yaml: readings that differ from print, their changes, and other readings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from dbcspec.spec.schema import (
    NAME,
    TEXT,
    Record,
    key,
    list_of,
    map_of,
    nested,
    one_of,
    raw,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangeRow(Record):
    """One step of an erratum; exactly one of set, add, remove, relabel, keep."""

    at: tuple[str, ...] = key(list_of(TEXT), "paths of what it changes", required=True)
    set: Any = key(raw(), "keys with their new values")
    add: Any = key(raw(), "an entry to append to the list at the path")
    remove: Any = key(raw(), "a list at the path, and the names of entries that it loses")
    relabel: Mapping[str, str] = key(map_of(TEXT, TEXT), "label as printed: as read", default={})
    keep: tuple[str, ...] = key(list_of(NAME), "keys whose print stands", default=())


@dataclass(frozen=True, slots=True, kw_only=True)
class AlternativeRow(Record):
    """Another reading of the same place, which a run can choose; its change replaces the usual."""

    IDENTITY: ClassVar[str] = "id"

    id: str = key(NAME, "the erratum's number and a small letter, never reused", required=True)
    reading: str = key(TEXT, "what is read then", required=True)
    because: str = key(TEXT, "why somebody reads it so", required=True)
    source: str = key(TEXT, "who does, as far as known", default="")
    change: tuple[ChangeRow, ...] = key(list_of(nested(ChangeRow)), "the change", required=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class ErratumRow(Record):
    """A reading that differs from print, fills a gap, or settles a doubt."""

    IDENTITY: ClassVar[str] = "id"

    id: str = key(NAME, "its number, never reused", required=True)
    kind: str = key(
        one_of("scan", "typo", "conflict", "gap", "choice", "edition"),
        "what sort of fault; edition: no fault, another edition says otherwise",
        required=True,
    )
    place: str = key(TEXT, "where in the document", required=True)
    printed: str = key(TEXT, "what stands there", required=True)
    reading: str = key(TEXT, "what is read instead", required=True)
    because: str = key(TEXT, "why", required=True)
    source: str = key(TEXT, "who confirms it, as far as known", default="")
    change: tuple[ChangeRow, ...] = key(list_of(nested(ChangeRow)), "the change", required=True)
    alternatives: tuple[AlternativeRow, ...] = key(
        list_of(nested(AlternativeRow)), "other readings, of a gap, choice or conflict", default=()
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Errata(Record):
    """errata.yaml: the numbered corrections."""

    MAIN: ClassVar[str] = "errata"

    errata: tuple[ErratumRow, ...] = key(list_of(nested(ErratumRow)), "in order", required=True)
