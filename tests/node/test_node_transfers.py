"""Transfers of a protocol that is not this standard's: told by a node, and asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import can
import pytest
from node.bench import Recorder
from transfer.rack import DOCS, project, rack

from typedcan.dynamic import typed_protocol
from typedcan.model.transfers.blocks import NumberedBlocks
from typedcan.node.clock import SimulatedClock
from typedcan.node.errors import RequestError
from typedcan.node.node import Node
from typedcan.transfer import Blocks, Problem, Readings, Text, TransferError, Transfers, split
from typedcan.wire.message import Message

SERIAL = Text("serial", "A1B2C3", {"maker": 2})


class Pair:
    """Host and rack on one simulated clock."""

    def __init__(self, host: can.BusABC, rack_bus: can.BusABC, **options: Any) -> None:
        self.clock = SimulatedClock()
        self.host = Node(rack(), "HOST", host, clock=self.clock, **options)
        self.rack = Node(rack(), "RACK", rack_bus, clock=self.clock)

    def run(self, until: float) -> None:
        """Let the clock go to a time."""
        while self.clock.now() < until:
            for node in (self.host, self.rack) * 2:
                node.turn()
            due = min(self.host.next_due, self.rack.next_due, until)
            self.clock.advance_to(max(due, self.clock.now() + 0.001))
        for node in (self.host, self.rack) * 2:
            node.turn()


def named(name: str) -> type[Message]:
    return rack().message(name)


def test_values_of_all_kinds_are_told_as_events(near: can.BusABC, far: can.BusABC) -> None:
    pair = Pair(near, far)
    told: dict[type, Recorder] = {kind: Recorder() for kind in (Text, Readings, Blocks, Problem)}
    for kind, recorder in told.items():
        pair.host.on(kind, recorder)
    heats = {0: [1.0] * 4, 1: [2.0] * 3, 2: [3.0] * 2}
    for name, value in (("name", "架"), ("heats", heats), ("curve", [1.0, 2.0, 3.0, 4.0, 5.0])):
        pair.rack.set(*split(rack().transfer(name), value))
    pair.run(1.2)
    assert {each.text for each in told[Text].seen} == {"架"}
    assert {tuple(each.flat()) for each in told[Readings].seen} == {
        (1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0)
    }
    assert {each.values for each in told[Blocks].seen} == {(1.0, 2.0, 3.0, 4.0, 5.0)}
    assert told[Problem].seen == []
    assert pair.host.missing("weights") == "TOTALS with the totals is missing"


def test_a_transfer_is_asked_for_by_its_name(near: can.BusABC, far: can.BusABC) -> None:
    pair = Pair(near, far)
    pair.rack.provide(*split(rack().transfer("serial"), SERIAL))
    pair.rack.provide(*split(rack().transfer("key"), Blocks("key", tuple(range(8)), {"id": 7})))
    serial, key = pair.host.request("serial", Text), pair.host.request("key")
    pair.run(1.0)
    assert (serial.result(0).text, serial.result(0).details["maker"]) == ("A1B2C3", 2)
    assert bytes(key.result(0)) == bytes(range(8))


def test_a_message_is_asked_for_by_its_class(near: can.BusABC, far: can.BusABC) -> None:
    pair = Pair(near, far)
    pair.rack.provide(*split(rack().transfer("serial"), SERIAL))
    pending = pair.host.request(named("SERIAL_2"))
    pair.run(1.0)
    assert isinstance(pending.result(0), named("SERIAL_2"))


def test_what_an_answer_lacks_is_told(near: can.BusABC, far: can.BusABC) -> None:
    pair = Pair(near, far)
    pair.rack.provide(split(rack().transfer("serial"), SERIAL)[1])
    serial = pair.host.request("serial", timeout=0.5)
    second = pair.host.request(named("KEY"), timeout=0.5)
    pair.run(0.6)
    with pytest.raises(TimeoutError, match=r"serial.*frame 1 of 2 is missing"):
        serial.result(0)
    with pytest.raises(TimeoutError, match="KEY has not come"):
        second.result(0)


@pytest.mark.parametrize(
    ("ask", "error", "text"),
    [
        (lambda node: node.request("serial", Blocks), RequestError, "serial is Text, not Blocks"),
        (lambda node: node.request("name"), RequestError, "HOST has no request for the name"),
        (lambda node: node.request("nothing"), LookupError, "no transfer 'nothing'; known: name"),
        (lambda node: node.request(named("NAME")), RequestError, "no request for the NAME"),
    ],
)
def test_what_cannot_be_asked_for_is_refused(
    ask: Callable[[Node], object], error: type[Exception], text: str, near: can.BusABC
) -> None:
    node = Node(rack(), "HOST", near, clock=SimulatedClock())
    with pytest.raises(error, match=text):
        ask(node)


class Name(str):
    """A class of its own for a name."""

    __slots__ = ()


def test_a_value_can_have_a_class_of_its_own(near: can.BusABC, far: can.BusABC) -> None:
    results = {"serial": (Name, lambda text: Name(text.text))}
    pair = Pair(near, far, transfers=Transfers(rack(), results))
    recorder = Recorder()
    pair.host.on(Name, recorder)
    pair.rack.provide(*split(rack().transfer("serial"), SERIAL))
    pending = pair.host.request("serial", Name)
    pair.run(1.0)
    assert pending.result(0) == "A1B2C3"
    assert type(recorder.seen[0]) is Name


class Own(Readings):
    """A class of its own for readings."""

    __slots__ = ()


def test_readings_of_a_class_of_their_own_are_told_as_readings_too(
    near: can.BusABC, far: can.BusABC
) -> None:
    def make(readings: Readings) -> Own:
        return Own({g: tuple(v.values()) for g, v in readings.items()}, readings.at)

    pair = Pair(near, far, transfers=Transfers(rack(), {"heats": (Own, make)}))
    own, any_readings = Recorder(), Recorder()
    pair.host.on(Own, own)
    pair.host.on(Readings, any_readings)
    pair.rack.set(*split(rack().transfer("heats"), {0: [1.0] * 4, 1: [2.0] * 3, 2: [3.0] * 2}))
    pair.run(0.3)
    assert own.seen
    assert own.seen == any_readings.seen


def test_a_transfer_that_does_not_fit_its_kind_is_passed_over_and_says_why(
    near: can.BusABC,
) -> None:
    model = project().protocol
    unfit = tuple(
        replace(each, kind=NumberedBlocks.name) if each.name == "name" else each
        for each in model.transfers
    )
    node = Node(typed_protocol(replace(model, transfers=unfit)), "HOST", near)
    assert node.missing("name").startswith("length: says nothing to the kind numbered_blocks")
    assert node.missing("key") == "no frame has arrived"
    with pytest.raises(TransferError, match="length: says nothing to the kind numbered_blocks"):
        node.request("name")


def test_the_python_of_the_document_prints_what_was_asked_for(
    open_bus: Callable[..., can.BusABC], capsys: pytest.CaptureFixture[str]
) -> None:
    text = DOCS.read_text("utf-8")
    snippet = text.split("```python\n")[1].split("```")[0]
    names: dict[str, Any] = {}
    exec(compile(snippet, str(DOCS), "exec"), names)
    names["watch"](rack(), open_bus(), open_bus())
    assert capsys.readouterr().out.splitlines()[-1] == "A1B2C3 2"
