"""Comparing is exact over models: nothing for equal ones, something wherever they differ."""

from __future__ import annotations

import copy
import dataclasses
from random import Random

import pytest
from compare.models import NOT_COMPARED, mutations, protocols
from hypothesis import given, settings
from hypothesis import strategies as st

from dbcspec.compare.registry import PROMISES
from dbcspec.compare.run import compare, worst
from typedcan.model import protocol as model
from typedcan.model.acting import ActingCodes
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Aspect, Protocol
from typedcan.model.transfer import Transfer
from typedcan.report.item import LEVELS

PLACES_OF = {
    Aspect.FRAME_FORMATS: ("Message.is_fd", "Message.bit_rate_switch", "Message.by_pgn"),
    Aspect.PERIODS: ("Message.period", "Message.send_type"),
    Aspect.START_VALUES: ("Signal.start_value",),
    Aspect.COMMENTS: (
        "Message.title",
        "Message.condition",
        "Signal.english",
        "Node.title",
        "Bus.english",
        "Protocol.title",
        "Transfer.english",
    ),
    Aspect.REFERENCES: (
        "Message.reference",
        "Signal.reference",
        "Signal.errata",
        "Node.errata",
        "Protocol.number",
        "Erratum.because",
        "ActingCodes.reference",
    ),
    Aspect.ADDRESSES: ("Node.address", "Node.other_addresses"),
    Aspect.PYTHON_NAMES: ("Signal.python_name",),
    Aspect.PROTECTION: (
        "Checksum.algorithm",
        "Counter.modulus",
        "Signal.invalid_code",
        "Signal.other_invalid_codes",
        "Signal.abnormal_code",
        "Bus.nodes",
    ),
    Aspect.ATTRIBUTES: (
        "Attribute.value",
        "Protocol.version",
        "AttributeDefinition.default",
        "SignalGroup.repetitions",
        "Relation.value",
        "EnvironmentVariable.codes",
    ),
    Aspect.ACTS: ("ActingCodes",),
    Aspect.TRANSFERS: ("Transfer.count", "Transfer.items", "Request.withdraw"),
}
"""Places of the model that a source without the aspect is silent about."""


@settings(max_examples=20)
@given(protocols)
def test_a_protocol_is_no_different_from_an_equal_one(protocol: Protocol) -> None:
    assert compare(protocol, protocol) == []
    assert compare(protocol, copy.deepcopy(protocol)) == []


@settings(max_examples=40)
@given(protocols, st.randoms(use_true_random=False))
def test_a_change_in_any_one_place_is_found_in_both_directions(
    protocol: Protocol, random: Random
) -> None:
    where, changed = random.choice(list(mutations(protocol)))
    assert changed != protocol
    assert compare(protocol, changed), where
    assert compare(changed, protocol), where


@settings(max_examples=20)
@given(protocols, protocols)
def test_two_protocols_give_findings_unless_they_are_equal(old: Protocol, new: Protocol) -> None:
    assert bool(compare(old, new)) == (old != new)


@pytest.mark.parametrize("aspect", PLACES_OF)
@settings(max_examples=3)
@given(protocol=protocols)
def test_what_one_side_cannot_say_is_no_difference(aspect: Aspect, protocol: Protocol) -> None:
    for where, changed in mutations(protocol):
        if where.startswith(PLACES_OF[aspect]):
            silent = dataclasses.replace(changed, carries=frozenset(Aspect) - {aspect})
            assert compare(protocol, silent) == [], where
            assert compare(silent, protocol) == [], where


@settings(max_examples=20)
@given(protocols, protocols)
def test_findings_say_what_a_report_needs(old: Protocol, new: Protocol) -> None:
    known = {promise.id: promise for promise in PROMISES}
    items = compare(old, new)
    for item in items:
        promise = known[item.rule]
        assert (item.level, item.breaks) == (promise.class_.word, promise.breaks.value)
        assert item.subject
        assert item.text
        assert item.old != item.new
    places = [(item.rule, item.group, item.subject, item.old, item.new) for item in items]
    assert len(set(places)) == len(places)
    levels = [LEVELS.index(item.level) for item in items]
    assert worst(items) == (LEVELS[min(levels)] if levels else None)


def test_every_field_of_the_model_is_changed_by_some_mutation(protocol: Protocol) -> None:
    kinds = (
        *(model.Protocol, model.Node, model.Bus, model.Message, model.Signal, model.Code),
        *(model.ValueTable, Checksum, Counter, Transfer, model.Request),
        *(model.Erratum, ActingCodes),
    )
    fields = {
        f"{kind.__name__}.{part.name}"
        for kind in kinds
        for part in dataclasses.fields(kind)
        if (part.compare and part.default is not None) or part.name == "period"
    }
    first = dataclasses.replace(protocol, messages=protocol.messages[:1])
    found = {where.split(" ")[0] for where, _ in mutations(first)}
    assert fields - set(NOT_COMPARED) - found <= {
        "Message.attributes",
        "Message.groups",
        "Message.relations",
        "Node.attributes",
        "Protocol.attributes",
        "Protocol.definitions",
        "Protocol.variables",
        "Signal.attributes",
        "Signal.selectors",
        "Signal.other_invalid_codes",
        "Signal.errata",
        "Checksum.before",
        "Checksum.after",
        "Checksum.data_ids",
        "Message.errata",
        "Message.other_senders",
        "Node.other_addresses",
        "Message.signals",
        "Transfer.counts",
    }
