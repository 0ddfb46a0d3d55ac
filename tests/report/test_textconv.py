"""The text behind `git diff` of DBC files."""

from __future__ import annotations

import dataclasses
import difflib
import subprocess
import sys
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path

from emit.other_protocol import OTHER

from dbcspec.textconv import textconv
from typedcan.databases.dbc import read_dbc
from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Aspect, Code, Message, Node, Protocol, Signal, ValueTable

GEARS = ValueTable("Gears", (Code(1, "eins", "one"), Code(0, "null", "null")))
SPEED = Signal(
    name="Speed",
    start=0,
    length=8,
    factor=Decimal("0.50"),
    minimum=Decimal(0),
    maximum=Decimal("1E+2"),
    unit="km/h",
    value_table=GEARS,
    receivers=("TCU", "ABS"),
)
ENGINE = Message(name="Engine", frame_id=0x123, length=8, sender="ECU", signals=(SPEED,))
SMALL = Protocol(name="small", nodes=(Node(name="ECU"),), messages=(ENGINE,))


def changed(old: Protocol, new: Protocol) -> list[str]:
    """The lines of a diff, each with its sign."""
    pairs = difflib.ndiff(textconv(old).splitlines(), textconv(new).splitlines())
    return [line for line in pairs if line[0] in "+-"]


def with_signal(change: Callable[[Signal], Signal]) -> Protocol:
    message = dataclasses.replace(ENGINE, signals=(change(SPEED),))
    return dataclasses.replace(SMALL, messages=(message,))


def test_one_changed_fact_is_one_changed_line_that_says_what_it_is_about() -> None:
    new = with_signal(lambda signal: dataclasses.replace(signal, factor=Decimal("0.25")))
    assert changed(SMALL, new) == ["- Engine Speed: factor 0.5", "+ Engine Speed: factor 0.25"]


def test_a_code_has_a_line_of_its_own_in_order_of_values() -> None:
    more = ValueTable("Gears", (*GEARS.codes, Code(2, "zwei\nneu", "two")))
    new = with_signal(lambda signal: dataclasses.replace(signal, value_table=more))
    assert changed(SMALL, new) == [
        '+ Engine Speed: code 2 is "zwei\\nneu"',
        '+ Engine Speed: code 2 in English is "two"',
    ]
    codes = [line for line in textconv(SMALL).splitlines() if ": code " in line]
    assert [line.split(": ")[1] for line in codes] == [
        'code 0 is "null"',
        'code 1 is "eins"',
        'code 1 in English is "one"',
    ]


def test_order_of_messages_nodes_signals_and_receivers_does_not_show() -> None:
    turned = dataclasses.replace(
        OTHER,
        nodes=OTHER.nodes[::-1],
        value_tables=OTHER.value_tables[::-1],
        messages=tuple(
            dataclasses.replace(
                message,
                signals=tuple(
                    dataclasses.replace(signal, receivers=signal.receivers[::-1])
                    for signal in message.signals[::-1]
                ),
            )
            for message in OTHER.messages[::-1]
        ),
    )
    assert turned != OTHER
    assert textconv(turned) == textconv(OTHER)


def test_every_fact_of_the_model_shows(protocol: Protocol) -> None:
    text = textconv(protocol)
    for message, signal in protocol.signals():
        lines = [f"{message.name} {signal.name}: {fact}\n" for fact in _facts(signal)]
        assert [line for line in lines if line not in text] == []
    assert len(text.splitlines()) == len({*text.splitlines()})


def _facts(signal: Signal) -> list[str]:
    codes = signal.value_table.codes if signal.value_table else ()
    return [
        f"start bit {signal.start}",
        f"length {signal.length}",
        f"order {signal.byte_order.value}",
        *(f"receiver {name}" for name in signal.receivers),
        *(f'code {code.value} is "{code.label}"' for code in codes),
    ]


def test_codes_that_act_show_one_a_line() -> None:
    acts = ActingCodes(codes=(1, 2), safe=0, reference="5.1")
    new = with_signal(lambda signal: dataclasses.replace(signal, acting=acts))
    assert changed(SMALL, new) == [
        "+ Engine Speed: code that acts as command 1",
        "+ Engine Speed: code that acts as command 2",
        "+ Engine Speed: safe code 0",
        '+ Engine Speed: place of the codes that act "5.1"',
    ]


def test_messages_come_by_identifier() -> None:
    low = dataclasses.replace(ENGINE, name="Zulu", frame_id=1)
    protocol = dataclasses.replace(SMALL, messages=(ENGINE, low))
    text = textconv(protocol)
    assert text.index("Zulu") < text.index("Engine")


def test_what_the_source_cannot_say_is_left_out() -> None:
    silent = dataclasses.replace(SMALL, carries=frozenset())
    assert "period" not in textconv(silent)
    assert "start value" not in textconv(silent)
    assert "start value 0" in textconv(dataclasses.replace(SMALL, carries=frozenset(Aspect)))


def test_git_shows_the_meaning_of_a_changed_dbc_file(tmp_path: Path) -> None:
    before = (
        'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: ECU TCU\n\nBO_ 291 Engine: 8 ECU\n'
        ' SG_ Speed : 0|8@1+ (0.5,0) [0|100] "km/h" TCU\n SG_ Gear : 8|4@1+ (1,0) [0|9] "" TCU\n'
    )
    first, second, gear = before.partition(" SG_ Gear")[0], " SG_ Gear", before.split("SG_ Gear")[1]
    head, speed = first.split(" SG_ Speed")
    after = f"{head}{second}{gear} SG_ Speed{speed}".replace("(0.5,0)", "(0.25,0)")
    driver = tmp_path / "driver.py"
    driver.write_text(
        "import sys\nfrom pathlib import Path\nfrom typedcan.databases.dbc import read_dbc\n"
        "from dbcspec.textconv import textconv\n"
        "sys.stdout.buffer.write(textconv(read_dbc(Path(sys.argv[1]))).encode())\n"
    )
    command = f'"{Path(sys.executable).as_posix()}" "{driver.as_posix()}"'
    path = tmp_path / "can.dbc"

    def git(*arguments: str) -> str:
        done = subprocess.run(
            ["git", "-c", f"diff.dbc.textconv={command}", *arguments],
            cwd=tmp_path,
            capture_output=True,
            encoding="utf-8",
            check=True,
        )
        return done.stdout

    git("init", "--quiet")
    (tmp_path / ".gitattributes").write_text("*.dbc diff=dbc\n")
    path.write_text(before)
    git("add", ".")
    path.write_text(after)
    shown = [line for line in git("diff", "--unified=0").splitlines() if line[0] in "+-"]
    assert shown[2:] == ["-Engine Speed: factor 0.5", "+Engine Speed: factor 0.25"]
    assert read_dbc(path).messages[0].signals[0].name == "Gear"
