"""Names of generated Python, whatever those of a protocol are: packages load and work."""

from __future__ import annotations

import ast
import builtins
import dataclasses
import itertools
import keyword
import re
import subprocess
import sys
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from emit.other_protocol import OTHER
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from dbcspec.artifacts import foreign_artifacts
from dbcspec.emit.long_names import with_dbc_names
from dbcspec.emit.stub_names import TAKEN, package_name
from dbcspec.emit.stubs import emit_stubs
from dbcspec.read.doors import open_side
from typedcan.model.protocol import Code, Message, Node, Protocol, Signal, ValueTable
from typedcan.wire.message import Message as TypedMessage

CASES = Path(__file__).parent.parent / "fixtures" / "cases"

AWKWARD = """
    Field MODEL ENUMS IntEnum _fields_of _MODELS _new_X _decode_X _codes_Gear_8 _BRANCH_1 dataclass
    Code2 Code8 PROTOCOL CODECS StraightLine raw_of Message
    Message_ SignalState messages enums model codec GEAR_8
    Gear Gear_8 gear GEAR GearCodes gear_codes to_raw FIELDS NAME name value _is_there __class__
    __name__ __file__ __init__ __x self None True class class_ class_2 int float str type object
    Mapping ClassVar Any annotations mro _1 _2 x X x_2 X_2 x_ Type lambda match _ __ v m
    _Gear __Gear Gear__ checksum CHECKSUM counter property Warning BO_ SG_ VERSION M m INT
    a_b aB A_B AB Ab 电池 Größe 1st 2nd a-b a.b
""".split()  # noqa: SIM905 - a hundred quoted words read worse
NAMES = st.sampled_from(AWKWARD)
LABELS = st.sampled_from(
    [
        "mro",
        "name",
        "value",
        "1",
        "1 5",
        "_1_",
        "None",
        "A",
        "a",
        "A 5",
        "A MINUS",
        "",
        "电池",
        "__x__",
    ]
)


@st.composite
def tables(draw: st.DrawFn) -> ValueTable:
    codes = draw(st.dictionaries(st.integers(-8, 7), LABELS, min_size=1, max_size=6))
    return ValueTable(
        draw(NAMES), tuple(Code(value, text, text) for value, text in sorted(codes.items()))
    )


@st.composite
def protocols(draw: st.DrawFn) -> Protocol:
    """Messages, signals, tables and nodes with awkward names, each kind without repetitions."""
    known = draw(st.lists(tables(), max_size=4, unique_by=lambda table: table.name))
    messages: list[Message] = []
    for number, name in enumerate(draw(st.lists(NAMES, min_size=1, max_size=6, unique=True))):
        signals: list[Signal] = []
        for place, own in enumerate(draw(st.lists(NAMES, max_size=6, unique=True))):
            signed = draw(st.booleans())
            signals.append(
                Signal(
                    name=own,
                    start=8 * place,
                    length=draw(st.integers(4, 8)),
                    signed=signed,
                    factor=draw(st.sampled_from([Decimal(1), Decimal("-0.5"), Decimal("0.1")])),
                    minimum=Decimal(-1000),
                    maximum=Decimal(1000),
                    value_table=draw(st.sampled_from([None, *known])),
                    python_name=draw(st.sampled_from(["", own])),
                )
            )
        messages.append(
            Message(
                name=name,
                frame_id=number,
                extended=draw(st.booleans()),
                length=8,
                sender="",
                signals=tuple(signals),
            )
        )
    nodes = tuple(map(_node, draw(st.lists(NAMES, max_size=3, unique=True))))
    return Protocol(
        name="awkward", nodes=nodes, messages=tuple(messages), value_tables=tuple(known)
    )


def _node(name: str) -> Node:
    return Node(name=name)


COUNT = itertools.count()


def put(folder: Path, protocol: Protocol, name: str) -> None:
    for file, data in foreign_artifacts(protocol, name).items():
        (folder / file).parent.mkdir(exist_ok=True)
        (folder / file).write_bytes(data)


