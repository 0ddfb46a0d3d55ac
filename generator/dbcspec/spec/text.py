"""Messages and signals as the text of a spec: how new rows and values are written."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from decimal import Decimal

from dbcspec.spec.errata_rows import ErratumRow
from dbcspec.spec.source import Table
from dbcspec.spec.splice import flow, scalar
from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Message, SendType, Signal

SEND_TYPES = {
    SendType.CYCLIC: "Cyclic",
    SendType.IF_ACTIVE: "IfActive",
    SendType.EVENT: "Event",
}
"""The words of the annex."""


def message_entry(message: Message) -> dict[str, str]:
    """A message as an entry of the annex: key to YAML text."""
    fields = "".join(
        f"\n      - {{name: {each.name}, length: {each.length}, start: {each.start}}}"
        for each in message.signals
    )
    return {
        "id": f"0x{message.frame_id:0{8 if message.extended else 3}X}",
        "name": message.name,
        **({"english": scalar(message.english)} if message.english else {}),
        "length": str(message.length),
        "type": SEND_TYPES[message.send_type],
        "period": str(message.period or 0),
        "signals": fields or "[]",
    }


def signal_row(number: int, sender: str, signal: Signal, unit: str) -> dict[str, str]:
    """A signal as a row of a table: key to YAML text; ``unit`` as it is printed."""
    labels, english = labels_of(signal)
    return {
        "no": str(number),
        "name": signal.name,
        **({"title": scalar(signal.title)} if signal.title else {}),
        **({"english": scalar(signal.english)} if signal.english else {}),
        "length": str(signal.length),
        **({"codes": flow(labels)} if labels else {}),
        **({"english_codes": flow(english)} if english else {}),
        "factor": plain(signal.factor),
        "offset": plain(signal.offset),
        "unit": scalar(unit),
        "range": f"{plain(signal.minimum)}~{plain(signal.maximum)}",
        "route": f"{sender}>{','.join(signal.receivers)}",
    }


def row_values(sender: str, signal: Signal, unit: str) -> Iterator[tuple[str, str, str]]:
    """Difference, key and YAML text of what a table's row says; ``unit`` as it is printed.

    Without a sender or receivers there is no route.
    """
    yield "title", "title", scalar(signal.title)
    yield "English title", "english", scalar(signal.english)
    yield "length", "length", str(signal.length)
    yield "factor", "factor", plain(signal.factor)
    yield "offset", "offset", plain(signal.offset)
    yield "unit", "unit", scalar(unit)
    yield "range", "range", f"{plain(signal.minimum)}~{plain(signal.maximum)}"
    if sender and signal.receivers:
        yield "receivers", "route", f"{sender}>{','.join(signal.receivers)}"


def acts_values(acting: ActingCodes) -> dict[str, str]:
    """Codes that act as an entry of the behaviour: key to YAML text, but for the signal."""
    return {
        "codes": f"[{', '.join(map(str, acting.codes))}]",
        "safe": str(acting.safe),
        "kind": acting.kind,
        "cite": scalar(acting.reference),
    }


def acts_entry(signal: str, acting: ActingCodes) -> dict[str, str]:
    """Codes that act as a new entry of the behaviour."""
    usual = {"kind": "command", "cite": scalar("")}
    given = {key: text for key, text in acts_values(acting).items() if text != usual.get(key)}
    return {"signal": signal, **given}


def labels_of(signal: Signal) -> tuple[dict[int, str], dict[int, str]]:
    """The printed labels, and the English ones where they differ."""
    codes = signal.value_table.codes if signal.value_table else ()
    labels = {code.value: code.label for code in codes}
    return labels, {code.value: code.english for code in codes if code.english != code.label}


def plain(value: Decimal) -> str:
    """A plain decimal without needless zeros, as the spec writes numbers."""
    plain = format(value, "f")
    plain = plain.rstrip("0").rstrip(".") if "." in plain else plain
    return "0" if plain == "-0" else plain


def settled(errata: Sequence[ErratumRow]) -> Iterator[tuple[tuple[str, str], str]]:
    """Address and key of what an erratum sets or keeps, with its number."""
    for erratum in errata:
        for change in erratum.change:
            keys = list(change.keep)
            if isinstance(change.set, Table):
                keys += [name.text for name, _ in change.set.entries]
            for path in change.at:
                yield from (((path, key), erratum.id) for key in keys)
