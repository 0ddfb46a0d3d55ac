"""docs/ci.md and the hooks that it describes hold together."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

from dbcspec.compare.approvals import read_approvals
from typedcan.report.formats import FORMATS
from typedcan.report.item import LEVELS
from typedcan.report.texts import MEANINGS

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "docs" / "ci.md").read_text("utf-8")
HOOKS: list[dict[str, Any]] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))


def blocks(kind: str) -> list[str]:
    """The fenced blocks marked as being of a kind."""
    found = re.findall(
        rf"<!-- validate: {kind} -->\n```\w+\n(.*?)^```", GUIDE, re.DOTALL | re.MULTILINE
    )
    assert found, kind
    return found


def test_every_format_is_described_and_every_described_format_is_there() -> None:
    section = GUIDE.split("## Formats")[1].split("##")[0]
    assert set(re.findall(r"^\| `(\w+)`", section, re.MULTILINE)) == set(FORMATS)
    assert set(re.findall(r"--format (\w+)", GUIDE)) - {"NAME"} <= set(FORMATS)
    assert set(re.findall(r"--fail-on (\w+)", GUIDE)) <= set(LEVELS)


def test_the_classes_mean_what_reports_say_of_them() -> None:
    rows = dict(re.findall(rf"^\| ({'|'.join(LEVELS)}) \| (.*) \|$", GUIDE, re.MULTILINE))
    assert rows == MEANINGS


def test_hooks_of_the_guide_are_those_of_the_repository() -> None:
    (config,) = blocks("pre-commit-config")
    (repository,) = yaml.safe_load(config)["repos"]
    assert {hook["id"] for hook in repository["hooks"]} == {hook["id"] for hook in HOOKS}
    (override,) = yaml.safe_load(blocks("pre-commit-hook")[0])
    (declared,) = (hook for hook in HOOKS if hook["id"] == override["id"])
    assert len(declared["args"]) <= len(override["args"])


@pytest.mark.parametrize("hook", HOOKS, ids=lambda hook: str(hook["id"]))
def test_a_hook_installs_the_command_that_it_runs(hook: dict[str, Any]) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    command, subcommand = hook["entry"].split()
    assert command in project["scripts"]
    assert hook["id"] == f"{command}-{subcommand}"
    (extra,) = hook["additional_dependencies"]
    assert extra.strip(".[]") in project["optional-dependencies"]


def test_workflows_read_the_base_from_git_and_end_with_the_verdict() -> None:
    (workflow,) = blocks("github-workflow")
    job = yaml.safe_load(workflow)["jobs"]["protocol"]
    assert job["steps"][0]["with"]["fetch-depth"] == 0
    assert job["steps"][-1]["run"].rstrip().endswith("--fail-on wire")
    for block in blocks("github-step"):
        assert all("run" in step or "uses" in step for step in yaml.safe_load(block))
    (gitlab,) = blocks("gitlab-ci")
    script = yaml.safe_load(gitlab)["protocol"]["script"]
    assert script[-1].endswith("--fail-on wire")
    reports = [line for line in script if "--output" in line]
    assert reports
    assert all(line.endswith("|| test $? -eq 1") for line in reports)


def test_the_example_of_an_approval_is_one(tmp_path: Path) -> None:
    path = tmp_path / "approvals.toml"
    path.write_text(blocks("approvals")[0], encoding="utf-8")
    (approval,) = read_approvals(path)
    assert approval.fingerprint == "1f0c9a77"
    assert approval.subject == "Speed"
