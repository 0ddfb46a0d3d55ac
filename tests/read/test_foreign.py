"""Files made of somebody else's DBC: Python that tools accept and that moves the right bits."""

from __future__ import annotations

import dataclasses
import importlib
import math
import os
import subprocess
import sys
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path

import cantools.database
import pytest
from cantools.database.can import Database
from cantools.database.can import Message as CantoolsMessage

from dbcspec.emit.foreign import dbc_faults, foreign_artifacts
from dbcspec.trial import try_package
from typedcan.databases.dbc import read_dbc
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Message, Protocol, Signal
from typedcan.wire.codec import Codec
from typedcan.wire.errors import EncodeError

FILES = sorted((Path(__file__).parent.parent / "fixtures" / "dbc").glob("*.dbc"))
NOT_FOR_CANTOOLS = {
    "overlapping",  # it encodes no overlaps
    "long_names",  # it loses signals whose selector has a long name
}
AWKWARD = """VERSION ""

BU_: A B
BO_ 1 Message: 8 A
 SG_ Int : 0|8@1- (1,0) [-128|127] "" B
 SG_ float : 8|8@1+ (1,0) [0|255] "" B
 SG_ to_raw : 16|8@1+ (1,0) [0|255] "" B
 SG_ class : 24|8@1+ (0.5,0) [0|127.5] "" B
 SG_ Mode : 32|8@1+ (1,0) [0|255] "" B
 SG_ mode : 40|8@1+ (1,0) [0|255] "" B
BO_ 2 Mode: 8 B
 SG_ x : 0|8@1+ (1,0) [0|255] "" A
BO_ 3 speed: 8 B
BO_ 4 Speed: 8 B
BO_ 5 SPEED: 8 B
BO_ 6 class: 8 B
CM_ SG_ 1 Int "ends with a quote: \\"x\\"";
VAL_ 1 Int -1 "Same" 0 "Other" 1 "Same" ;
VAL_ 1 Mode 0 "None" 1 "1st" ;
VAL_ 1 mode 0 "a" 1 "b" ;
VAL_ 2 x 0 "def" 1 "class" ;
"""


def package(path: Path) -> str:
    return f"foreign_{path.stem}"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A stub package for each file."""
    folder = tmp_path_factory.mktemp("foreign")
    (folder / "awkward.dbc").write_text(AWKWARD, "ascii")
    for path in (*FILES, folder / "awkward.dbc"):
        for name, data in foreign_artifacts(read_dbc(path), package(path)).items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_bytes(data)
    return folder


@pytest.fixture
def importable(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The packages on the path of this interpreter."""
    monkeypatch.syspath_prepend(str(folder))
    yield folder
    for name in [name for name in sys.modules if name.startswith("foreign_")]:
        del sys.modules[name]


def run(folder: Path, *arguments: str, **environment: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **environment},
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_formatter_changes_nothing(folder: Path) -> None:
    run(folder, "ruff", "format", "--check", "--isolated", "--line-length=100", "--no-cache", ".")


def test_mypy_in_strict_mode_finds_nothing(folder: Path, root: Path, tmp_path: Path) -> None:
    names = [f"--package={path.name}" for path in folder.iterdir() if path.is_dir()]
    options = ["--strict", "--config-file=", f"--cache-dir={tmp_path}"]
    run(folder, "mypy", *options, *names, MYPYPATH=str(root / "src"))


@pytest.mark.parametrize(
    "path",
    [path for path in FILES if path.stem not in NOT_FOR_CANTOOLS],
    ids=lambda path: path.stem,
)
@pytest.mark.parametrize("accelerated", [True, False])
def test_frames_that_cantools_makes_are_decoded_and_encoded_to_the_same(
    path: Path, importable: Path, *, accelerated: bool
) -> None:
    protocol = importlib.import_module(f"{package(path)}.protocol").PROTOCOL
    codec = Codec(protocol, accelerated=accelerated)
    kinds = {kind.NAME: kind for kind in protocol.messages}
    database = cantools.database.load_file(importable / f"{package(path)}.dbc", encoding="utf-8")
    assert isinstance(database, Database)
    for message in database.messages:
        for payload in payloads(message):
            raw = decoded(message, payload)
            if raw is None:
                continue
            typed = codec.decode(kinds[message.name], payload, verify=False)
            for field in type(typed).FIELDS.values():
                assert (getattr(typed, field.name) is None) == (field.dbc_name not in raw)
            # What the limits of the file exclude may be received, never sent.
            try:
                sent = typed.to_raw()
            except EncodeError:
                continue
            assert sent.keys() == raw.keys()
            for name, value in sent.items():
                near = pytest.approx(raw[name], rel=1e-6, abs=1e-9)
                exact = isinstance(value, int) and abs(raw[name]) < 2**53
                assert value == (raw[name] if exact else near)


