"""`python -m typedcan` for protocols of others, with the package `swapcan` not importable."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import can
import pyarrow.parquet as pq
import pytest
from commands.running import as_arguments, bus_options, environment, started

import typedcan

GENERATOR = Path(typedcan.__file__).parents[2] / "generator"
FIXTURES = Path(__file__).parent.parent / "fixtures"
WIDTHS = FIXTURES / "databases" / "both.dbc"
PACK = FIXTURES / "logs" / "pack.log"
TYPEDCAN = (
    "import sys; sys.modules['swapcan'] = None; sys.modules['dbcspec'] = None\n"
    "from typedcan.__main__ import main; sys.exit(main())"
)
DBCSPEC = (
    "import sys; sys.modules['swapcan'] = None\n"
    "from dbcspec.cli import run; sys.exit(run(sys.argv[1:]))"
)


def run(
    *arguments: object, program: str = TYPEDCAN, folder: Path | None = None, status: int = 0
) -> subprocess.CompletedProcess[str]:
    env = environment() | {"PYTHONUTF8": "1"}
    env["PYTHONPATH"] += f"{os.pathsep}{GENERATOR}"
    done = subprocess.run(
        [sys.executable, "-c", program, *map(str, arguments)],
        cwd=folder,
        env=env,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == status, done.stderr
    return done


@pytest.fixture(scope="module")
def generated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a package that `dbcspec generate` wrote."""
    folder = tmp_path_factory.mktemp("generated")
    database = FIXTURES / "logs" / "pack_utf8.dbc"
    run("generate", "--from", database, "--out", "trucks", program=DBCSPEC, folder=folder)
    return folder


@pytest.mark.parametrize("database", ["pack_utf8.dbc", "pack_gbk.dbc"])
def test_decode_shows_the_units_and_labels_of_a_database_in_any_encoding(database: str) -> None:
    done = run("--dbc", FIXTURES / "logs" / database, "decode", PACK)
    first, second = done.stdout.splitlines()
    assert first.split("  ")[-5:] == [
        "Pack",
        "temp=80 ℃",
        "insul=1000 kΩ",
        "mode=充电",
        "curr=-10 A",
    ]
    assert "mode=放电" in second
    assert done.stderr.startswith("typedcan: frames 2, decoded 2, unknown 0")


def test_the_database_may_stand_after_the_command_too() -> None:
    done = run("decode", "--dbc", FIXTURES / "logs" / "pack_gbk.dbc", PACK, "--json")
    first = json.loads(done.stdout.splitlines()[0])
    assert (first["id"], first["message"]) == (0x100, "Pack")
    assert first["signals"]["Mode"] == {"value": 1, "label": "充电"}


def test_convert_writes_the_tables_of_a_database(tmp_path: Path) -> None:
    output = tmp_path / "pack.parquet"
    run("--dbc", FIXTURES / "logs" / "pack_gbk.dbc", "convert", PACK, "-o", output)
    table = pq.read_table(output)
    assert table.column("Temp").to_pylist() == [80, 81]
    metadata = table.schema.field("Temp").metadata or {}
    assert metadata[b"unit"].decode() == "℃"


def test_plot_draws_signals_of_a_database(tmp_path: Path) -> None:
    output = tmp_path / "pack.html"
    done = run("--dbc", FIXTURES / "logs" / "pack_utf8.dbc", "plot", PACK, "--signals", "Temp",
               "-o", output)  # fmt: skip
    assert "signals 1" in done.stderr
    assert "℃" in output.read_text("utf-8")


WIDTHS_LOG = "(0.1) can0 100#0102\n(0.2) can0 00000100#07\n(0.3) can0 100#03\n"


def test_conform_judges_a_log_by_a_database_alone(tmp_path: Path) -> None:
    log, report = tmp_path / "widths.log", tmp_path / "report.xml"
    log.write_text(WIDTHS_LOG, "ascii")
    done = run("--dbc", WIDTHS, "conform", log, "--junit", report, status=1)
    assert "must  frame-length: Frames have the bytes of their message" in done.stdout
    assert "First 0.000 s  AA SHORTID: 2 bytes instead of 1" in done.stdout
    assert "()" not in done.stdout  # no clause
    assert 'message="Frames have the bytes of their message: found: 1' in report.read_text("utf-8")
    found = json.loads(run("conform", "--dbc", WIDTHS, log, "--json", status=1).stdout)
    assert found["verdict"] == "violates"
    assert found["logs"][0]["frames"] == {"": 1, "LONGID": 1, "SHORTID": 1}


def test_conform_lists_the_rules_that_a_protocol_gives() -> None:
    _, _, *rules = run("--dbc", WIDTHS, "conform", "--list-rules").stdout.splitlines()
    listed = {rule.split()[0] for rule in rules}
    assert {"frame-length", "frame-kind", "foreign-frames", "event-repeated"} <= listed
    assert not listed & {"identifier-priority", "checksum", "answer-in-time", "bus-load"}


