"""A value of any type for a signal that is a float: the nearest float of its bits, or refused."""

from __future__ import annotations

import importlib
import math
import sys
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

import cantools
import pytest
from cantools.database.can import Database, Signal
from cantools.database.can import Message as CantoolsMessage
from fields.any_values import Near, any_value, tried
from fields.meant import real_number

from dbcspec.emit.foreign import foreign_artifacts
from swapcan import EncodeError
from typedcan.databases.dbc import read_dbc
from typedcan.wire.fields import FloatField
from typedcan.wire.packing import packer_of

LARGEST = {32: Fraction(2**128 - 2**104), 64: Fraction(2**1024 - 2**971)}
"""Of the floats of so many bits."""


@pytest.fixture(scope="module")
def stubs(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """The messages of a DBC with floats."""
    folder = tmp_path_factory.mktemp("floats")
    read = read_dbc(root / "tests" / "fixtures" / "dbc" / "floats.dbc")
    for name, data in foreign_artifacts(read, "of_floats").items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        yield importlib.import_module("of_floats.messages")
    for name in [name for name in sys.modules if name.split(".")[0] == "of_floats"]:
        del sys.modules[name]


@pytest.fixture(scope="module")
def dbc(root: Path) -> Database:
    read = cantools.database.load_file(root / "tests" / "fixtures" / "dbc" / "floats.dbc")
    assert isinstance(read, Database)
    return read


def expected(signal: Signal, limits: tuple[Fraction, Fraction], value: object) -> Any:
    """The exact raw number, None where there is none, and whether it has to be sent."""
    number, sure = real_number(value)
    if number is None:
        return None, False
    raw = (number - Fraction(str(signal.offset))) / Fraction(str(signal.scale))
    blur = abs(number) / 2**48
    low, high = limits
    if not low - blur <= number <= high + blur or abs(raw) > LARGEST[signal.length] * 2:
        return None, False
    inside = low + blur <= number <= high - blur and abs(raw) < LARGEST[signal.length]
    return raw, sure and inside


def in_frame(reader: CantoolsMessage, signal: Signal, message: Any) -> float:
    """What cantools finds in the frame, before scaling."""
    data = packer_of(message.MODEL).pack(message.to_raw())
    raw = reader.decode_simple(data, decode_choices=False, scaling=False)[signal.name]
    assert isinstance(raw, float)
    return raw


@pytest.mark.parametrize(
    ("name", "field", "near"),
    [
        ("Single", "latitude", Near(-90.0, 90.0, 0.001)),
        ("Double", "time", Near(-1e9, 1e9, 0.001)),
        ("Scaled", "pressure", Near(-100.0, 100.0, 0.001)),
        ("Scaled", "pressure", Near(-3.3e35, 3.5e35, 1e33)),
        ("Double", "time", Near(-8e307, 8e307, 1e300)),
    ],
)
def test_a_value_is_sent_as_the_nearest_float_or_refused(
    stubs: Any, dbc: Database, name: str, field: str, near: Near
) -> None:
    kind, reader = getattr(stubs, name), dbc.get_message_by_name(name)
    signal = reader.get_signal_by_name(kind.FIELDS[field].dbc_name)
    assert type(kind.FIELDS[field]) is FloatField
    limits = LARGEST[signal.length].__neg__(), LARGEST[signal.length]
    if signal.minimum and signal.maximum:
        limits = Fraction(signal.minimum), Fraction(signal.maximum)
    source, became = Random(name + field), Counter[type]()
    for _ in range(3000):
        value = any_value(source, near)
        raw, must = expected(signal, limits, value)
        message = kind(**{field: value})
        sent = tried(partial(in_frame, reader, signal, message))
        became[type(sent)] += 1
        if isinstance(sent, EncodeError):
            assert not must
            assert str(sent).isprintable()
        else:
            assert raw is not None
            assert math.isfinite(sent)
            bits = {32: 23, 64: 48}[signal.length]
            assert abs(Fraction(sent) - raw) <= abs(raw) / 2**bits + Fraction(1, 10**12)
    assert min(became[float], became[EncodeError]) > 500
