"""Generated functions do what cantools' formats and the fields do, whatever is given."""

from __future__ import annotations

import random
from decimal import Decimal
from enum import IntEnum
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swapcan import PROTOCOL, Codec, EncodeError, SignalState
from swapcan._generated.codec import CODECS
from typedcan.wire.fields import Field
from typedcan.wire.message import Message

STRAIGHT, PLAIN = Codec(), Codec(accelerated=False)


class Foreign(IntEnum):
    """An enum of no signal."""

    ONE = 1


class Lying(int):
    """An int that says that it is a float."""

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        return float


ODD: st.SearchStrategy[object] = st.sampled_from(
    [
        *(None, True, False, "A", "AB", b"A", Foreign.ONE, Lying(1), Decimal(1), Fraction(1, 3)),
        *(1j, [], np.float64(1), np.int8(1), np.uint64(2**63), float("nan"), float("inf"), -0.0),
        10**400,
    ]
)


def values_of(field: Field) -> st.SearchStrategy[object]:
    low, high = field.minimum, field.maximum
    step = abs(field.factor)
    near = [low, high, low - step / 2, high + step / 2, low - step, high + step, high - step / 3]
    codes = [*field.labels, *field.states, 0, (1 << field.length) - 1, 1 << field.length, -1]
    return st.one_of(
        st.sampled_from([*near, *map(int, near), *map(float, codes), *codes]),
        st.sampled_from([*SignalState, *field.labels.values()]),
        st.floats(low, high),
        st.integers(int(low), int(high)),
        st.sampled_from([*getattr(field, "enum", SignalState)]),
        ODD,
    )


def outcome(codec: Codec, message: Message, *, counter: int | None, renew: bool) -> str:
    try:
        return codec.encode(message, counter=counter, renew=renew).hex()
    except EncodeError as error:
        return str(error)


def test_every_message_of_the_standard_has_them() -> None:
    assert [*CODECS] == [*PROTOCOL.messages]
    assert all(each.encode for each in CODECS.values())


@pytest.mark.parametrize("kind", PROTOCOL.messages, ids=lambda kind: kind.NAME)
def test_what_is_sent_or_refused_is_the_same(kind: type[Message]) -> None:
    chance = random.Random(kind.NAME)
    usual = PLAIN.decode(kind, chance.randbytes(kind.LENGTH), verify=False)

    @settings(max_examples=150)
    @given(
        changed=st.fixed_dictionaries(
            {}, optional={name: values_of(field) for name, field in kind.FIELDS.items()}
        ),
        counter=st.none() | st.integers(0, 255),
        renew=st.booleans(),
    )
    def same(changed: dict[str, object], counter: int | None, *, renew: bool) -> None:
        given_ = {name: getattr(usual, name) for name in kind.FIELDS} | changed
        message = kind(**given_)
        mine, plain = (
            outcome(codec, message, counter=counter, renew=renew) for codec in (STRAIGHT, PLAIN)
        )
        assert mine == plain

    same()


@pytest.mark.parametrize("kind", PROTOCOL.messages, ids=lambda kind: kind.NAME)
def test_what_is_received_is_the_same_to_the_type_of_each_value(kind: type[Message]) -> None:
    chance = random.Random(kind.NAME)
    for _ in range(300):
        data = chance.randbytes(kind.LENGTH)
        mine, plain = (codec.decode(kind, data, verify=False) for codec in (STRAIGHT, PLAIN))
        assert mine == plain
        assert type(mine) is type(plain) is kind
        assert repr(mine) == repr(plain)
        assert [*map(type, vars_of(mine))] == [*map(type, vars_of(plain))]


def vars_of(message: Message) -> list[object]:
    return [getattr(message, name) for name in message.FIELDS]
