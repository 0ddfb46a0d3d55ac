"""Protocols that Hypothesis builds, and every way to change a model in one place."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from decimal import Decimal
from enum import Enum
from typing import Any

from hypothesis import strategies as st

from typedcan.model.acting import ActingCodes
from typedcan.model.extras import (
    Attribute,
    AttributeDefinition,
    EnvironmentVariable,
    Relation,
    SignalGroup,
)
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import (
    Bus,
    ByteOrder,
    Code,
    Erratum,
    Message,
    Node,
    Protocol,
    Request,
    SendType,
    Signal,
    ValueTable,
)
from typedcan.model.transfer import Counted, Ending, Numbering, Transfer

NOT_COMPARED = {
    "Protocol.name": "what a file is called is no promise",
    "Protocol.value_tables": "a value table is spoken of where a signal has it",
    "Protocol.carries": "tells what may be compared",
}

NODES = ("ECU", "HMI", "LOG")
texts = st.sampled_from(["", "one", "two", "eins"])
short_bytes = st.lists(st.integers(0, 255), max_size=3).map(tuple)
marks = st.sampled_from([(), ("E1",), ("E1", "E2")])
numbers = st.integers(-50, 50).map(Decimal)
codes = st.lists(st.integers(0, 20), min_size=1, max_size=4, unique=True).flatmap(
    lambda values: st.tuples(
        *(st.builds(Code, st.just(2 * value), texts, texts) for value in sorted(values))
    )
)
tables = st.builds(ValueTable, st.sampled_from(["State", "Mode"]), codes)
acting = st.builds(
    ActingCodes,
    codes=st.sampled_from([(1,), (1, 2)]),
    safe=st.sampled_from([0, 3]),
    reports=st.booleans(),
    reference=texts,
)
attributes = st.sampled_from([(), (Attribute("SPN", "1"),), (Attribute("SPN", "2"),)])
node_lists = st.lists(st.sampled_from(NODES), max_size=3, unique=True).map(tuple)


def signals(name: str) -> st.SearchStrategy[Signal]:
    """A signal of more than one byte: within one byte both byte orders may be the same wire."""
    return st.builds(
        Signal,
        name=st.just(name),
        title=texts,
        english=texts,
        start=st.integers(0, 40),
        length=st.integers(9, 16),
        byte_order=st.sampled_from(ByteOrder),
        signed=st.booleans(),
        is_float=st.booleans(),
        factor=numbers.filter(bool),
        offset=numbers,
        minimum=numbers,
        maximum=numbers,
        unit=texts,
        value_table=st.none() | tables,
        invalid_code=st.none() | st.integers(0, 40),
        other_invalid_codes=st.just(()) | st.tuples(st.integers(41, 50)),
        abnormal_code=st.none() | st.integers(0, 40),
        start_value=st.integers(0, 40),
        acting=st.none() | acting,
        receivers=node_lists,
        is_selector=st.booleans(),
        multiplexer=texts,
        selectors=st.sampled_from([(), (1,), (1, 2)]),
        python_name=texts,
        reference=texts,
        errata=marks,
        attributes=attributes,
    )


def messages(number: int) -> st.SearchStrategy[Message]:
    """A message of up to three signals."""
    names = [f"M{number}_{letter}" for letter in "ABC"]
    carriers = st.sampled_from(names)
    return st.builds(
        Message,
        name=st.just(f"M{number}"),
        # Every model is in two languages, as every spec is.
        title=st.just("eins"),
        english=st.just("one"),
        frame_id=st.just(16 * number),
        extended=st.booleans(),
        length=st.integers(0, 8),
        is_fd=st.booleans(),
        bit_rate_switch=st.booleans(),
        by_pgn=st.booleans(),
        sender=st.sampled_from(NODES),
        other_senders=st.sampled_from([(), ("CC",), ("CC", "DD")]),
        period=st.none() | st.integers(1, 100),
        send_type=st.sampled_from(SendType),
        condition=texts,
        signals=st.integers(0, 3).flatmap(lambda count: st.tuples(*map(signals, names[:count]))),
        checksum=st.none()
        | st.builds(
            Checksum,
            signal=carriers,
            algorithm=texts,
            covered=st.permutations(range(8)).map(tuple),
            before=short_bytes,
            after=short_bytes,
            data_ids=short_bytes,
            is_open=st.booleans(),
        ),
        counter=st.none()
        | st.builds(
            Counter,
            signal=carriers,
            modulus=st.integers(1, 16),
            first=st.integers(0, 3),
            step=st.integers(1, 3),
        ),
        reference=texts,
        errata=marks,
        groups=st.just(()) | st.tuples(groups),
        attributes=attributes,
        relations=st.just(()) | st.tuples(relations),
    )


groups = st.builds(
    SignalGroup,
    name=st.just("G"),
    repetitions=st.integers(1, 2),
    signals=st.sampled_from([("A",), ("A", "B")]),
)
relations = st.builds(Relation, name=texts, node=st.sampled_from(NODES), value=texts, signal=texts)


def nodes(name: str) -> st.SearchStrategy[Node]:
    """A node of that name."""
    return st.builds(
        Node,
        name=st.just(name),
        title=texts,
        english=texts,
        address=st.none() | st.integers(0, 255),
        other_addresses=st.sampled_from([(), (1,), (1, 2)]),
        errata=marks,
        attributes=attributes,
    )


amounts = st.none() | st.integers(0, 9)
transfers = st.builds(
    Transfer,
    name=st.just("text"),
    english=texts,
    kind=texts,
    messages=st.sampled_from([("M1",), ("M1", "M2")]),
    items=st.sampled_from([(), ("M1_A",), ("M1_A", "M1_B")]),
    frame_number=texts,
    first_number=st.integers(0, 1),
    numbering=st.sampled_from(Numbering),
    group=texts,
    first_group=st.integers(0, 1),
    groups=amounts,
    groups_signal=texts,
    count=amounts,
    count_signal=texts,
    counted=st.sampled_from(Counted),
    counts=st.sampled_from([(), (1,), (1, 2)]),
    length=st.sampled_from(Ending),
    length_signal=texts,
    fill=amounts,
    encoding=texts,
    details=st.sampled_from([(), ("M1_A",), ("M1_A", "M1_B")]),
    period=amounts,
    timeout=st.none() | st.decimals(0, 9, places=1),
    rounds=amounts,
    table=texts,
    column=texts,
)
requests = st.builds(
    Request,
    signal=st.just("M1_A"),
    code=st.integers(0, 3),
    withdraw=st.none() | st.integers(0, 3),
    answers=st.sampled_from([("M2",), ("M2", "M3")]),
)
errata = st.builds(
    Erratum,
    id=st.just("E1"),
    kind=texts,
    place=texts,
    printed=texts,
    reading=texts,
    because=texts,
)
buses = st.builds(
    Bus,
    name=st.just("body"),
    title=texts,
    english=texts,
    bit_rate=st.integers(1, 9),
    nodes=node_lists,
    errata=marks,
)
protocols = st.builds(
    Protocol,
    name=st.just("model"),
    number=texts,
    title=texts,
    english=texts,
    edition=texts,
    nodes=st.integers(0, 3).flatmap(lambda count: st.tuples(*map(nodes, NODES[:count]))),
    buses=st.just(()) | st.tuples(buses),
    messages=st.integers(2, 3).flatmap(
        lambda count: st.tuples(*map(messages, range(1, count + 1)))
    ),
    transfers=st.just(()) | st.tuples(transfers),
    requests=st.just(()) | st.tuples(requests),
    errata=st.just(()) | st.tuples(errata),
    version=texts,
    attributes=attributes,
    definitions=st.just(())
    | st.tuples(
        st.builds(AttributeDefinition, st.just("SPN"), st.just("SG_"), texts, st.none() | texts)
    ),
    variables=st.just(())
    | st.tuples(
        st.builds(
            EnvironmentVariable,
            name=st.just("V"),
            kind=st.integers(0, 2),
            minimum=texts,
            initial=texts,
            nodes=node_lists,
            size=st.none() | st.integers(1, 9),
            codes=st.just(()) | st.tuples(st.tuples(st.integers(0, 3), texts)),
            attributes=attributes,
        )
    ),
)


def mutations(value: Any, place: str = "") -> Iterator[tuple[str, Any]]:
    """Every change in one place below a value: the name of the place and the changed whole."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        for part in dataclasses.fields(value):
            name = f"{type(value).__name__}.{part.name}"
            if part.compare and name not in NOT_COMPARED:
                for where, changed in mutations(getattr(value, part.name), name):
                    yield where, dataclasses.replace(value, **{part.name: changed})
        return
    if isinstance(value, tuple):
        yield from _tuple_mutations(value, place)
        return
    yield from ((place, changed) for changed in _others(value, place))


def _tuple_mutations(value: tuple[Any, ...], place: str) -> Iterator[tuple[str, Any]]:
    if value:
        yield f"{place} without its last", value[:-1]
    ordered = (
        *("ValueTable.codes", "Signal.selectors", "Request.answers", "ActingCodes.codes"),
        "SignalGroup.signals",
    )
    if len(value) > 1 and place not in ordered:
        yield f"{place} reversed", value[::-1]
    for index, item in enumerate(value):
        for where, changed in mutations(item, place):
            yield where, (*value[:index], changed, *value[index + 1 :])


def _others(value: Any, place: str) -> list[Any]:
    """Values that might stand in place of a single one."""
    if place in ("Signal.value_table", "Signal.acting", "Message.checksum", "Message.counter"):
        return []
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, Enum):
        return [other for other in type(value) if other is not value]
    if isinstance(value, int):
        return [value + 1]
    if isinstance(value, Decimal):
        return [value + 1 if value != -1 else Decimal(5)]
    return [f"{value}z"] if isinstance(value, str) else [77]