def trial(folder: Path, *names: str) -> None:
    """Import packages in another process, and hold their messages against cantools."""
    program = "import sys; from typedcan.trial import main\nfor each in sys.argv[2:]:"
    program += " assert main([sys.argv[1], each, f'{sys.argv[1]}/{each}.dbc']) == 0, each"
    done = subprocess.run(
        [sys.executable, "-c", program, str(folder), *names],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


class Many:
    """Some protocols, one process for all of them; they are too long to be shown."""

    def __init__(self, protocols: list[Protocol]) -> None:
        self.protocols = protocols

    def __repr__(self) -> str:
        return f"{len(self.protocols)} protocols"


@settings(
    max_examples=12,
    suppress_health_check=list(HealthCheck),
    phases=[Phase.generate],  # a failure names the package: shrinking takes minutes
)
@given(many=st.lists(protocols(), min_size=8, max_size=8).map(Many))
def test_packages_of_any_names_load_and_do_what_cantools_does(
    many: Many, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("names")
    names = [f"awkward_{next(COUNT)}" for _ in many.protocols]
    for name, protocol in zip(names, many.protocols, strict=True):
        put(folder, protocol, name)
    trial(folder, *names)


@pytest.mark.parametrize("path", sorted(CASES.iterdir()), ids=lambda path: path.name)
def test_a_database_that_went_wrong_once_becomes_a_sound_package(
    path: Path, tmp_path: Path
) -> None:
    name = package_name(path.stem)
    put(tmp_path, open_side(str(path)).protocol, name)
    trial(tmp_path, name)


def test_what_stands_in_the_modules_is_no_name_of_a_class() -> None:
    for file, text in emit_stubs(OTHER).items():
        if file.endswith(".py"):
            classes = {each.name for each in OTHER.messages}
            classes |= {table.name for table in OTHER.value_tables}
            assert names_of(text) - classes - TAKEN == set(), file


def names_of(text: str) -> set[str]:
    """The names that a module binds, but for those of its own with an underscore and a word."""
    found: set[str] = set()
    for node in ast.parse(text).body:
        match node:
            case ast.Import() | ast.ImportFrom():
                found |= {alias.asname or alias.name for alias in node.names}
            case ast.ClassDef() | ast.FunctionDef():
                found.add(node.name)
            case ast.Assign() | ast.AnnAssign():
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                found |= {ast.unparse(target) for target in targets}
    return {
        name
        for name in found
        if not re.match("_(codes|new|decode|encode|raw|BRANCH)_", name)
        and not name.startswith("__")
    }


def test_no_field_has_a_name_that_messages_python_or_the_stubs_need() -> None:
    wanted = [*dir(TypedMessage), *keyword.kwlist, *dir(builtins), *TAKEN]
    fields = [
        Signal(
            name=f"S{number}",
            start=0,
            length=1,
            minimum=Decimal(0),
            maximum=Decimal(1),
            python_name=name,
        )
        for number, name in enumerate(wanted)
    ]
    message = dataclasses.replace(OTHER.messages[0], signals=tuple(fields))
    text = emit_stubs(Protocol(name="x", messages=(message,)))["messages.py"]
    (body,) = (
        node.body
        for node in ast.parse(text).body
        if isinstance(node, ast.ClassDef) and node.name == message.name
    )
    named = [
        ast.unparse(node.target)
        for node in body
        if isinstance(node, ast.AnnAssign) and "ClassVar" not in ast.unparse(node.annotation)
    ]
    assert len(named) == len(set(named)) == len(wanted)
    assert set(named) & set(wanted) == set()


@pytest.mark.parametrize(
    ("stem", "name"),
    [
        ("gear_8", "gear_8"),
        ("my-car.v2", "my_car_v2"),
        ("2021", "_2021"),
        ("can", "can_"),
        ("JSON", "JSON_"),
        ("class", "class_"),
        ("typedcan", "typedcan_"),
        ("电池", "__"),
    ],
)
def test_a_package_hides_no_module_that_is_imported(stem: str, name: str) -> None:
    assert package_name(stem) == name


def test_a_negative_factor_leaves_the_smaller_end_the_minimum(tmp_path: Path) -> None:
    put(tmp_path, open_side(str(CASES / "negative_factor.dbc")).protocol, "falling")
    program = (
        "from falling.messages import Motor\n"
        "field = Motor.FIELDS['torque']\n"
        "print(field.minimum, field.maximum, Motor(torque=-100.0).to_raw(), Motor().to_raw())"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert done.stdout.strip() == "-100.0 100.0 {'Torque': 200} {'Torque': 0}"


def test_a_range_of_nothing_is_none_however_it_is_written() -> None:
    protocol = open_side(str(CASES / "zero.dbc")).protocol
    limits: dict[str, Any] = {sig.name: (sig.minimum, sig.maximum) for _, sig in protocol.signals()}
    assert limits == {"Pxx": (0, 255), "Qxx": (0, 255)}


@pytest.mark.parametrize(
    "name", ["M", "m", "INT", "HEX", "FLOAT", "ENUM", "STRING", "CAT_x", "BA_x"]
)
def test_names_that_readers_accept_stay_what_they_are(name: str) -> None:
    message = Message(name=name, frame_id=1, length=8, sender="")
    (kept,) = with_dbc_names(Protocol(name="x", messages=(message,))).messages
    assert kept.name == name


def test_keywords_that_no_reader_takes_for_names_become_others() -> None:
    message = Message(name="BO_", frame_id=1, length=8, sender="")
    (renamed,) = with_dbc_names(Protocol(name="x", messages=(message,))).messages
    assert renamed.name == "_BO_"
