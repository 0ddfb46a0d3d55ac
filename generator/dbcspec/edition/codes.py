"""What a supplier's labels say of a signal's codes, in the words that the spec has for it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from dbcspec.compare.languages import plain
from dbcspec.compare.senses import agree, contradict, is_reserved, means_no_value
from dbcspec.spec.rows import SignalRow, Spec
from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Code, Signal, ValueTable

_NO_UNITS = frozenset({"bit", "bits", "-", "/", "none"})
"""What files write where a signal has no unit."""


@dataclass(frozen=True, slots=True)
class NewCodes:
    """The codes of a row as a supplier has them: labels, English, and what differs.

    ``changed`` are codes that mean something else now, ``added`` those that the spec does not have.
    """

    labels: Mapping[int, str]
    english: Mapping[int, str]
    changed: tuple[int, ...]
    added: tuple[int, ...]


def says_reserved(signal: Signal) -> bool:
    """Whether its name or its title says that its bits are reserved."""
    name = re.sub(r"(?<=[a-z])(?=[A-Z])|[_\d]+$", " ", signal.name)
    return is_reserved(name) or bool(re.fullmatch(r"(?:预留|保留)\w{0,3}", signal.title.strip()))


def states_of(spec: Spec) -> tuple[str, ...]:
    """The spec's own words for what is no value: invalid, abnormal, and reserved codes."""
    reserved = (label for _, row in spec.rows() for label in row.labels.values())
    return (
        *spec.standard.invalid_labels,
        *spec.standard.abnormal_labels,
        *[label for label in reserved if is_reserved(label)][:1],
    )


def in_own_words(signal: Signal, states: tuple[str, ...]) -> Signal:
    """A signal that is new to the spec: labels of states as the spec has them, no start value."""
    unit = "" if signal.unit.casefold() in _NO_UNITS else signal.unit
    signal = replace(signal, unit=unit, python_name="", start_value=0, invalid_code=None)
    if signal.value_table is None:
        return signal
    codes = (
        Code(each.value, label, label)
        for each in signal.value_table.codes
        if (label := _state(each, states) or _label(each))
    )
    return replace(signal, value_table=ValueTable(signal.value_table.name, tuple(codes)))


def new_codes(row: SignalRow, signal: Signal, states: tuple[str, ...]) -> NewCodes | None:
    """The codes of the row as the supplier's signal has them; None where nothing differs.

    A label that is only spelt otherwise stays as the spec has it, and so does a code that the file
    does not list.
    """
    labels, english = dict(row.labels), dict(row.english_codes)
    changed: list[int] = []
    added: list[int] = []
    low, high = signal.raw_limits
    for code in signal.value_table.codes if signal.value_table else ():
        known = code.value in row.labels
        if (known and not _means_otherwise(row, code)) or not low <= code.value <= high:
            continue
        (changed if known else added).append(code.value)
        english.pop(code.value, None)
        label, translated = _words(row, code, states)
        labels[code.value] = label
        if translated:
            english[code.value] = translated
    if not changed and not added:
        return None
    return NewCodes(
        dict(sorted(labels.items())), dict(sorted(english.items())), tuple(changed), tuple(added)
    )


def moved(acting: ActingCodes, row: SignalRow, new: NewCodes) -> ActingCodes | None:
    """The codes that act and the safe one where their labels now stand; None where one is gone."""
    now = [_place(row.labels.get(code, ""), code, new) for code in (*acting.codes, acting.safe)]
    known = [value for value in now if value is not None]
    if len(known) < len(now):
        return None
    return ActingCodes(codes=tuple(known[:-1]), safe=known[-1])


def _place(label: str, code: int, new: NewCodes) -> int | None:
    """The one code that has the label now: its own, or else the only one."""
    if new.labels.get(code) == label:
        return code
    places = [value for value, other in new.labels.items() if other == label]
    return places[0] if len(places) == 1 else None


def _texts(row: SignalRow, value: int) -> set[str]:
    return {plain(row.labels[value]), plain(row.english_codes.get(value, ""))} - {""}


def _meaning(row: SignalRow, value: int) -> str:
    return row.english_codes.get(value, row.labels[value])


def _means_otherwise(row: SignalRow, code: Code) -> bool:
    theirs = {plain(code.label), plain(code.english)} - {""}
    if not theirs or not theirs.isdisjoint(_texts(row, code.value)):
        return False
    elsewhere = (_texts(row, value) for value in row.labels if value != code.value)
    ours = _meaning(row, code.value)
    if means_no_value(ours) != means_no_value(code.label) or contradict(ours, code.label):
        return True
    return any(not theirs.isdisjoint(texts) for texts in elsewhere)


def _words(row: SignalRow, code: Code, states: tuple[str, ...]) -> tuple[str, str]:
    """The label of a code and its English: the spec's own words where it says the same."""
    theirs = {plain(code.label), plain(code.english)} - {""}
    same = [value for value in row.labels if not theirs.isdisjoint(_texts(row, value))]
    alike = (value for value in row.labels if agree(_meaning(row, value), code.label))
    for value in (*same, *alike):
        return row.labels[value], row.english_codes.get(value, "")
    return _state(code, states) or _label(code), ""


def _state(code: Code, states: tuple[str, ...]) -> str:
    return next((label for label in states if agree(label, code.label)), "")


def _label(code: Code) -> str:
    """The label without what no DBC file should have in it."""
    comma = " " if code.label.isascii() else "\uff0c"
    return comma.join(part.strip() for part in code.label.split(",")).strip() or str(code.value)
