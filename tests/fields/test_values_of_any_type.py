"""A value of any type is sent as what it means, as cantools reads the frame, or is an EncodeError.

The bulk of the values comes from a generator with a fixed seed, ten times as fast as Hypothesis,
which looks for what that has not thought of.
"""

from __future__ import annotations

import typing
from collections import Counter
from collections.abc import Callable
from enum import IntEnum
from functools import cache, partial
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import cantools
import pytest
from cantools.database.can import Database
from fields.any_values import FAR, HOSTILE, ODD, Near, any_value, tried
from fields.meant import meant
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy

import swapcan
from swapcan import EncodeError, Message
from swapcan import messages as m
from typedcan.wire.fields import Field

KINDS = ["PhysicalField", "NumberField", "LabelledField", "CharacterField", "FilledField"]
DBC = Path(__file__).parent.parent.parent / "dbc" / "caamtb-swap.dbc"
GIVEN: dict[type[Message], dict[str, Any]] = {
    m.B2C_Charger: {"charge_control": m.ChargeControl.NORMAL_STOP_TO_CHARGE},
    m.BMS_TMS_0: {"reqst_tms_hv_on": m.HvRequest.REQUEST_HV_OFF},
    m.C2B_ACStatus: {
        "charger_start": m.ChargerOperation.OFF_IN_ORDER_TO_PREVENT_BATTERY_REVERSE_CONNECTION
    },
}
"""What has to be given."""


class Bench:
    """A field, and what judges the frames that carry values for it."""

    def __init__(self, message: type[Message], field: Field) -> None:
        self.message, self.field = message, field
        self.kind = type(field).__name__
        self.reader = database().get_message_by_name(message.NAME)
        self.signal = self.reader.get_signal_by_name(field.dbc_name)
        hint = typing.get_type_hints(message)[field.name]
        enums = [part for part in typing.get_args(hint) if isinstance(part, type)]
        self.own = next((part for part in enums if issubclass(part, IntEnum)), None)
        low, high = self.signal.minimum, self.signal.maximum
        self.near = Near(float(low or 0), float(high or 0), float(self.signal.scale))
        self.plain = self._others(swapcan.encode(message(**GIVEN.get(message, {}))))

    def _others(self, data: bytes) -> dict[str, object]:
        """The raw values of all signals but this one and the checksum."""
        raw: dict[str, object] = dict(
            self.reader.decode_simple(data, decode_choices=False, scaling=False)
        )
        raw.pop(self.field.dbc_name)
        if self.message.CHECKSUM:
            raw.pop(self.message.CHECKSUM.signal, None)
        return raw

    def judge(self, value: object) -> str:
        """Send a value, and say what became of it."""
        expected = meant(self.kind, self.signal, self.own, value)
        filled_in = self.kind == "FilledField" and value is None
        message = self.message(**{**GIVEN.get(self.message, {}), self.field.name: value})
        sent = tried(lambda: swapcan.encode(message))
        if isinstance(sent, EncodeError):
            assert not expected.must
            assert not filled_in
            assert (sent.message, sent.field) == (self.message.NAME, self.field.name)
            assert sent.value is value
            assert str(sent).isprintable()
            assert len(str(sent)) < 250
            return "refused"
        raw = self.reader.decode_simple(sent, decode_choices=False, scaling=False)
        assert filled_in or raw[self.field.dbc_name] in expected.raws
        assert self._others(sent) == self.plain
        return "sent"


@cache
def database() -> Database:
    read = cantools.database.load_file(DBC)
    assert isinstance(read, Database)
    return read


@cache
def benches(kind: str) -> list[Bench]:
    """The fields of a kind."""
    every = [(message, field) for message in m.MESSAGES for field in message.FIELDS.values()]
    return [Bench(message, field) for message, field in every if type(field).__name__ == kind]


@pytest.mark.parametrize("kind", KINDS)
def test_ten_thousand_values_into_each_kind_of_field_are_sent_right_or_refused(kind: str) -> None:
    source, became = Random(kind), Counter[str]()
    for _ in range(10_000):
        bench = source.choice(benches(kind))
        became[bench.judge(any_value(source, bench.near))] += 1
    assert min(became["sent"], became["refused"]) > 500


def test_a_hundred_values_into_every_field_are_sent_right_or_refused() -> None:
    every = [bench for kind in KINDS for bench in benches(kind)]
    assert len(every) == 211
    for bench in every:
        source = Random(bench.field.dbc_name)
        for _ in range(100):
            bench.judge(any_value(source, bench.near))


def _same(value: object) -> object:
    return value


LISTED: list[Callable[[], object]] = [*HOSTILE, *(partial(_same, one) for one in (*ODD, *FAR))]


class Listed(NamedTuple):
    """The place of a value that Hypothesis itself could not look at."""

    place: int


ANYTHING = st.one_of(
    st.integers(),
    st.integers(-5, 300),
    st.floats(),
    st.floats(width=16),
    st.decimals(),
    st.fractions(),
    st.complex_numbers(),
    st.characters(),
    st.text(),
    st.binary(),
    st.datetimes(),
    st.timedeltas(),
    st.builds(Listed, st.integers(0, len(LISTED) - 1)),
    st.recursive(
        st.none() | st.booleans() | st.integers(),
        lambda inner: st.lists(inner) | st.tuples(inner) | st.dictionaries(st.text(), inner),
    ),
    st_numpy.scalar_dtypes().flatmap(
        lambda kind: st_numpy.arrays(kind, ()).map(lambda one: one[()])
    ),
    st_numpy.arrays(st_numpy.scalar_dtypes(), st_numpy.array_shapes(min_dims=0, max_side=3)),
)


@pytest.mark.parametrize("kind", KINDS)
def test_values_that_hypothesis_finds_are_sent_right_or_refused(kind: str) -> None:
    @settings(max_examples=400)
    @given(bench=st.sampled_from(benches(kind)), value=ANYTHING)
    def right_or_refused(bench: Bench, value: object) -> None:
        bench.judge(LISTED[value.place]() if type(value) is Listed else value)

    right_or_refused()
