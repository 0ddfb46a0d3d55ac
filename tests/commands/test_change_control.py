"""The commands of change control as a person or CI runs them: exit statuses, files, errors."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from openpyxl import load_workbook

MAIN = "dbc/caamtb-swap.dbc"


@pytest.fixture
def folder(root: Path, tmp_path: Path) -> Path:
    """A copy of the project's spec and DBC files."""
    for part in ("spec", "dbc"):
        shutil.copytree(root / part, tmp_path / part)
    shutil.copy(root / "pyproject.toml", tmp_path)
    return tmp_path


def dbcspec(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the command line in a folder; it never shows a traceback."""
    done = subprocess.run(
        [sys.executable, "-X", "utf8", "-m", "dbcspec", *arguments],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        timeout=60,
        check=False,
    )
    assert "Traceback" not in done.stderr
    return done


def edited(folder: Path, old: str, new: str) -> str:
    """A copy of the main DBC with one text replaced; its name."""
    text = (folder / MAIN).read_bytes().decode("ascii")
    assert old in text
    (folder / "edited.dbc").write_bytes(text.replace(old, new).encode("ascii"))
    return "edited.dbc"


@pytest.mark.parametrize("file", ["", ".zh", ".zh-utf8"])
def test_every_dbc_of_the_whole_protocol_says_what_the_spec_says(folder: Path, file: str) -> None:
    assert dbcspec(folder, "compare", "spec", f"dbc/caamtb-swap{file}.dbc").returncode == 0


def test_the_exit_status_follows_the_class_that_was_asked_for(folder: Path) -> None:
    unit = edited(folder, '"A" VCU', '"mA" VCU')
    assert dbcspec(folder, "compare", MAIN, unit).returncode == 1
    assert dbcspec(folder, "compare", MAIN, unit, "--fail-on", "wire").returncode == 1
    comment = edited(folder, "Pack state of charge", "State of charge of the pack")
    assert dbcspec(folder, "compare", MAIN, comment).returncode == 1
    assert dbcspec(folder, "compare", MAIN, comment, "--fail-on", "additive").returncode == 0


def test_a_report_in_json_names_rule_subject_and_both_values(folder: Path) -> None:
    factor = edited(folder, "SOC : 0|8@1+ (0.4,0)", "SOC : 0|8@1+ (0.5,0)")
    report = json.loads(dbcspec(folder, "compare", MAIN, factor, "--json").stdout)
    (finding,) = report["findings"]
    assert finding["subject"] == "B2V_ST2_SOC"
    assert (finding["old"], finding["new"]) == ("0.4", "0.5")
    assert finding["level"] == "wire"


def test_an_approved_finding_no_longer_fails_and_a_stale_approval_does(folder: Path) -> None:
    factor = edited(folder, "SOC : 0|8@1+ (0.4,0)", "SOC : 0|8@1+ (0.5,0)")
    report = json.loads(dbcspec(folder, "compare", MAIN, factor, "--json").stdout)
    (folder / "approvals.toml").write_text(
        "[[accepted]]\n"
        f'fingerprint = "{report["findings"][0]["fingerprint"]}"\n'
        'reason = "agreed with the supplier"\n'
        "date = 2020-01-31\n",
        encoding="utf-8",
    )
    approvals = ("--approvals", "approvals.toml")
    assert dbcspec(folder, "compare", MAIN, factor, *approvals).returncode == 0
    assert dbcspec(folder, "compare", MAIN, MAIN, *approvals).returncode == 1


def test_a_revision_of_git_is_a_side_like_any_other(folder: Path) -> None:
    def git(*arguments: str) -> None:
        identity = ("-c", "user.name=x", "-c", "user.email=x@example.org")
        subprocess.run(["git", *identity, *arguments], cwd=folder, check=True, capture_output=True)

    git("init", "-q")
    git("add", ".")
    git("commit", "-q", "-m", "first")
    table = folder / "spec" / "tables" / "05-sop.yaml"
    table.write_text(table.read_text("utf-8").replace("factor: 0.1", "factor: 0.2"), "utf-8")
    same = dbcspec(folder, "compare", "HEAD:spec", f"HEAD:{MAIN}")
    assert (same.returncode, same.stderr) == (0, "")
    changed = dbcspec(folder, "compare", "HEAD:spec", "spec", "--format", "github")
    assert changed.returncode == 1
    assert "::error file=spec/messages.yaml,line=" in changed.stdout
    assert dbcspec(folder, "compare", "nowhere:spec", "spec").returncode == 2


def test_a_matrix_that_was_edited_changes_the_spec_where_it_says_so(folder: Path) -> None:
    assert dbcspec(folder, "matrix", "export", "-o", "m.xlsx").returncode == 0
    assert dbcspec(folder, "matrix", "import", "m.xlsx").returncode == 0
    book = load_workbook(folder / "m.xlsx")
    changed = False
    for row in book["Matrix"].iter_rows() if "Matrix" in book.sheetnames else book.worksheets[1]:
        values = [cell.value for cell in row]
        if "V2B_CMD_VehicleSpeed" in values:
            for cell in row:
                if cell.value == "km/h":
                    cell.value = "mph"
                    changed = True
    assert changed
    book.save(folder / "m.xlsx")
    told = dbcspec(folder, "matrix", "import", "m.xlsx")
    assert told.returncode == 1
    assert "V2B_CMD_VehicleSpeed" in told.stdout
    before = (folder / "spec" / "tables" / "14-vcu-command.yaml").read_text("utf-8")
    assert dbcspec(folder, "matrix", "import", "m.xlsx", "--write-spec").returncode == 0
    after = (folder / "spec" / "tables" / "14-vcu-command.yaml").read_text("utf-8")
    assert after == before.replace("unit: km/h", "unit: mph")
    assert dbcspec(folder, "matrix", "import", "m.xlsx").returncode == 0


def test_a_spec_written_from_a_dbc_makes_the_same_wire(folder: Path) -> None:
    assert dbcspec(folder, "import", MAIN, "--out", "first").returncode == 0
    assert dbcspec(folder, "compare", MAIN, "first", "--fail-on", "additive").returncode == 0
    again = dbcspec(folder, "import", MAIN, "--out", "first")
    assert again.returncode == 2
    assert "is not empty" in again.stderr


def test_stubs_matrix_and_dbc_of_a_foreign_file_work_on_their_own(folder: Path) -> None:
    made = dbcspec(folder, "generate", "--from", "dbc/caamtb-swap-charger.dbc", "--out", "out")
    assert made.returncode == 0, made.stderr
    same = dbcspec(folder, "compare", "dbc/caamtb-swap-charger.dbc", "out/caamtb_swap_charger.dbc")
    assert same.returncode == 0, same.stdout
    program = "from caamtb_swap_charger.messages import B2C_Charger; print(B2C_Charger.FRAME_ID)"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=folder / "out", capture_output=True, check=True
    )
    assert int(done.stdout) == 0x180156F3


@pytest.mark.parametrize("content", [b"", b"\x00\xff\x13rubbish" * 50, b'VERSION ""\n\nBO_ 12'])
def test_a_file_that_is_no_dbc_is_one_line_and_status_two(folder: Path, content: bytes) -> None:
    (folder / "bad.dbc").write_bytes(content)
    done = dbcspec(folder, "compare", MAIN, "bad.dbc")
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "bad.dbc" in done.stderr


def test_a_report_goes_to_a_file_whole_or_not_at_all(folder: Path) -> None:
    unit = edited(folder, '"A" VCU', '"mA" VCU')
    done = dbcspec(folder, "compare", MAIN, unit, "--format", "html", "-o", "report.html")
    assert (done.returncode, done.stdout) == (1, "")
    assert (folder / "report.html").read_text("utf-8").startswith("<!DOCTYPE html>")
    lost = dbcspec(folder, "compare", MAIN, unit, "-o", "no/such/folder/report.txt")
    assert lost.returncode == 2
    assert "cannot be written" in lost.stderr


def test_fix_mends_the_form_of_a_dbc_and_leaves_its_meaning(folder: Path) -> None:
    text = (folder / MAIN).read_bytes().decode("ascii").replace("\r\n", "\n").rstrip("\n")
    (folder / "loose.dbc").write_bytes(text.encode("ascii"))
    done = dbcspec(folder, "lint", "loose.dbc", "--fix", "--select", "dbc-form")
    assert done.returncode == 0, done.stdout
    assert (folder / "loose.dbc").read_bytes() == (folder / MAIN).read_bytes()
