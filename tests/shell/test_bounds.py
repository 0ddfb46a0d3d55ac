"""A short file costs no more than any: a second of computing and 100 MB beyond an ordinary one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

HEAD = 'VERSION ""\nBU_: A B\nBO_ 256 M: 8 A\n'
SIGNAL = ' SG_ a : 0|8@1+ (1,0) [0|255] "" B\n'
ORDINARY = HEAD + SIGNAL
PERIOD = 'BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;\nBA_DEF_DEF_ "GenMsgCycleTime" '
SYM = 'FormatVersion=6.0 // x\nTitle="t"\n\n'
KCD = (
    '<NetworkDefinition xmlns="http://kayak.2codeornot2code.org/1.0"><Document/><Bus name="b">'
    '<Message id="0x1" name="M" length="auto"><Signal name="s" {}/></Message></Bus>'
    "</NetworkDefinition>"
)
SELECTED = (
    ' SG_ s M : 0|32@1+ (1,0) [0|0] "" B\n SG_ a m0 : 32|8@1+ (1,0) [0|255] "" B\n'
    "SG_MUL_VAL_ 256 a s 0-{};\n"
)
SHORT = {
    "bits.dbc": HEAD + SIGNAL.replace("|8@", "|100000000@"),
    "bytes.dbc": ORDINARY.replace("M: 8", "M: 10000000"),
    "wide.dbc": ORDINARY.replace("M: 8", "M: 4095").replace("|8@", "|32760@"),
    "endless.dbc": f"{ORDINARY}{PERIOD}1e999999999;\n",
    "digits.dbc": ORDINARY.replace("255", "9" * 3000),
    "selectors.dbc": HEAD + SELECTED.format(8000),
    "everything.dbc": HEAD + SELECTED.format(4294967295),
    "overlaps.dbc": HEAD
    + "".join(f' SG_ s{at} : 0|8@1+ (1,0) [0|255] "" B\n' for at in range(4000)),
    "bits.kcd": KCD.format('offset="0" length="&#49;00000000"'),
    "far.kcd": KCD.format('offset="&#57;99999999" length="8"'),
    "bits.sym": f"{SYM}{{SIGNALS}}\nSig=s unsigned 100000000\n",
    "far.sym": f"{SYM}{{SENDRECEIVE}}\n[M]\nID=001h\nVar=s unsigned 99999999,8\n",
    "deep.arxml": "<a>" * 100_000,
}


class Cost(NamedTuple):
    """Seconds of computing and megabytes."""

    seconds: float
    megabytes: float


def cost(*words: str) -> Cost:
    """What a command costs in a process of its own; it ends with one of its exit statuses."""
    process = subprocess.Popen(
        [sys.executable, "-m", "dbcspec", *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode in (0, 1, 2)
    return Cost(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


@pytest.fixture(scope="module")
def ordinary(tmp_path_factory: pytest.TempPathFactory) -> Cost:
    path = tmp_path_factory.mktemp("ordinary") / "ordinary.dbc"
    path.write_text(ORDINARY, "utf-8")
    return cost("lint", str(path))


@pytest.mark.skipif(not hasattr(os, "wait4"), reason="nothing says what a process has cost")
@pytest.mark.parametrize("name", SHORT)
def test_a_short_file_costs_no_more_than_a_second_and_100_megabytes(
    name: str, ordinary: Cost, tmp_path: Path
) -> None:
    path = tmp_path / name
    path.write_text(SHORT[name], "utf-8")
    found = cost("lint", str(path))
    assert found.seconds < ordinary.seconds + 1
    assert found.megabytes < ordinary.megabytes + 100
