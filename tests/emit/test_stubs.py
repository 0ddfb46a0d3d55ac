"""The generated Python: what tools say of it, what it says to people, and that it works."""

from __future__ import annotations

import importlib
import os
import re
import subprocess
import sys
import typing
from collections.abc import Iterator
from enum import IntEnum
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

import cantools
import pytest
from cantools.database.can import Database
from emit.other_protocol import OTHER, PLAIN

from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.stubs import emit_stubs
from swapcan import SignalState
from swapcan import messages as m
from swapcan.messages import MESSAGES
from typedcan.model.code_types import Code2, Code5
from typedcan.model.protocol import Protocol, ValueTable
from typedcan.wire.codec import Codec
from typedcan.wire.packing import packer_of

PACKAGES = {"othercar": OTHER, "plaincar": PLAIN}


@pytest.fixture(scope="module")
def others(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a package per made-up protocol."""
    folder = tmp_path_factory.mktemp("stubs")
    for name, protocol in PACKAGES.items():
        generated = folder / name / "_generated"
        generated.mkdir(parents=True)
        (folder / name / "__init__.py").touch()
        for file, text in emit_stubs(protocol).items():
            (generated / file).write_text(text, "utf-8")
    return folder


@pytest.fixture
def other(others: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """The first made-up protocol, imported."""
    monkeypatch.syspath_prepend(str(others))
    yield importlib.import_module("othercar._generated.protocol")
    for name in [name for name in sys.modules if name.split(".")[0] in PACKAGES]:
        del sys.modules[name]


def run(*arguments: str, path: str = "") -> None:
    """Run a tool of this environment, which must have nothing to say."""
    result = subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "MYPYPATH": path},
    )
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_formatter_changes_nothing(root: Path, others: Path) -> None:
    generated = root / "src" / "swapcan" / "_generated"
    run(
        "ruff", "format", "--check", "--isolated", "--line-length=100", "--no-cache", str(generated)
    )
    for name in PACKAGES:
        folder = str(others / name / "_generated")
        run("ruff", "format", "--check", "--isolated", "--line-length=100", "--no-cache", folder)


def test_mypy_in_strict_mode_finds_nothing(root: Path, others: Path, tmp_path: Path) -> None:
    packages = [f"--package={name}._generated" for name in ("swapcan", *PACKAGES)]
    path = os.pathsep.join((str(root / "src"), str(others)))
    run("mypy", "--strict", "--config-file=", f"--cache-dir={tmp_path}", *packages, path=path)


def test_pyright_finds_nothing(root: Path, others: Path) -> None:
    (others / "pyrightconfig.json").write_text(f'{{"extraPaths": ["{(root / "src").as_posix()}"]}}')
    python = f"--pythonpath={sys.executable}"
    run("pyright", python, f"--project={others}")
    run("pyright", python, str(root / "src" / "swapcan" / "_generated"))


def test_signals_with_equal_codes_share_one_enum(protocol: Protocol) -> None:
    enums: dict[ValueTable | None, set[str]] = {}
    for message, signal in protocol.signals():
        for part in typing.get_args(hints(message.name)[signal.python_name]):
            if isinstance(part, type) and issubclass(part, IntEnum):
                enums.setdefault(signal.value_table, set()).add(part.__name__)
    assert {table.name for table in enums if table} == {name for (name,) in enums.values()}
    assert typing.get_type_hints(m.B2V_ST0)["st_main_pos"] == m.RelayState | Code2
    assert typing.get_type_hints(m.V2B_CMD)["att_con_st1"] == m.RelayState | Code2


def hints(message: str) -> dict[str, object]:
    return typing.get_type_hints(getattr(m, message))


def test_the_members_of_an_enum_are_the_codes_of_the_table(protocol: Protocol) -> None:
    for table in protocol.value_tables:
        if hasattr(m, table.name):
            members = {member.value for member in getattr(m, table.name)}
            assert members == {code.value for code in table.codes}


@pytest.mark.parametrize(
    ("message", "field", "kind"),
    [
        (m.B2V_ST2, "soc", float | SignalState),
        (m.V2B_CMD, "vehicle_speed", float),
        (m.B2V_ST4, "max_temp", float | SignalState),
        (m.B2V_ST1, "chg_st", m.ChargeState | Literal[0, 1, 2, 3]),
        (m.B2V_ST0, "flt_main_pos_relay_weld", m.FaultFlag | Literal[0, 1]),
        (m.B2V_SysCode1, "sys_code_length", m.PackCodeLength | Code5),
        (m.V2B_VIN, "b1_8_15", str | int),
        (m.B2V_SysCode4, "sys_code_b27", str | int),
        (m.V2B_VIN, "frame_no", int),
        (m.B2V_Ucell, "frame_no", int),
        (m.B2V_ST5, "max_ucell_csc_no", int | SignalState),
        (m.B2V_ST5, "max_ucell_position", int),
        (m.B2V_ST4, "max_temp_position", int),
        (m.B2V_ST0, "battery_fault_no", int),
        (m.B2V_ST1, "checksum", int | None),
        (m.B2V_ST1, "aliv", int | SignalState | None),
        (m.BMS_TMS_0, "life", int | None),
    ],
)
def test_a_field_has_the_type_that_its_signal_needs(
    message: type, field: str, kind: object
) -> None:
    assert typing.get_type_hints(message)[field] == kind


def test_the_text_of_a_message_has_title_identifier_route_and_tables(protocol: Protocol) -> None:
    for kind in MESSAGES:
        message = protocol.message(kind.NAME)
        text = " ".join((kind.__doc__ or "").split())
        for part in (message.english, message.title, f"0x{message.frame_id:08X}", message.sender):
            assert part in text
        assert message.reference in text
        assert all(receiver in text for receiver in message.receivers)


def test_the_text_of_a_field_has_title_range_name_and_table_row(
    root: Path, protocol: Protocol
) -> None:
    source = (root / "src" / "swapcan" / "_generated" / "messages.py").read_text("utf-8")
    texts = re.findall(
        r'^    ([a-z]\w*): [^"]*?\n    """(.*?)"""', source, re.MULTILINE | re.DOTALL
    )
    assert len(texts) == sum(1 for _ in protocol.signals())
    flat = {(field, " ".join(text.split())) for field, text in texts}
    for _, signal in protocol.signals():
        (text,) = (
            text
            for field, text in flat
            if field == signal.python_name and f" {signal.name}, {signal.reference}." in text
        )
        assert text.startswith(signal.english)
        assert signal.title in text
        assert f"{signal.minimum:f} to {signal.maximum:f} {signal.unit}".rstrip() in text


def test_a_label_in_another_language_stands_beside_its_member(root: Path) -> None:
    source = (root / "src" / "swapcan" / "_generated" / "enums.py").read_text("utf-8")
    assert '    SELF_CIRCULATION = 3\n    """自循环"""' in source


@pytest.mark.parametrize("accelerated", [True, False])
def test_what_another_protocol_decodes_agrees_with_another_reader(
    other: ModuleType, *, accelerated: bool
) -> None:
    dbc = cantools.database.load_string(emit_dbc(OTHER), "dbc")
    assert isinstance(dbc, Database)
    codec = Codec(other.PROTOCOL, accelerated=accelerated)
    for payload, expected in (
        ("FF F3 07 60 EA 5A 02 09", (-2.5625, 1.5, 7, 60000, "Z", 2, 9)),
        ("80 0F 01 02 00 FF 03 FF", (-130.5, 7.5, 1, 2, SignalState.INVALID, 3, 255)),
        # A code of a measured value is a value all the same.
        ("7F F0 00 01 00 42 00 00", (125.4375, 0.0, 0, 1, 66, 0, 0)),
    ):
        wheels = other.PROTOCOL.message("Wheels")
        decoded: Any = codec.decode(wheels, bytes.fromhex(payload))
        assert isinstance(decoded, wheels)
        assert tuple(getattr(decoded, name) for name in wheels.FIELDS) == expected
        assert (type(decoded.level), type(decoded.slot)) == (float, int)
    assert (decoded.text.name, decoded.gear.name) == ("ONE", "NEUTRAL")


def test_the_messages_of_another_protocol_give_the_bytes_worked_out_by_hand(
    other: ModuleType,
) -> None:
    dbc = cantools.database.load_string(emit_dbc(OTHER), "dbc")
    assert isinstance(dbc, Database)
    kinds = {kind.NAME: kind for kind in other.PROTOCOL.messages}

    def payload(name: str, **values: object) -> str:
        packer = packer_of(kinds[name].MODEL)
        return packer.pack(kinds[name](**values).to_raw()).hex(" ").upper()

    # (-2.5625 + 2.5) / 0.0625 = -1 = FFF; the gear starts at its start value 7.
    # 3.5 / 0.5 = 7 in the lower half of byte 1.
    wheels = payload("Wheels", wheel_speed=-2.5625, level=3.5, letter="A")
    assert wheels == "FF F7 07 00 00 41 00 00"
    # 0 + 2.5 = 40 x 0.0625 = 028; the letter has an invalid code.
    assert payload("Wheels", wheel_speed=0.0, text=60000) == "02 80 07 60 EA FF 00 00"
    assert payload("A_Message_With_A_Rather_Long_Nam") == "FF FF 00 00 00 00 00 00"
    assert payload("Hello") == "00 00"
