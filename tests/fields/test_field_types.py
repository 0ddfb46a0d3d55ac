"""What mypy (strict) and pyright say of values for fields: of the marked lines, and no others."""

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
LINES = [
    *HEAD.strip().splitlines(),
    *(f"    {line}" for line in TAKEN.split("\n") if line),
    *(f"    {line}  # wrong" for line in REFUSED.split("\n") if line),
]
WRONG = {place for place, line in enumerate(LINES, start=1) if line.endswith("# wrong")}


@pytest.fixture(scope="module")
def snippet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("types") / "snippet.py"
    path.write_text("\n".join(LINES) + "\n", "utf-8")
    return path


def output(snippet: Path, root: Path, *arguments: str) -> str:
    """What a checker of this environment prints of the snippet."""
    return subprocess.run(
        [sys.executable, "-m", *arguments, snippet.name],
        cwd=snippet.parent,
        env={**os.environ, "MYPYPATH": str(root / "src")},
        capture_output=True,
        text=True,
        check=False,
    ).stdout


def test_mypy_reports_the_wrong_values_and_nothing_else(snippet: Path, root: Path) -> None:
    said = output(snippet, root, "mypy", "--strict", "--config-file=", "--cache-dir=cache")
    lines = re.findall(r"^snippet\.py:(\d+): error", said, re.MULTILINE)
    assert set(map(int, lines)) == WRONG, said


def test_pyright_reports_the_wrong_values_and_nothing_else(snippet: Path, root: Path) -> None:
    paths = json.dumps({"extraPaths": [(root / "src").as_posix()], "include": ["snippet.py"]})
    (snippet.parent / "pyrightconfig.json").write_text(paths, "utf-8")
    said = output(
        snippet, root, "pyright", "--outputjson", f"--pythonpath={sys.executable}", "--project=."
    )
    found = json.loads(said)["generalDiagnostics"]
    lines = {each["range"]["start"]["line"] + 1 for each in found if each["severity"] == "error"}
    assert lines == WRONG, said
