"""The rows of standard.yaml: the document, its nodes and buses, and its conventions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from dbcspec.spec.schema import (
    INTEGER,
    NAME,
    SIGNAL,
    TEXT,
    Record,
    key,
    list_of,
    map_of,
    nested,
    one_of,
)

LIST_OF_TEXT = list_of(TEXT)


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeRow(Record):
    """A participant on the bus."""

    name: str = key(NAME, "its one name", required=True)
    english: str = key(TEXT, "what it is", required=True)
    title: str = key(TEXT, "its name in the language of the standard", default="")
    address: int | None = key(INTEGER, "its J1939 source address")
    other_addresses: tuple[int, ...] = key(list_of(INTEGER), "further source addresses", default=())
    aliases: tuple[str, ...] = key(LIST_OF_TEXT, "other names that the print uses", default=())
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class BusRow(Record):
    """A physical bus and who is on it."""

    name: str = key(NAME, "its name, used for file names", required=True)
    english: str = key(TEXT, "what it is", required=True)
    title: str = key(TEXT, "its name in the language of the standard", default="")
    bit_rate: int | None = key(INTEGER, "bit/s")
    nodes: tuple[str, ...] = key(list_of(NAME), "the nodes on it", default=())
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class Standard(Record):
    """standard.yaml: the document itself, its nodes and buses, and its conventions."""

    number: str = key(TEXT, "the number of the standard", required=True)
    title: str = key(TEXT, "its title", required=True)
    english: str = key(TEXT, "its title in English", required=True)
    part: int | None = key(INTEGER, "the number of the part")
    part_title: str = key(TEXT, "the title of the part", default="")
    part_english: str = key(TEXT, "the title of the part in English", default="")
    edition: str = key(TEXT, "edition or state", default="")
    nodes: tuple[NodeRow, ...] = key(list_of(nested(NodeRow)), "the nodes", default=())
    buses: tuple[BusRow, ...] = key(list_of(nested(BusRow)), "the buses", default=())
    frame_format: str = key(
        one_of("StandardCAN", "ExtendedCAN", "J1939PG", "StandardCAN_FD", "ExtendedCAN_FD"),
        "VFrameFormat of the messages",
    )
    reserved: tuple[str, ...] = key(LIST_OF_TEXT, "names of fields that are no signals", default=())
    profile: str = key(
        one_of("house", "foreign"),
        "what lint asks unless the project says: house of our own, foreign of files of others",
        default="house",
    )
    units: Mapping[str, str] = key(map_of(TEXT, TEXT), "printed unit: its ASCII form", default={})
    invalid_labels: tuple[str, ...] = key(LIST_OF_TEXT, "labels of an invalid signal", default=())
    abnormal_labels: tuple[str, ...] = key(LIST_OF_TEXT, "labels of an abnormal value", default=())
    value_tables: Mapping[str, str] = key(
        map_of(NAME, SIGNAL), "value table name: a signal that has these codes", default={}
    )
