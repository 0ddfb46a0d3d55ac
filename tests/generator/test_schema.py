"""Nodes become typed records; what does not fit is a fault with its place, all faults at once."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
import yaml

from dbcspec.emit.json_schema import emit_json_schemas
from dbcspec.errors import SpecError
from dbcspec.spec.rows import DOCUMENTS, Messages, SameCodes, SignalRow, SignalTable
from dbcspec.spec.schema import (
    DECIMAL,
    INTEGER,
    NAME,
    RANGE,
    ROUTE,
    TEXT,
    Kind,
    list_of,
    map_of,
    one_of,
    whole_number,
)
from dbcspec.spec.source import compose


def faults(read: Callable[[Any], object], text: str) -> list[str]:
    with pytest.raises(SpecError) as caught:
        read(compose(text, "t"))
    return [str(fault) for fault in caught.value.faults]


@pytest.mark.parametrize(
    ("kind", "text", "value"),
    [
        (TEXT, "OFF", "OFF"),
        (TEXT, '""', ""),
        (INTEGER, "255", 255),
        (INTEGER, "-3", -3),
        (INTEGER, "007", 7),
        (INTEGER, "0x18FF45f4", 0x18FF45F4),
        (INTEGER, "0X18FFF8A7", 0x18FFF8A7),
        (DECIMAL, "0.001", Decimal("0.001")),
        (DECIMAL, "-1000", Decimal(-1000)),
        (NAME, "B2V_ST2", "B2V_ST2"),
        (RANGE, "-1000~5553.5", (Decimal(-1000), Decimal("5553.5"))),
        (ROUTE, "BSS>BMU,VCU", ("BSS", ("BMU", "VCU"))),
        (one_of("Intel", "Motorola"), "Motorola", "Motorola"),
        (whole_number(1, 64), "64", 64),
        (list_of(INTEGER), "[1, 0x2]", (1, 2)),
        (map_of(INTEGER, TEXT), "{1: ON, 0: OFF}", {1: "ON", 0: "OFF"}),
    ],
)
def test_a_value_of_the_right_kind_is_read(kind: Kind, text: str, value: object) -> None:
    assert kind.read(compose(text, "t")) == value


@pytest.mark.parametrize(
    ("kind", "text", "expected"),
    [
        (INTEGER, "1.5", "expected a whole number, not '1.5'"),
        (INTEGER, "0b11", "expected a whole number, not '0b11'"),
        (INTEGER, "''", "expected a whole number, not ''"),
        (INTEGER, "1_000", "expected a whole number, not '1_000'"),
        (DECIMAL, "1e-3", "expected a plain decimal number, not '1e-3'"),
        (DECIMAL, "'0,4'", "expected a plain decimal number, not '0,4'"),
        (DECIMAL, ".5", "expected a plain decimal number, not '.5'"),
        (NAME, "2nd", "expected a name (letters, digits, underscore), not '2nd'"),
        (NAME, "温度", "expected a name (letters, digits, underscore), not '温度'"),
        (RANGE, "0-255", "expected a range such as 0~255, not '0-255'"),
        (one_of("Intel", "Motorola"), "intel", "expected one of Intel, Motorola, not 'intel'"),
        (whole_number(1, 64), "0", "0 is out of range; allowed are 1 to 64"),
        (whole_number(1, 64), "65", "65 is out of range; allowed are 1 to 64"),
        (TEXT, "[a]", "expected a single value, not a list or mapping"),
        (list_of(TEXT), "a", "expected a list"),
        (map_of(TEXT, TEXT), "[a]", "expected a mapping (key: value)"),
    ],
)
def test_a_value_of_another_kind_is_a_fault_that_says_what_was_expected(
    kind: Kind, text: str, expected: str
) -> None:
    assert faults(kind.read, text) == [f"t:1:1: {expected}"]


@pytest.mark.parametrize("text", ["BMU", "BMU->VCU", "BMU>VCU>TMS", "BMU>", "BMU>VCU, TMS"])
def test_what_is_no_route_is_a_fault_with_an_example(text: str) -> None:
    (fault,) = faults(ROUTE.read, f'"{text}"')
    assert fault.startswith("t:1:1: expected a route such as ECU1>ECU2")


def test_every_faulty_item_of_a_list_or_mapping_is_reported() -> None:
    assert faults(list_of(INTEGER).read, "[1, x, 2, y]") == [
        "t:1:5: expected a whole number, not 'x'",
        "t:1:11: expected a whole number, not 'y'",
    ]
    assert faults(map_of(INTEGER, INTEGER).read, "{1: x, y: 2}") == [
        "t:1:5: expected a whole number, not 'x'",
        "t:1:8: expected a whole number, not 'y'",
    ]


def test_two_spellings_of_one_code_are_a_repetition() -> None:
    assert faults(map_of(INTEGER, TEXT).read, "{16: A, 0x10: B}") == [
        "t:1:9: key 0x10 stands here twice"
    ]


def test_a_record_reports_all_its_faults_in_the_order_of_the_file() -> None:
    text = "no: one\nlenght: 8\nfactor: 1/2\nrange: 0~x\n"
    assert faults(SignalRow.read, text) == [
        "t:1:5: expected a whole number, not 'one'",
        "t:2:1: unknown key 'lenght'; did you mean 'length'?",
        "t:3:9: expected a plain decimal number, not '1/2'",
        "t:4:8: expected a range such as 0~255, not '0~x'",
    ]


def test_an_unknown_key_like_no_other_is_answered_with_all_that_are_known() -> None:
    (fault,) = faults(SignalRow.read, "no: 1\nxyz: 1\n")
    assert fault.startswith("t:2:1: unknown key 'xyz'; known: no, name, ")
    assert fault.endswith(", range, route")


def test_a_missing_key_is_reported_at_the_place_of_the_record() -> None:
    text = "byte_order: Intel\nannex: A.1\nmessages:\n  - name: X\n    signals: []\n"
    assert faults(Messages.read, text) == ["t:4:5: key 'id' is missing"]


def test_faults_of_nested_records_are_gathered() -> None:
    text = "number: x\nclause: 1\nrows:\n  - no: 1\n    factor: y\n  - {name: Z}\n"
    assert faults(SignalTable.read, text) == [
        "t:1:9: expected a whole number, not 'x'",
        "t:5:13: expected a plain decimal number, not 'y'",
        "t:6:5: key 'no' is missing",
    ]


def test_what_a_record_leaves_out_is_absent_and_not_zero() -> None:
    row = SignalRow.read(compose("no: 4\nname: Speed\n", "t"))
    assert (row.no, row.name, row.title) == (4, "Speed", "")
    assert (row.length, row.factor, row.offset, row.range, row.unit, row.route) == (None,) * 6


def test_a_record_knows_where_its_keys_stand() -> None:
    row = SignalRow.read(compose("no: 4\nname: Speed\n", "t"))
    assert str(row.where_is("name")) == "t:2:7"
    assert str(row.where_is("factor")) == "t:1:1"


def test_a_code_cell_may_refer_to_another_row() -> None:
    assert SignalRow.read(compose("no: 1\ncodes: {same_as: X}", "t")).codes == SameCodes("X")
    assert SignalRow.read(compose("no: 1\ncodes: {0: same_as}", "t")).codes == {0: "same_as"}


SCHEMAS = {name: json.loads(text) for name, text in emit_json_schemas(DOCUMENTS).items()}


def test_the_json_schemas_accept_the_spec_as_an_editor_reads_it(root: Path) -> None:
    checked = set()
    for path in sorted((root / "spec").rglob("*.yaml")):
        schema = re.search(r"\$schema=.*?([\w-]+\.json)", path.read_text("utf-8"))
        assert schema, path.name
        checked.add(schema[1])
        document = as_an_editor_reads(yaml.load(path.read_text("utf-8"), Loader=yaml.BaseLoader))
        assert list(complaints(document, SCHEMAS[schema[1]], path.name)) == []
    assert checked == set(SCHEMAS) - {"database.json"}  # the standard has no DBC of its own


@pytest.mark.parametrize(
    ("schema", "document"),
    [
        ("table.json", {"number": 1, "clause": "1", "rows": [{"name": "no number"}]}),
        ("table.json", {"number": 1, "clause": "1", "rows": [{"no": 1, "lenght": 8}]}),
        ("table.json", {"number": 1, "clause": "1", "rows": [{"no": 1, "range": "0-9"}]}),
        ("messages.json", {"annex": "A", "byte_order": "intel", "messages": []}),
        ("errata.json", {"errata": {}}),
    ],
)
def test_the_json_schemas_refuse_what_the_reader_refuses(schema: str, document: object) -> None:
    assert list(complaints(document, SCHEMAS[schema], "document"))
    record = DOCUMENTS[schema.removesuffix(".json")]
    with pytest.raises(SpecError):
        record.read(compose(json.dumps(document), "t"))


def as_an_editor_reads(value: Any) -> Any:
    """Text to numbers where they are whole, as YAML 1.2 has it; yes, no, on and off stay text."""
    if isinstance(value, dict):
        return {key: as_an_editor_reads(part) for key, part in value.items()}
    if isinstance(value, list):
        return [as_an_editor_reads(part) for part in value]
    return int(value) if re.fullmatch(r"-?\d+", value) else value


_TYPES: dict[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "boolean": bool,
    "null": type(None),
}


def complaints(value: Any, schema: dict[str, Any], place: str) -> Iterator[str]:
    """What JSON Schema, as far as the emitted schemas use it, has against a value."""
    known = {"type", "enum", "pattern", "properties", "additionalProperties", "required", "items"}
    assert set(schema) <= known | {"$schema", "title", "description", "minimum", "maximum"}
    kinds = schema.get("type", list(_TYPES))
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if not any(isinstance(value, _TYPES[kind]) for kind in kinds):
        yield f"{place}: {value!r} is none of {kinds}"
    elif isinstance(value, dict):
        properties = schema.get("properties", {})
        others = schema.get("additionalProperties", {})
        missing = [key for key in schema.get("required", ()) if key not in value]
        yield from (f"{place}: {key} missing" for key in missing)
        for key, part in value.items():
            rule = properties.get(key, others)
            if rule is False:
                yield f"{place}: {key} unknown"
            else:
                yield from complaints(part, rule, f"{place}/{key}")
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from complaints(part, schema.get("items", {}), f"{place}/{index}")
    elif isinstance(value, str) and not re.search(schema.get("pattern", ""), value):
        yield f"{place}: {value!r} has not the shape {schema['pattern']}"
    elif "enum" in schema and value not in schema["enum"]:
        yield f"{place}: {value!r} is none of {schema['enum']}"
    elif isinstance(value, int) and not (
        schema.get("minimum", value) <= value <= schema.get("maximum", value)
    ):
        yield f"{place}: {value} is out of range"
