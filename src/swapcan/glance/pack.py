"""The pack at a glance: what one wants to know of it first, gathered from all its messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_ST3,
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    V2B_CMD,
    B2V_BattInfo1,
)
from typedcan.monitor.glance import Known, Seen
from typedcan.monitor.rows import LATE, LOST, mark_of
from typedcan.wire.fields import LabelledField, Value
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol


@dataclass(frozen=True, slots=True)
class Item:
    """One thing to know of the pack.

    Parameters
    ----------
    key, label
        Its name for programs and for people.
    text
        What it is, with unit or label; empty where nobody has told yet.
    value, unit
        The same as a number, or a code without unit; None where there is none.
    mark
        Why not to rely on it: that its signal is "invalid" or the like, or that its message is
        "late" or "lost". Empty where nothing is wrong.
    """

    key: str
    label: str
    text: str
    value: float | None = None
    unit: str = ""
    mark: str = ""


@dataclass(frozen=True, slots=True)
class Section:
    """Items that belong together."""

    title: str
    items: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class Pack:
    """The pack at one moment."""

    sections: tuple[Section, ...]

    def item(self, key: str) -> Item:
        """The item of that key; raises `LookupError`."""
        for section in self.sections:
            for item in section.items:
                if item.key == key:
                    return item
        raise LookupError(f"the pack has no {key!r}")

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it, items by key."""
        items = [item for section in self.sections for item in section.items]
        shown = ("text", "value", "unit", "mark")
        return {item.key: {name: getattr(item, name) for name in shown} for item in items}


class _Line(NamedTuple):
    """Where an item comes from; ``places`` are fields that tell where in the pack it is."""

    key: str
    label: str
    message: type[Message]
    field: str
    places: tuple[str, ...] = ()


class _Facts(NamedTuple):
    """What items are made from, by names of messages: the protocol may have classes of its own."""

    protocol: Protocol
    seen: Mapping[str, Seen]
    states: Mapping[str, str]


_Source = _Line | Callable[[_Facts], Item]


def _power(facts: _Facts) -> Item:
    """Voltage times current, in kW; the current of charging is negative."""
    volts = _value(facts, B2V_ST3, "upack_batt")
    amperes = _value(facts, B2V_ST2, "current")
    if not (isinstance(volts, int | float) and isinstance(amperes, int | float)):
        return Item("power", "power", "")
    kilowatts = round(volts * amperes / 1000, 3)
    what = "" if not kilowatts else ", charging" if kilowatts < 0 else ", discharging"
    mark = _silence(facts, B2V_ST2) or _silence(facts, B2V_ST3)
    return Item("power", "power", f"{kilowatts:.1f} kW{what}", kilowatts, "kW", mark)


_SECTIONS: Mapping[str, tuple[_Source, ...]] = {
    "energy": (
        _Line("soc", "SOC", B2V_ST2, "soc"),
        _Line("soh", "SOH", B2V_ST2, "soh"),
        _Line("voltage_inside", "inside", B2V_ST3, "upack_batt"),
        _Line("voltage_outside", "outside", B2V_ST3, "upack_out"),
        _Line("current", "current", B2V_ST2, "current"),
        _power,
        _Line("charge_limit", "max in", B2V_ST2, "max_lmt_chg_curr"),
        _Line("discharge_limit", "max out", B2V_ST2, "max_lmt_dis_chg_curr"),
        _Line("rated_capacity", "capacity", B2V_BattInfo1, "rate_cap"),
    ),
    "high voltage": (
        _Line("hv_state", "state", B2V_ST1, "bms"),
        _Line("hv_command", "command", V2B_CMD, "hv_on_off"),
        _Line("main_positive", "main +", B2V_ST0, "st_main_pos"),
        _Line("main_negative", "main -", B2V_ST0, "st_main_neg"),
        _Line("precharge", "precharge", B2V_ST0, "st_prechg"),
        _Line("charge_positive_1", "charge 1 +", B2V_ST0, "st_chg_pos1"),
        _Line("charge_negative_1", "charge 1 -", B2V_ST0, "st_chg_neg1"),
        _Line("charge_positive_2", "charge 2 +", B2V_ST0, "st_chg_pos2"),
        _Line("charge_negative_2", "charge 2 -", B2V_ST0, "st_chg_neg2"),
    ),
    "safety": (
        _Line("fault_level", "level", B2V_ST1, "fault_levl"),
        _Line("insulation_positive", "insul. +", B2V_ST3, "pos_ins_res"),
        _Line("insulation_negative", "insul. -", B2V_ST3, "neg_ins_res"),
    ),
    "charging": (
        _Line("charge_state", "state", B2V_ST1, "chg_st"),
        _Line("charge_mode", "mode", B2V_ST1, "chg_mode"),
        _Line("charge_line", "gun", B2V_ST1, "chg_line"),
    ),
    "temperatures": (
        _Line("hottest", "max", B2V_ST4, "max_temp", ("max_temp_csc_no", "max_temp_position")),
        _Line("coldest", "min", B2V_ST4, "min_temp", ("min_temp_csc_no", "min_temp_position")),
        _Line("temperature", "average", B2V_ST4, "avg_temp"),
    ),
    "cell voltages": (
        _Line(
            "highest_cell", "max", B2V_ST5, "max_ucell", ("max_ucell_csc_no", "max_ucell_position")
        ),
        _Line(
            "lowest_cell", "min", B2V_ST6, "min_ucell", ("min_ucell_csc_no", "min_ucell_position")
        ),
        _Line("cell", "average", B2V_ST5, "avg_ucell"),
    ),
}


def pack_of(protocol: Protocol, known: Known) -> Pack:
    """What the last messages say of the pack."""
    seen = {kind.NAME: each for kind, each in known.last.items()}
    facts = _Facts(protocol, seen, known.states)
    return Pack(
        tuple(
            Section(
                title,
                tuple(
                    _item(facts, source) if isinstance(source, _Line) else source(facts)
                    for source in sources
                ),
            )
            for title, sources in _SECTIONS.items()
        )
    )


def _item(facts: _Facts, line: _Line) -> Item:
    value = _value(facts, line.message, line.field)
    if value is None:
        return Item(line.key, line.label, "")
    kind = facts.seen[line.message.NAME].received.kind
    field = kind.FIELDS[line.field]
    text = field.text(value)
    places = [_value(facts, line.message, place) for place in line.places]
    if len(places) == 2 and all(isinstance(place, int) for place in places):
        text += f", CSC {places[0]} no. {places[1]}"
    wrong = mark_of(facts.protocol, kind, line.field, value)
    number = value if isinstance(value, int | float) else None
    if isinstance(field, LabelledField) and number is not None:
        number = int(number)
    elif number is not None:
        number = round(number, 9)
    return Item(
        line.key, line.label, text, number, field.unit, _silence(facts, line.message) or wrong or ""
    )


def _value(facts: _Facts, kind: type[Message], field: str) -> Value:
    seen = facts.seen.get(kind.NAME)
    value: Value = getattr(seen.received.message, field) if seen else None
    return value


def _silence(facts: _Facts, kind: type[Message]) -> str:
    state = facts.states.get(kind.NAME, "")
    return state if state in (LATE, LOST) else ""
