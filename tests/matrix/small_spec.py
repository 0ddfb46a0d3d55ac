"""A spec of four signals with comments in every place, and what tests do with it."""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dbcspec.spec.errata import apply_errata
from dbcspec.spec.folder import read_spec
from dbcspec.spec.resolve import resolve
from dbcspec.spec.write import Proposal
from typedcan.model.protocol import Code, Protocol, ValueTable

STANDARD = """\
number: T 1
title: 标准
english: Standard
nodes:
  - {name: A, english: Node A}
  - {name: B, english: Node B}
units: {℃: degC}
invalid_labels: [Invalid]
"""
MESSAGES = """\
# the annex
annex: A.1
byte_order: Intel
messages:
  - id: 0x18FF0001   # first
    name: First
    length: 8
    type: Cyclic
    period: 100      # ms
    signals:
      - {name: Temp, length: 8, start: 0}   # in front
      - {name: Mode, length: 4, start: 8}
      - {name: Copy, length: 4, start: 12}
  # between
  - id: 0x18FF0002
    name: Second
    length: 8
    type: Event
    period: 0
    signals:
      - name: Kept
        length: 8
        start: 0
# the end
"""
TABLE = """\
# Table 1
number: 1
clause: "1"
rows:
  - no: 1
    name: Temp
    title: '温度'  # as printed
    english: >-
      Temperature
      of the pack
    length: 8
    factor:   0.5
    offset: -40
    unit: ℃
    range: -40~87.5
    route: A>B

  - no: 2
    name: Mode   # a comment
    length: 4
    codes:
      0: OFF       # not false
      1: "on: yes"
    factor: 1
    offset: 0
    unit: ""
    range: 0~15
    route: A>B
  - {no: 3, name: Copy, length: 4, codes: {same_as: Mode}, factor: 1, offset: 0, unit: "",
     range: 0~15, route: A>B}
  - no: 4
    name: Kept
    length: 8
    factor: 1
    unit: V
    range: 0~100
    route: B>A
"""
ERRATA = """\
errata:
  - id: E01
    kind: gap
    place: Table 1 row 4
    printed: nothing
    reading: the offset is 0, and the range stands
    because: so
    change:
      - at: [tables/01-only/4]
        set: {offset: 0}
      - at: [tables/01-only/4]
        keep: [range]
"""
FILES = {
    "standard.yaml": STANDARD,
    "messages.yaml": MESSAGES,
    "tables/01-only.yaml": TABLE,
    "errata.yaml": ERRATA,
}


def model(folder: Path) -> Protocol:
    return resolve(apply_errata(read_spec(folder, "spec"))[0], "small")


def changed(
    protocol: Protocol,
    signals: Mapping[str, Mapping[str, Any]],
    messages: Mapping[str, Mapping[str, Any]] | None = None,
) -> Protocol:
    return dataclasses.replace(
        protocol,
        messages=tuple(
            dataclasses.replace(
                message,
                signals=tuple(
                    dataclasses.replace(each, **signals.get(each.name, {}))
                    for each in message.signals
                ),
                **(messages or {}).get(message.name, {}),
            )
            for message in protocol.messages
        ),
    )


def lines(folder: Path, proposal: Proposal) -> list[str]:
    """The lines that go and come, without those around them."""
    shown: list[str] = []
    for name, data in proposal.files.items():
        old, new = (folder / name).read_text("utf-8"), data.decode("utf-8")
        delta = difflib.unified_diff(old.splitlines(), new.splitlines(), lineterm="", n=0)
        shown += [line for line in delta if not line.startswith(("---", "+++", "@@"))]
    return shown


def applied(folder: Path, proposal: Proposal) -> Protocol:
    for name, data in proposal.files.items():
        (folder / name).write_bytes(data)
    return model(folder)


def codes(*labels: tuple[int, str]) -> ValueTable:
    return ValueTable("Mode", tuple(Code(code, label, label) for code, label in labels))
