"""Generated classes of codes that act: what has to be given, and what is said of the rest."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from emit.acting_protocol import ACTS, MOVING, REPORTS
from emit.other_protocol import signal

from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.foreign import dbc_faults, foreign_artifacts
from typedcan.model.acting import ActingCodes
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Message, Protocol, Signal
from typedcan.wire.message import Message as TypedMessage


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files of the protocol, as for somebody else's."""
    folder = tmp_path_factory.mktemp("acting")
    for name, data in foreign_artifacts(MOVING, "moving").items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    return folder


@pytest.fixture
def messages(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """The generated classes."""
    monkeypatch.syspath_prepend(str(folder))
    yield importlib.import_module("moving.messages")
    for name in [name for name in sys.modules if name.split(".")[0] == "moving"]:
        del sys.modules[name]


def test_a_field_that_would_act_has_to_be_given_and_no_other(messages: ModuleType) -> None:
    with pytest.raises(TypeError, match="heater"):
        messages.Acts(pump=0, fan=0, lamp=0)
    message = messages.Acts(heater=1)
    assert message.to_raw() == {"Heater": 1, "Pump": 2, "Fan": 0, "Lamp": 0}


def test_a_field_knows_what_acts(messages: ModuleType) -> None:
    kinds: list[type[TypedMessage]] = [messages.Acts, messages.Reports]
    known = {
        (kind.NAME, part.dbc_name): (set(part.acting.codes), part.acting.safe, part.acting.reports)
        for kind in kinds
        for part in kind.FIELDS.values()
        if part.acting
    }
    assert known == {
        ("Acts", "Heater"): ({0}, 1, False),
        ("Acts", "Pump"): ({-1, 1}, 0, False),
        ("Acts", "Fan"): ({*range(1, 26)}, 0, False),
        ("Reports", "Heater"): ({0}, 1, True),
    }


def test_a_class_says_what_its_fields_state_and_which_have_to_be_given(
    messages: ModuleType,
) -> None:
    text = " ".join((messages.Acts.__doc__ or "").split())
    assert "Fields that are not given say: Step a, Dark. Must be given: heater." in text
    assert "Step a" in (messages.Reports.__doc__ or "")
    assert "Invalid" not in text


def test_a_field_says_what_acts_and_what_it_states_if_it_is_not_given(
    messages: ModuleType,
) -> None:
    source = inspect.getsource(messages)
    texts = [" ".join(part.split()) for part in source.split('"""')]
    by_signal = {
        name: next(text for text in texts if text.startswith(f"{name}: ") and f". {name}" in text)
        for name in ("Heater", "Pump", "Fan", "Lamp")
    }
    acts = "Makes the receiver act: On; safe is Off. It has to be given"
    assert acts in by_signal["Heater"]
    assert by_signal["Pump"].endswith("Makes the receiver act: Backwards, On; safe is Off.")
    assert by_signal["Fan"].endswith("safe is Step a. If not given: Step a.")
    assert by_signal["Lamp"].endswith("Lamp. If not given: Dark.")
    assert sum("Says that something is on: On; safe is Off" in text for text in texts) == 1


def many_acting() -> Protocol:
    """A signal for each number of codes and each length of the last one, so of lines as well."""
    acts = [
        ActingCodes(codes=(*range(1, count), 10**digits), safe=0, reports=reports)
        for count in range(1, 26)
        for digits in range(2, 7)
        for reports in (False, True)
    ]
    messages = tuple(
        Message(
            name=f"M{number}",
            frame_id=number,
            length=8,
            sender="ECU",
            signals=(signal("Many", 0, 32, acting=each),),
        )
        for number, each in enumerate(acts)
    )
    return Protocol(name="many", messages=messages)


def test_any_number_of_codes_is_written_as_the_formatter_wants_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    protocol = many_acting()
    for name, data in foreign_artifacts(protocol, "manyacts").items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(data)
    command = ("ruff", "format", "--check", "--isolated", "--line-length=100", "--no-cache")
    done = subprocess.run(
        [sys.executable, "-m", *command, str(tmp_path / "manyacts")],
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    monkeypatch.syspath_prepend(str(tmp_path))
    kinds = importlib.import_module("manyacts.messages").MESSAGES
    for name in [name for name in sys.modules if name.split(".")[0] == "manyacts"]:
        del sys.modules[name]
    for kind, (_, each) in zip(kinds, protocol.signals(), strict=True):
        known = kind.FIELDS["many"].acting
        assert each.acting
        assert known == each.acting
        assert known.safe == 0


def test_a_start_value_that_acts_gets_into_no_file_and_no_default() -> None:
    heater, *others = ACTS.signals
    bad = dataclasses.replace(heater, start_value=0)
    message = dataclasses.replace(ACTS, signals=(bad, *others))
    protocol = dataclasses.replace(MOVING, messages=(message, REPORTS))
    assert dbc_faults(protocol) == ["Acts: Heater starts with 0, which acts"]
    with pytest.raises(ReadError, match="Heater starts with 0"):
        foreign_artifacts(protocol, "moving")


@pytest.mark.parametrize(
    ("values", "needed"),
    [
        ({"invalid_code": None, "start_value": 1}, True),
        ({"invalid_code": 3, "start_value": 3}, False),
        ({"invalid_code": 0, "start_value": 1}, True),
        ({"invalid_code": 3, "start_value": 0}, True),
        ({"acting": None, "start_value": 0}, False),
    ],
)
def test_what_no_value_or_the_start_value_would_do_has_to_be_given(
    values: dict[str, Any],
    needed: bool,  # noqa: FBT001 - a column of the table
) -> None:
    heater: Signal = dataclasses.replace(ACTS.signals[0], **values)
    assert heater.must_be_given is needed


def test_a_file_has_the_start_value_of_every_signal() -> None:
    lines = [line for line in emit_dbc(MOVING).splitlines() if "StartValue" in line]
    assert lines[2:] == [
        'BA_ "GenSigStartValue" SG_ 2566848513 Heater 1;',
        'BA_ "GenSigStartValue" SG_ 2566848513 Pump 2;',
        'BA_ "GenSigStartValue" SG_ 2566848513 Fan 0;',
        'BA_ "GenSigStartValue" SG_ 2566848513 Lamp 0;',
        'BA_ "GenSigStartValue" SG_ 2566848514 Heater 1;',
        'BA_ "GenSigStartValue" SG_ 2566848514 Fan 0;',
    ]


def test_a_protocol_that_says_nothing_of_start_values_gets_none() -> None:
    silent = dataclasses.replace(MOVING, carries=frozenset())
    assert "StartValue" not in emit_dbc(silent)
