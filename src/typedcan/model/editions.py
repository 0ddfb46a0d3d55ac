"""What editions of a protocol disagree about, and what tells that another one is spoken."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from typedcan.model.protocol import Protocol, Variant
from typedcan.model.variants import changes_of


def edition_of(protocol: Protocol) -> str:
    """The edition that was chosen; "" for none, so that any of them may be spoken."""
    editions = {each.name for each in protocol.variants if each.is_edition}
    return next((name for name in protocol.chosen.split("+") if name in editions), "")


def signs_of_others(protocol: Protocol) -> Mapping[tuple[int, bool], str]:
    """The edition that alone has a message, by its identifier and whether that has 29 bits."""
    known = {(message.frame_id, message.extended) for message in protocol.messages}
    found: dict[tuple[int, bool], str] = {}
    for edition, path, value in _changes(protocol):
        if len(path) == 2 and path[0] == "messages" and isinstance(value, dict):
            number = int(value["frame_id"]), bool(value.get("extended", True))
            if number not in known:
                found.setdefault(number, edition.name)
    return found


def unsure_codes(protocol: Protocol) -> Mapping[str, Mapping[str, int]]:
    """By message and signal, what is sent as safe where nobody knows which edition is spoken.

    Of signals that act at other codes in another edition, or have another safe code there, that is
    the code of no valid value, unless it acts somewhere itself.
    """
    acting = acting_in_editions(protocol)
    codes: dict[str, dict[str, int]] = {}
    for message, signal in protocol.signals():
        elsewhere = acting.get((message.name, signal.name))
        here = signal.acting.codes if signal.acting else ()
        invalid = signal.invalid_code
        if elsewhere is not None and invalid is not None and invalid not in (*here, *elsewhere):
            codes.setdefault(message.name, {})[signal.name] = invalid
    return codes


def acting_in_editions(protocol: Protocol) -> Mapping[tuple[str, str], Mapping[int, str]]:
    """By message and signal that editions disagree about, the codes that act in an edition.

    With the name of the edition; none where one has another safe code only.
    """
    found: dict[tuple[str, str], dict[int, str]] = {}
    for edition, path, value in _changes(protocol):
        match path:
            case ["messages", message, "signals", signal, "acting", *rest]:
                codes = found.setdefault((message, signal), {})
                told = value.get("codes", ()) if isinstance(value, dict) else value
                if not rest or rest == ["codes"]:
                    codes.update(dict.fromkeys(told or (), edition.name))
    return found


def _changes(protocol: Protocol) -> Iterator[tuple[Variant, list[str], Any]]:
    """What editions say otherwise than the usual readings."""
    for each in protocol.variants:
        if each.is_edition:
            for path, value in changes_of(each):
                yield each, path.split("/"), value
