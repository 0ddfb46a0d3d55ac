"""What mypy (strict) and pyright say of what users write: of the marked lines, and no others.

Values that are given to fields, what is received of a class that was asked for, and the README.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

TAKEN = """
V2B_CMD()
V2B_CMD(hv_on_off=HvCommand.HV_ON)
V2B_CMD(hv_on_off=2)
V2B_CMD(hv_on_off=HvCommand(number))
V2B_CMD(hv_on_off=V2B_CMD().hv_on_off)
V2B_CMD(vehicle_speed=42.0)
V2B_CMD(vehicle_speed=42)
V2B_CMD(aliv=3, checksum=None)
B2V_ST2(soc=SignalState.INVALID)
B2V_ST0(flt_main_pos_relay_weld=1)
B2V_SysCode1(sys_code_length=31)
V2B_VIN(b1_8_15="L", b2_9_16=0x4C, frame_no=number)
B2C_Charger(charge_control=ChargeControl.NORMAL_STOP_TO_CHARGE)
BMS_TMS_0(reqst_tms_hv_on=1)
dataclasses.replace(V2B_CMD(), hv_on_off=HvCommand.HV_OFF)
"""
REFUSED = """
V2B_CMD(hv_on_off=BmsState.HV_CLOSED)
V2B_CMD(hv_on_off=RelayState.OPEN)
V2B_CMD(hv_on_off=AccessoryHvCommand.HV_ACC_ON)
V2B_CMD(hv_on_off=B2V_ST1().bms)
V2B_CMD(hv_on_off=True)
V2B_CMD(hv_on_off=False)
V2B_CMD(hv_on_off=number > 1)
V2B_CMD(hv_on_off=4)
V2B_CMD(hv_on_off=-1)
V2B_CMD(hv_on_off=number)
V2B_CMD(hv_on_off=1.0)
V2B_CMD(hv_on_off="HV On")
V2B_CMD(hv_on_off=None)
V2B_CMD(hv_on_off=SignalState.INVALID)
V2B_CMD(vehicle_speed=SignalState.INVALID)
V2B_CMD(vehicle_speed="42")
B2V_ST2(soc=None)
B2V_ST0(flt_main_pos_relay_weld=2)
B2V_SysCode1(sys_code_length=32)
V2B_VIN(frame_no=1.0)
V2B_VIN(frame_no=SignalState.INVALID)
B2C_Charger()
B2C_Charger(voltage_set=700.0, current_set=50.0)
BMS_TMS_0()
C2B_ACStatus()
"""
HEAD = """
import dataclasses
from swapcan import SignalState
from swapcan.messages import *
def values(number: int) -> None:
"""
VALUES = [
    *HEAD.strip().splitlines(),
    *(f"    {line}" for line in TAKEN.split("\n") if line),
    *(f"    {line}  # wrong" for line in REFUSED.split("\n") if line),
]
RESULTS = """
from typing import assert_type
from swapcan import Codec, Link, Message, Node, PackCode, Pending, Received, SignalState
from swapcan import StateChanged, Vin, decode
from swapcan.messages import *
from typedcan.model.code_types import Code2
Number = float | SignalState
def link(link: Link) -> None:
    received = link.receive(B2V_ST2, timeout=0)
    assert_type(received, Received[B2V_ST2])
    assert_type(received.kind, type[B2V_ST2])
    assert_type(received.message.soc, Number)
    assert_type(link.receive(V2B_CMD).message.hv_on_off, HvCommand | Code2)
    assert_type(link.receive(), Received[Message])
    assert_type(link.receive(timeout=None).message, Message)
    for each in link:
        assert_type(each, Received[Message])
    received.message.socc  # wrong
    received.message.hv_on_off  # wrong
    link.receive().message.soc  # wrong
    link.receive(HvCommand)  # wrong
