"""docs/ci.md from start to end: a pull request, its comment, an approval from it, a green run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from report.test_ci_guide import blocks

SECOND = Path(__file__).parents[1] / "fixtures" / "second"
GH = '#!/bin/sh\nfor last; do :; done\ncp "$last" "$COMMENTS/comment.md"\n'
"""Stands for GitHub's command: the file that is last on its line becomes the comment."""

COMMAND = '#!/bin/sh\nexec "{python}" -m dbcspec "$@"\n'


class Pull:
    """A repository with a pull request, and the steps of the guide to run on it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "project"
        tools = folder / "bin"
        tools.mkdir()
        for name, text in (("gh", GH), ("dbcspec", COMMAND.format(python=sys.executable))):
            (tools / name).write_text(text, "utf-8")
            (tools / name).chmod(0o755)
        self.environment = {
            **os.environ,
            "PATH": f"{tools}{os.pathsep}{os.environ['PATH']}",
            "COMMENTS": str(folder),
            "GITHUB_STEP_SUMMARY": str(folder / "summary.md"),
            "NUMBER": "7",
        }
        self.comment = folder / "comment.md"
        self.summary = folder / "summary.md"

    def shell(self, script: str) -> subprocess.CompletedProcess[str]:
        """Run a script as GitHub runs a step."""
        return subprocess.run(
            ["bash", "-e", "-o", "pipefail", "-c", script],
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            encoding="utf-8",
            check=False,
        )

    def done(self, script: str) -> str:
        result = self.shell(script)
        assert result.returncode == 0, result.stderr
        return result.stdout.strip()

    def commit(self) -> str:
        author = "git -c user.name=t -c user.email=t@example.invalid"
        self.done(f"git add -A && {author} commit -q -m change")
        return self.done("git rev-parse HEAD")

    def verdict(self) -> subprocess.CompletedProcess[str]:
        """Every step that runs `dbcspec`, until one fails; the comment before the verdict."""
        (workflow,) = blocks("github-workflow")
        steps = [
            step.get("run", "") for step in yaml.safe_load(workflow)["jobs"]["protocol"]["steps"]
        ]
        ((comment,),) = (yaml.safe_load(b) for b in blocks("github-step") if "gh pr" in b)
        scripts = [script for script in steps if "dbcspec" in script]
        for script in [*scripts[:-1], comment["run"], scripts[-1]]:
            result = self.shell(script)
            if result.returncode:
                break
        return result


@pytest.fixture
def pull(tmp_path: Path) -> Pull:
    made = Pull(tmp_path)
    shutil.copytree(SECOND, made.folder)
    (made.folder / "approvals.toml").touch()
    made.done("git init -q && dbcspec generate")
    made.environment["BASE"] = made.commit()
    return made


def change_a_factor(pull: Pull) -> None:
    """Something that old devices misread."""
    for path in sorted(pull.folder.glob("spec/tables/*.yaml")):
        text = path.read_text("utf-8")
        changed = re.sub(r"(\bfactor: |, )0\.1\b", r"\g<1>0.2", text, count=1)
        if changed != text:
            path.write_text(changed, "utf-8")
            return
    raise AssertionError("no factor of 0.1")


def test_a_wire_change_is_stopped_told_in_a_comment_approved_from_it_and_green(pull: Pull) -> None:
    change_a_factor(pull)
    pull.done("dbcspec generate")
    pull.commit()
    stopped = pull.verdict()
    assert stopped.returncode == 1, stopped.stderr
    assert stopped.stdout.startswith("::error file=spec/")
    comment = pull.comment.read_text("utf-8")
    assert comment in pull.summary.read_text("utf-8")

    rows = [line.strip("| ").split(" | ") for line in comment.splitlines() if "**wire**" in line]
    rows = [row for row in rows if len(row) == 7]
    assert rows
    approvals = "".join(
        f'[[accepted]]\nfingerprint = "{fingerprint}"\nrule = "{rule}"\n'
        'reason = "Measured again."\ndate = 2031-04-30\n\n'
        for *_, rule, _, fingerprint in rows
    )
    (pull.folder / "approvals.toml").write_text(approvals, "utf-8")
    pull.commit()
    green = pull.verdict()
    assert green.returncode == 0, green.stdout
    assert "**wire**" not in pull.comment.read_text("utf-8")


def test_an_approval_of_another_change_does_not_let_this_one_pass(pull: Pull) -> None:
    change_a_factor(pull)
    pull.done("dbcspec generate")
    (pull.folder / "approvals.toml").write_text(
        '[[accepted]]\nfingerprint = "00000000"\nreason = "x"\ndate = 2031-04-30\n', "utf-8"
    )
    pull.commit()
    stopped = pull.verdict()
    assert stopped.returncode == 1
    assert "approvals.toml" in stopped.stdout


def test_a_stale_file_stops_the_run_and_the_last_line_mends_it(pull: Pull) -> None:
    change_a_factor(pull)
    stopped = pull.verdict()
    assert stopped.returncode == 1
    *_, last = stopped.stderr.splitlines()
    found = re.fullmatch(r"\d+ of \d+ files are not current: (dbcspec generate) writes them", last)
    assert found, last
    pull.done(found[1])
    assert pull.done("dbcspec check").endswith(tuple("0123456789abcdef"))
