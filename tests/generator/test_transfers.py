"""What the toolchain says, writes and compares of transfers."""

from __future__ import annotations

from dataclasses import fields, replace
from decimal import Decimal
from pathlib import Path

import pytest
from transfer.rack import project, write

from dbcspec.cli import run as dbcspec
from dbcspec.compare.run import compare
from dbcspec.config import Config
from dbcspec.emit.spec import emit_spec
from dbcspec.errors import SpecError
from dbcspec.project import load
from dbcspec.show import find_message, show
from dbcspec.spec.behaviour_rows import TransferRow
from dbcspec.spec.schema import keys_of
from dbcspec.textconv import textconv
from typedcan.model.protocol import Protocol
from typedcan.model.serial import from_json, to_json
from typedcan.model.transfer import Counted, Ending, Numbering, Transfer


def changed(name: str, **facts: object) -> Protocol:
    """The rack with one transfer changed."""
    model = project().protocol
    return replace(
        model,
        transfers=tuple(
            replace(each, **facts) if each.name == name else each  # type: ignore[arg-type]
            for each in model.transfers
        ),
    )


def test_a_generated_package_carries_all_that_a_spec_says_of_transfers() -> None:
    model = project().protocol
    assert from_json(to_json(model), "here").transfers == model.transfers
    by_name = {transfer.name: transfer for transfer in model.transfers}
    assert by_name["name"].length is Ending.TO_FILL
    assert by_name["key"].counted is Counted.FRAMES
    assert by_name["weights"].numbering is Numbering.WITHIN_GROUP
    assert (by_name["heats"].counts, by_name["heats"].timeout) == ((4, 3, 2), Decimal(2))


def test_a_spec_that_is_written_of_a_model_has_the_same_transfers(tmp_path: Path) -> None:
    model = project().protocol
    for name, content in emit_spec(model).items():
        path = tmp_path / "spec" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    again = load(Config(root=tmp_path, name="rack", spec="spec"))
    assert again.protocol.transfers == model.transfers


def test_the_kind_that_is_left_out_follows_from_groups_and_frame_numbers(tmp_path: Path) -> None:
    folder = write(tmp_path / "rack")
    path = folder / "spec" / "behaviour.yaml"
    lines = path.read_text("utf-8").splitlines()
    kept = [line for line in lines if not line.strip().startswith("kind: ") or "blocks" in line]
    assert len(lines) - len(kept) == 4
    path.write_text("\n".join(kept), "utf-8")
    found = load(Config(root=folder, name="rack", spec="spec")).protocol.transfers
    assert found == project().protocol.transfers


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("kind: numbered_blocks", "kind: telegram", "expected one of text_over_frames, "),
        ("encoding: gbk", "encoding: rot13", "expected one of ascii, latin-1, "),
        ("numbering: through", "numbering: backwards", "expected one of within_group, through"),
        ("items: [Name_B1,", "items: [Name_B9,", "items: there is no 'Name_B9'"),
        ("details: [Key_Id]", "details: [Key_No]", "details: there is no 'Key_No'"),
    ],
)
def test_what_a_spec_cannot_say_is_refused_with_its_place(
    old: str, new: str, text: str, tmp_path: Path
) -> None:
    folder = write(tmp_path / "rack")
    path = folder / "spec" / "behaviour.yaml"
    path.write_text(path.read_text("utf-8").replace(old, new), "utf-8")
    with pytest.raises(SpecError) as error:
        load(Config(root=folder, name="rack", spec="spec"))
    assert text in str(error.value)
    assert "behaviour.yaml:" in str(error.value)


def test_show_says_of_a_message_what_it_carries_parts_of() -> None:
    model = project().protocol
    lines = show(model, find_message(model, "HEATS")).splitlines()
    begin = next(n for n, line in enumerate(lines) if line.startswith("Transfer heats: "))
    assert lines[begin].startswith("Transfer heats: Temperature of every place, measured values")
    assert "    counts: 4, 3, 2" in lines
    assert "    numbering: through" not in lines  # it is what is meant where nothing is said
    assert "Transfer weights: Weight on every place" in show(model, find_message(model, "TOTALS"))
    assert "Transfer" not in show(model, find_message(model, "ASK"))


def test_textconv_has_a_line_for_each_fact() -> None:
    lines = textconv(project().protocol).splitlines()
    assert "transfer heats: count 4" in lines
    assert "transfer name: encoding gbk" in lines
    assert 'transfer name: english "Name of the rack"' in lines
    assert "transfer key: detail Key_Id" in lines


@pytest.mark.parametrize(
    ("name", "facts", "rule", "text"),
    [
        ("name", {"encoding": "utf-8"}, "transfer-layout-same", "encoding gbk → encoding utf-8"),
        ("name", {"first_number": 1}, "transfer-layout-same", "first number 0 → first number 1"),
        ("key", {"kind": "text_over_frames"}, "transfer-layout-same", "kind numbered_blocks → "),
        ("heats", {"counts": (4, 4)}, "transfer-layout-same", "counts 4, 3, 2 → counts 4, 4"),
        ("heats", {"period": None}, "transfer-layout-same", "period 500 → period none"),
        ("heats", {"timeout": Decimal(3)}, "transfer-reception-same", "timeout of transfer 2 → 3"),
        ("heats", {"column": "warmth"}, "transfer-name-same", "column of transfer heat → warmth"),
    ],
)
def test_compare_tells_what_a_change_of_a_transfer_breaks(
    name: str, facts: dict[str, object], rule: str, text: str
) -> None:
    [item] = compare(project().protocol, changed(name, **facts))
    assert (item.rule, item.subject) == (rule, name)
    assert text in item.text
    assert item.level == ("wire" if rule == "transfer-layout-same" else "source")


def test_load_counts_the_frames_that_the_spec_fixes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(write(tmp_path / "rack"))
    assert dbcspec(["load", "--items", "weights=6"]) == 0
    out = capsys.readouterr().out
    rows = {line.split()[0]: line.split() for line in out.splitlines() if line}
    # 5 frames of HEATS in 500 ms are one in each 50 ms; the name takes 3 in its 500 ms.
    assert [rows[name][3] for name in ("NAME", "WEIGHTS", "HEATS", "CURVE")] == ["3", "3", "1", "3"]
    assert "weights: up to 422 items with every message in time" in out
    assert "heats: up to" not in out


def test_the_parameters_are_those_of_the_yaml() -> None:
    assert {part.name for part in fields(Transfer)} | {"cite"} == set(keys_of(TransferRow))