def payloads(message: CantoolsMessage) -> Iterator[bytes]:
    """Each first byte and each first nibble, over other bytes that are all different."""
    for first in range(256):
        yield bytes([first, *((17 * place + first) % 251 for place in range(1, 64))])[
            : message.length
        ]


def decoded(message: CantoolsMessage, payload: bytes) -> dict[str, float] | None:
    """The raw values, None where cantools knows no such branch or a float is none."""
    try:
        raw = message.decode_simple(payload, decode_choices=False, scaling=False)
    except cantools.database.DecodeError:
        return None
    values = {name: value for name, value in raw.items() if isinstance(value, int | float)}
    return None if any(map(math.isnan, values.values())) else values


def test_a_field_of_a_branch_that_is_not_there_is_none_and_is_not_sent(importable: Path) -> None:
    messages = importlib.import_module("foreign_multiplexed_extended.messages")
    nested = messages.Nested(page=0, sub_page=5, on_page_zero_sub_two=0x1234, always=7)
    assert nested.on_page_one is None
    assert nested.to_raw() == {
        "Page": 0,
        "SubPage": 5,
        "OnPageZeroSubTwo": 0x1234,
        "Always": 7,
    }
    with pytest.raises(EncodeError, match="on_page_one"):
        messages.Nested(page=1).to_raw()


def test_names_that_python_or_the_stubs_need_are_given_way_to(importable: Path) -> None:
    messages = importlib.import_module("foreign_awkward.messages")
    kinds = {kind.NAME: kind for kind in messages.MESSAGES}
    assert set(kinds) == {"Message", "Mode", "speed", "Speed", "SPEED", "class"}
    fields = {field.dbc_name: field.name for field in kinds["Message"].FIELDS.values()}
    assert set(fields) == {"Int", "float", "to_raw", "class", "Mode", "mode"}
    assert len(set(fields.values())) == 6
    raw = kinds["Message"]().to_raw()
    assert raw == dict.fromkeys(fields, 0)
    same = kinds["Message"](**{fields["Int"]: -1})
    assert same.to_raw()["Int"] == -1


@pytest.mark.parametrize("name", ["", "a-b", "1st", "class", "../up"])
def test_a_name_that_is_no_package_is_refused(name: str) -> None:
    with pytest.raises(ReadError, match="is no name for a Python package"):
        foreign_artifacts(read_dbc(FILES[0]), name)


SIGNAL = Signal(name="Sig", start=0, length=8, minimum=Decimal(0), maximum=Decimal(255))
MESSAGE = Message(name="Msg", frame_id=1, length=8, sender="", signals=(SIGNAL,))


def test_what_no_dbc_can_say_is_refused() -> None:
    protocol = Protocol(name="x", messages=(dataclasses.replace(MESSAGE, name="1st"),))
    assert dbc_faults(protocol) == [
        "'1st' is no DBC name: letters, digits and underscores, no digit first"
    ]
    with pytest.raises(ReadError, match="'1st' is no DBC name"):
        foreign_artifacts(protocol, "x")


def selected_by(name: str) -> Message:
    signal = dataclasses.replace(SIGNAL, multiplexer=name, selectors=(1,))
    return dataclasses.replace(MESSAGE, signals=(signal,))


@pytest.mark.parametrize(
    ("messages", "names"),
    [
        ((MESSAGE, dataclasses.replace(MESSAGE, frame_id=2)), {"Msg": ["Sig"], "Msg_2": ["Sig"]}),
        ((dataclasses.replace(MESSAGE, name="Old"), MESSAGE), {"Msg": ["Sig"]}),
        ((dataclasses.replace(MESSAGE, signals=(SIGNAL, SIGNAL)),), {"Msg": ["Sig", "Sig_2"]}),
        ((selected_by("Sig"),), {"Msg": ["Sig"]}),
        ((selected_by("None"),), {"Msg": ["Sig"]}),
        ((dataclasses.replace(MESSAGE, english="C:\\"),), {"Msg": ["Sig"]}),
    ],
)
def test_what_is_odd_is_no_reason_to_refuse_the_rest(
    messages: tuple[Message, ...], names: dict[str, list[str]], tmp_path: Path
) -> None:
    made = foreign_artifacts(Protocol(name="x", messages=messages), "odd_x")
    (tmp_path / "odd_x.dbc").write_bytes(made["odd_x.dbc"])
    theirs = cantools.database.load_file(tmp_path / "odd_x.dbc", strict=False)
    assert isinstance(theirs, Database)
    assert {each.name: [s.name for s in each.signals] for each in theirs.messages} == names
    try_package(made, "odd_x", "odd_x.dbc")


def test_a_sound_protocol_has_no_faults(protocol: Protocol) -> None:
    assert dbc_faults(protocol) == []
    for path in FILES:
        assert dbc_faults(read_dbc(path)) == []