def decoded(data: bytes, codec: Codec) -> None:
    assert_type(decode(B2V_ST2, data), B2V_ST2)
    assert_type(codec.decode(B2V_ST2, data, verify=False).soc, Number)
    assert_type(decode(0x1882D0F3, data), Message)
    assert_type(codec.decode(0x1882D0F3, data, extended=True), Message)
    decode(0x1882D0F3, data).soc  # wrong
    decode("B2V_ST2", data)  # wrong
    codec.decode(B2V_ST2, data, extended=True)  # wrong
def status(received: Received[B2V_ST2]) -> float | None:
    return received.message.soc if isinstance(received.message.soc, float) else None
def any_message(received: Received[Message]) -> str:
    return received.message.soc if isinstance(received.message, B2V_ST2) else ""  # wrong
async def node(node: Node, received: Received[B2V_ST2]) -> None:
    last = node.last(B2V_ST2)
    assert_type(last, Received[B2V_ST2] | None)
    last.message.soc  # wrong
    if last:
        assert_type(last.message.soc, Number)
    node.on(B2V_ST2, lambda received: print(received.message.soc))
    node.on(B2V_ST2, lambda received: print(received.message.hv_on_off))  # wrong
    node.on(B2V_ST2, status)
    node.on(V2B_CMD, status)  # wrong
    node.on(B2V_ST2, any_message)
    node.on(Received, any_message)
    node.on(StateChanged, lambda event: print(event.new))
    node.on(StateChanged, lambda event: print(event.message.soc))  # wrong
    assert_type(node.request_vin(), Pending[Vin])
    assert_type(await node.request_pack_code(), PackCode)
    assert_type(node.request_battery_info().result().info1, B2V_BattInfo1)
    any_message(received)
    async for event in node.events():
        if isinstance(event, PackCode):
            assert_type(event, PackCode)
        event.soc  # wrong
    async for status_only in node.events(B2V_ST2, limit=10):
        assert_type(status_only.message.soc, Number)
    async for change in node.events(StateChanged):
        assert_type(change, StateChanged)
        change.message.soc  # wrong
"""
README = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Path:
    """A folder with what is to be checked: one process checks all of it."""
    folder = tmp_path_factory.mktemp("types")
    (folder / "values.py").write_text("\n".join(VALUES) + "\n", "utf-8")
    (folder / "results.py").write_text(RESULTS.lstrip(), "utf-8")
    for number, snippet in enumerate(README.findall((root / "README.md").read_text("utf-8"))):
        (folder / f"readme_{number}.py").write_text(snippet, "utf-8")
    paths = {"extraPaths": [(root / "src").as_posix()], "include": ["*.py"]}
    (folder / "pyrightconfig.json").write_text(json.dumps(paths), "utf-8")
    return folder


def wrong(folder: Path) -> set[tuple[str, int]]:
    """The marked lines: file and number."""
    return {
        (path.name, number)
        for path in folder.glob("*.py")
        for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1)
        if line.endswith("# wrong")
    }


def output(folder: Path, root: Path, *arguments: str) -> str:
    """What a checker of this environment prints."""
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        cwd=folder,
        env={**os.environ, "MYPYPATH": str(root / "src")},
        capture_output=True,
        text=True,
        check=False,
    ).stdout


def test_mypy_reports_the_wrong_lines_and_nothing_else(files: Path, root: Path) -> None:
    names = sorted(path.name for path in files.glob("*.py"))
    assert len(names) > 2, "the README has snippets"
    said = output(files, root, "mypy", "--strict", "--config-file=", "--cache-dir=cache", *names)
    found = re.findall(r"^(\w+\.py):(\d+): error", said, re.MULTILINE)
    assert {(name, int(line)) for name, line in found} == wrong(files), said


def test_pyright_reports_the_wrong_lines_and_nothing_else(files: Path, root: Path) -> None:
    said = output(
        files, root, "pyright", "--outputjson", f"--pythonpath={sys.executable}", "--project=."
    )
    found = {
        (Path(each["file"]).name, each["range"]["start"]["line"] + 1)
        for each in json.loads(said)["generalDiagnostics"]
        if each["severity"] == "error"
    }
    assert found == wrong(files), said
