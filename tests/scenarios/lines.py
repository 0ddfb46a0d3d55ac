"""Frames by hand, with bytes by cantools, and what a judge says of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

import can
import cantools
from cantools.database.can import Database

from swapcan.conform import RULES, Judgement, Rule, judge_log

DBC = Path(__file__).parents[2] / "dbc" / "caamtb-swap.dbc"


@cache
def database() -> Database:
    """The protocol, read by cantools."""
    found = cantools.database.load_file(DBC)
    assert isinstance(found, Database)
    return found


def values(frame: can.Message) -> dict[str, object]:
    """The signals of a frame, decoded by cantools, codes as numbers."""
    message = database().get_message_by_frame_id(frame.arbitration_id)
    decoded = message.decode(bytes(frame.data), decode_choices=False)
    assert isinstance(decoded, dict)
    return dict(decoded)


def line(second: float, name: str, *, spoilt: bool = False, **signals: float) -> str:
    """A line of a candump log, encoded by cantools; signals without their message's prefix.

    Signals that are not given are 0; the checksum is the XOR of bytes 1 to 7, or a wrong one.
    """
    message = database().get_message_by_name(name)
    given = dict.fromkeys((signal.name for signal in message.signals), 0.0)
    for signal in message.signals:
        given[signal.name] = float(signal.offset)
    own = {signal.name.removeprefix(f"{name}_"): signal.name for signal in message.signals}
    for short, value in signals.items():
        given[own.get(short, short)] = value
    data = bytearray(message.encode(given, strict=False))
    if any(signal.name.endswith("_Checksum") for signal in message.signals):
        data[0] = 0
        for byte in data[1:]:
            data[0] ^= byte
        data[0] ^= 0xFF * spoilt
    return f"({1000 + second:.6f}) can0 {message.frame_id:08X}#{data.hex().upper()}\n"


def judged(lines: Iterable[str], path: Path, rules: Sequence[Rule] = RULES) -> Judgement:
    """The judgement of the pack in a log of those lines, in the order of their times."""
    path.write_text("".join(sorted(lines)), "ascii", newline="\n")
    return judge_log(path, ["BMU"], rules=rules)


def said(judgement: Judgement, rule: Rule) -> list[str]:
    """What a rule found: second, subject and text."""
    return [
        f"{found.start:.2f} s: {found.subject}: {found.says()}"
        for found in judgement.result(rule.id).occurrences
    ]


def times(start: float, end: float, period: float) -> list[float]:
    """From start on, before end."""
    return [start + number * period for number in range(round((end - start) / period))]


def commands(
    start: float, end: float, code: int, *, spoilt: bool = False, counter: int | None = None
) -> list[str]:
    """V2B_CMD every 50 ms; its counter runs from 0 to 14, or stands still."""
    return [
        line(
            second,
            "V2B_CMD",
            HV_OnOff=code,
            ALIV=round(second / 0.05) % 15 if counter is None else counter,
            spoilt=spoilt,
        )
        for second in times(start, end, 0.05)
    ]


def states(start: float, end: float, code: int, *, level: int = 0) -> list[str]:
    """B2V_ST1 every 100 ms, 20 ms behind."""
    return [
        line(second + 0.02, "B2V_ST1", BMS=code, Fault_Levl=level)
        for second in times(start, end, 0.1)
    ]


def charger(start: float, end: float, *, fault: int = 0) -> list[str]:
    """C2B_ACStatus every 500 ms."""
    return [
        line(second, "C2B_ACStatus", C2B_F_ChargerHardware=fault)
        for second in times(start, end, 0.5)
    ]


def control(start: float, end: float, code: int) -> list[str]:
    """B2C_Charger every 500 ms, 100 ms behind."""
    return [
        line(second + 0.1, "B2C_Charger", B2V_S_ChargeControl=code)
        for second in times(start, end, 0.5)
    ]