def test_conform_judges_nodes_by_name_whatever_the_case_of_their_letters(tmp_path: Path) -> None:
    log = tmp_path / "widths.log"
    log.write_text(WIDTHS_LOG, "ascii")
    done = run("--dbc", WIDTHS, "conform", log, "--judge", "aa", "--json", status=1)
    assert json.loads(done.stdout)["logs"][0]["nodes"] == ["AA"]
    done = run("--dbc", WIDTHS, "conform", log, "--judge", "cc", status=2)
    assert done.stderr == "typedcan: there is no node 'cc'; AA, BB\n"


def test_a_generated_package_serves_by_its_name_and_by_its_folder(generated: Path) -> None:
    package = next(generated.rglob("protocol.json")).parent
    name = ".".join(package.relative_to(generated).parts)
    by_database = run("--dbc", FIXTURES / "logs" / "pack_utf8.dbc", "decode", PACK).stdout
    # A name is found as Python finds it; the program given with -c has the folder it runs in.
    for protocol in (name, package):
        done = run("--protocol", protocol, "decode", PACK, folder=generated)
        assert done.stdout == by_database


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ((), "say which protocol: --protocol PACKAGE or --dbc FILE"),
        (("--dbc", "missing.dbc"), "missing.dbc: there is no such file"),
        (("--protocol", "nowhere.found"), "--protocol nowhere.found: cannot be imported: "),
        (("--protocol", "no/folder"), "--protocol 'no/folder': no package that "),
        (("--protocol", "json"), "--protocol json: cannot be imported: "),
    ],
)
def test_what_cannot_be_used_as_a_protocol_is_one_line(
    options: tuple[str, ...], problem: str, tmp_path: Path
) -> None:
    done = run(*options, "decode", PACK, folder=tmp_path, status=2)
    assert done.stdout == ""
    assert done.stderr.startswith(f"typedcan: {problem}")
    assert done.stderr.count("\n") == 1


def test_the_code_of_a_package_that_fails_is_one_line(tmp_path: Path) -> None:
    for name, code in (("bad", "1 / 0"), ("empty", ""), ("other", "PROTOCOL = 1")):
        (tmp_path / "all" / name).mkdir(parents=True)
        (tmp_path / "all" / name / "protocol.py").write_text(code)
        done = run("--protocol", f"all.{name}", "decode", PACK, folder=tmp_path, status=2)
        assert done.stderr.startswith(f"typedcan: --protocol all.{name}: ")
        assert done.stderr.count("\n") == 1
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "protocol.json").write_text("{}")
    done = run("--protocol", "./damaged", "decode", PACK, folder=tmp_path, status=2)
    assert "damaged/protocol.json" in done.stderr.replace("\\", "/")
    assert done.stderr.count("\n") == 1


def test_help_needs_no_protocol_and_has_examples() -> None:
    for command in ("", "decode", "convert", "plot", "listen", "send"):
        done = run(*filter(None, [command]), "--help")
        assert "examples:\n  python -m typedcan " in done.stdout


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("SHORTID", "left=7"), "0x100  [07]  SHORTID  left=7"),
        (("longid", "Right=0x10"), "0x00000100  [10]  LONGID  right=16"),
    ],
)
def test_send_sends_messages_of_both_widths(words: tuple[str, ...], line: str) -> None:
    done = run("--dbc", WIDTHS, "send", *words, "-i", "virtual", "-c", "any-protocol")
    assert done.stdout == f"{line}\n"


def test_a_database_does_not_say_what_acts_so_that_sending_needs_consent() -> None:
    shared = bus_options("udp_multicast")
    send = ("--dbc", WIDTHS, "send", "SHORTID", "left=7", *as_arguments(shared))
    done = run(*send, status=2)
    assert done.stderr == (
        "typedcan: SHORTID may make its receiver act: nothing is known of codes that do:"
        " not sent without --yes-drive-the-bus\n"
    )
    with can.Bus(ignore_config=True, **shared) as bus:
        done = run(*send, "--yes-drive-the-bus")
        assert done.stdout == "0x100  [07]  SHORTID  left=7\n"
        assert done.stderr == "typedcan: looking for another AA for 2 s\n"
        frame = bus.recv(5)
    assert frame is not None
    assert (frame.arbitration_id, frame.is_extended_id, bytes(frame.data)) == (0x100, False, b"\7")


def test_listen_prints_messages_of_both_widths_as_they_arrive() -> None:
    shared = bus_options("udp_multicast")
    arguments = ("--dbc", str(WIDTHS), "listen", *as_arguments(shared), "--count", "2")
    with (
        can.Bus(ignore_config=True, **shared) as bus,
        started("-c", TYPEDCAN, *arguments) as listening,
    ):
        assert listening.stderr is not None
        assert "listening on" in listening.stderr.readline()
        for extended in (False, True):
            bus.send(can.Message(arbitration_id=0x100, is_extended_id=extended, data=[5]))
        printed, summary = listening.communicate(timeout=30)
    assert [line.split()[5:] for line in printed.splitlines()] == [
        ["SHORTID", "left=5"],
        ["LONGID", "right=5"],
    ]
    assert summary.startswith("typedcan: frames 2, decoded 2, unknown 0")
