"""All transfers of a node through one door."""

from __future__ import annotations

import math
import random
import sys

from hypothesis import given
from hypothesis import strategies as st
from transfer.wire import delivered, totals

from swapcan import decode
from swapcan._generated.protocol import PROTOCOL
from swapcan.transfer import (
    CellVoltages,
    PackCode,
    ProbeTemperatures,
    Problem,
    Transfers,
    Vin,
    split_cell_voltages,
    split_pack_code,
    split_probe_temperatures,
    split_vin,
)
from typedcan.wire.message import Message

CELLS = {1: [3.1, 3.2], 2: [3.3]}
PROBES = {1: [20.0], 2: [21.0]}


def messages() -> list[Message]:
    return [
        totals(CELLS, PROBES),
        *split_vin("1M8GDM9AXKP042788"),
        *split_pack_code("ABC", 1),
        *split_cell_voltages(CELLS),
        *split_probe_temperatures(PROBES),
        *split_pack_code("ABC", 1),
    ]


def test_every_transfer_comes_out_of_one_stream() -> None:
    transfers = Transfers(PROTOCOL)
    outcomes = [each for message in delivered(messages()) for each in transfers.take(message, 0.0)]
    vin, cells, probes, code = outcomes
    assert vin == Vin("1M8GDM9AXKP042788")
    assert isinstance(cells, CellVoltages)
    assert isinstance(probes, ProbeTemperatures)
    assert probes == {1: {1: 20.0}, 2: {1: 21.0}}
    assert code == PackCode("ABC", 1)


def test_the_next_deadline_is_the_earliest_and_expires() -> None:
    transfers = Transfers(PROTOCOL)
    assert transfers.next_deadline == math.inf
    transfers.take(totals(CELLS, PROBES), 0.0)
    transfers.take(split_pack_code("ABC")[0], 1.0)
    transfers.take(split_vin("1M8GDM9AXKP042788")[0], 1.5)
    transfers.take(split_probe_temperatures(PROBES)[0], 2.3)
    seen: list[tuple[float, str]] = []
    while (now := transfers.next_deadline) < 3.1:
        seen += [(now, problem.transfer) for problem in transfers.expire(now)]
    assert seen == [(2.5, "vin"), (2.3 + 0.3, "probe_temperatures"), (3.0, "pack_code")]


def test_waiting_for_each_deadline_comes_to_an_end() -> None:
    transfers = Transfers(PROTOCOL)
    for message in messages()[:-2]:
        transfers.take(message, 0.1)
    waits = 0
    while (now := transfers.next_deadline) < math.inf:
        transfers.expire(now)
        waits += 1
    assert waits < 10


def test_what_is_missing_is_told_by_the_name_of_the_transfer() -> None:
    transfers = Transfers(PROTOCOL)
    transfers.take(split_vin("1M8GDM9AXKP042788")[1], 0.0)
    assert transfers.missing("vin") == "frames 1, 3 of 3 are missing"
    assert transfers.missing("pack_code") == "no frame has arrived"
    assert transfers.missing("cell_voltages") == "B2V_BattInfo2 with the totals is missing"


def test_the_check_of_the_vin_is_made_on_request() -> None:
    transfers = Transfers(PROTOCOL, check_vin=True)
    outcomes = [o for m in split_vin("1M8GDM9A1KP042788") for o in transfers.take(m, 0.0)]
    assert [each.kind for each in outcomes if isinstance(each, Problem)] == ["check"]


KINDS = sorted(
    {message for transfer in PROTOCOL.transfers for message in transfer.messages},
    key=lambda message: message.NAME,
)


@given(
    st.lists(st.tuples(st.sampled_from(KINDS), st.binary(min_size=8, max_size=8)), max_size=60),
    st.binary(min_size=8, max_size=8),
)
def test_whatever_bytes_arrive_nothing_is_raised(
    frames: list[tuple[type[Message], bytes]], info: bytes
) -> None:
    transfers = Transfers(PROTOCOL)
    transfers.take(decode(PROTOCOL.message("B2V_BattInfo2").FRAME_ID, info), 0.0)
    for n, (kind, data) in enumerate(frames):
        transfers.take(decode(kind.FRAME_ID, data, verify=False), n * 0.1)
        transfers.expire(n * 0.1 + 0.05)


def size_of(thing: object, seen: set[int]) -> int:
    """Bytes of an object and all that it holds."""
    if id(thing) in seen or isinstance(thing, type) or callable(thing):
        return 0
    seen.add(id(thing))
    parts: list[object] = []
    if isinstance(thing, dict):
        parts = [*thing.keys(), *thing.values()]
    elif isinstance(thing, (list, tuple, set, frozenset)):
        parts = list(thing)
    elif hasattr(thing, "__dict__"):
        parts = [vars(thing)]
    return sys.getsizeof(thing) + sum(size_of(part, seen) for part in parts)


def test_memory_does_not_grow_with_what_arrives() -> None:
    transfers = Transfers(PROTOCOL)
    transfers.take(totals({n: [3.0] * 12 for n in range(1, 19)}, PROBES), 0.0)
    dice = random.Random(1)
    sizes: list[int] = []
    for n in range(30_000):
        kind = dice.choice(KINDS)
        message = decode(kind.FRAME_ID, dice.randbytes(8), verify=False)
        transfers.take(message, n * 0.001)
        if n % 10_000 == 9_999:
            sizes.append(size_of(transfers, set()))
    assert max(sizes) < 400_000
    assert sizes[-1] < 1.2 * sizes[0]
