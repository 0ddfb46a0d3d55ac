"""The same log gives the same reports, byte for byte, whatever the process."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from pathlib import Path

from typedcan.judge.report import environment

ROOT = Path(__file__).parents[2]
LOG = ROOT / "tests" / "rules" / "cases" / "checksum" / "fails.log"

PROGRAM = """
import sys
from swapcan.conform import judge_log
from typedcan.judge.report import *

judgement = judge_log(sys.argv[1])
for language in ("en", "zh"):
    texts = [
        "\\n".join(summary([judgement], language, colour=True, verbose=True)),
        to_json([judgement], language),
        to_junit([judgement], language),
        to_csv([judgement], language),
        to_html([judgement], [moments(sys.argv[1], judgement)], language, environment()),
    ]
    for text in texts:
        sys.stdout.buffer.write(text.encode("utf-8"))
"""


def reports(seed: str) -> bytes:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(LOG)],
        env={
            **os.environ,
            "PYTHONHASHSEED": seed,
            "PYTHONPATH": os.pathsep.join([str(ROOT / "src"), os.environ.get("PYTHONPATH", "")]),
        },
        capture_output=True,
        check=True,
    )
    return done.stdout


def test_two_processes_say_the_same() -> None:
    first, second = reports("1"), reports("2")
    assert len(first) > 10_000
    assert first == second


def test_the_environment_tells_versions_and_nothing_of_the_host() -> None:
    found = environment()
    assert found["Python"] == platform.python_version()
    assert {"swapcan", "numpy", "cantools", "python-can", "System"} <= set(found)
    said = " ".join(found.values())
    assert platform.node() not in said.split()
    assert str(ROOT) not in said
