"""The simulated nodes speak each reading and edition of the spec: judged by what it says."""

from __future__ import annotations

from functools import cache
from typing import Any

import can
import pytest
from rules.recorded import block_of, recorded

from swapcan import PROTOCOL, codec_for
from swapcan.rules import SCOPE
from typedcan.judge import Judge, Judgement, Severity, Status, Verdict, rules_for
from typedcan.model.protocol import Variant
from typedcan.model.variants import erratum_of
from typedcan.transfer import Transfers
from typedcan.wire.codec import Codec
from typedcan.wire.protocol import Protocol
from typedcan.wire.receiver import Received, Receiver

PLAN = "hv_on@1s, ask@2s, drive@4s+6s, hv_off@13s, charge@20s+6s"
VARIANTS = PROTOCOL.model.variants
NAMES = ["", *(each.name for each in VARIANTS)]

ALIKE = frozenset({"E27", "E34", "E40", "E47", "E51", "E53", "E54"})
"""Errata whose readings no frame tells apart: an open checksum and what fills up are never wrong, a
scale, a bus, and codes that are not sent do not show."""

UNFILLED = frozenset({"invalid-lasting", "code-reserved"})
"""What only an edition has is sent with its start values, which are invalid or reserved."""


@cache
def frames(name: str) -> tuple[can.Message, ...]:
    """What they say in a reading or an edition of that name; "" for the usual ones."""
    is_edition = any(each.name == name and each.is_edition for each in VARIANTS)
    edition, readings = (name, ()) if is_edition else ("", (name,) if name else ())
    return recorded(PLAN, seconds=30.0, edition=edition, readings=readings)


def spoken(name: str) -> Protocol:
    is_edition = any(each.name == name and each.is_edition for each in VARIANTS)
    if is_edition:
        return codec_for(name).protocol
    return codec_for(readings=[name] if name else []).protocol


@cache
def judged(name: str, by: str) -> Judgement:
    """What they say in the one, judged by the other."""
    protocol = spoken(by)
    judge = Judge(protocol, rules_for(protocol, SCOPE))
    judge.feed(block_of(frames(name)))
    return judge.finish()


def told(name: str, by: str) -> dict[str, int]:
    """What there is to be told of it by the other: broken rules, faults, and what is complete."""
    told = {result.rule.id: result.count for result in judged(name, by).results if result.count}
    protocol = spoken(by)
    receiver, transfers = Receiver(Codec(protocol)), Transfers(protocol)
    for frame in frames(name):
        received = receiver.take(frame)
        if isinstance(received, Received):
            for outcome in transfers.take(received.message, frame.timestamp):
                word = type(outcome).__name__
                told[word] = told.get(word, 0) + 1
    counts = receiver.counts
    told |= {f"{of} {name}": 1 for of, names in transfers.readings.items() for name in names}
    return told | {"foreign": counts.foreign, "faults": counts.faults}


def wrong(name: str, by: str) -> list[str]:
    """What is broken of more than what is only worth knowing."""
    return [
        f"{result.rule.id}: {result.first.says() if result.first else ''}"
        for result in judged(name, by).of_status(Status.FAILED)
        if result.rule.severity is not Severity.INFO and result.rule.id not in UNFILLED
    ]


@pytest.mark.parametrize("name", NAMES)
def test_what_is_spoken_conforms_to_itself(name: str) -> None:
    assert wrong(name, by=name) == []
    assert judged(name, by=name).verdict is Verdict.CONFORMS
    own, usual = told(name, by=name), told("", by="")
    assert own["faults"] == own["foreign"] == 0
    assert {key for key in usual if key[0].isupper()} <= own.keys()  # VIN, code, cells, probes


@pytest.mark.parametrize("variant", VARIANTS, ids=lambda each: each.name)
def test_what_is_spoken_is_told_apart_from_the_usual(variant: Variant) -> None:
    usual, other = told("", by=""), told(variant.name, by="")
    erratum = erratum_of(PROTOCOL.model, variant.name)
    assert (usual == other) is (erratum in ALIKE), (usual, other)


@pytest.mark.parametrize("name", NAMES)
def test_a_pack_is_switched_on_and_off_in_it_whatever_the_words(name: str) -> None:
    codec = Codec(spoken(name))
    states: list[str] = []
    for frame in frames(name):
        message: Any = codec.decode_frame(frame)
        if message.NAME == "B2V_ST1":
            label = message.FIELDS["bms"].text(message.bms)
            if not states or states[-1] != label:
                states.append(label)
    assert states == ["HV open", "Precharge", "HV closed", "HV open"]
