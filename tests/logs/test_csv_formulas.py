"""A spreadsheet that opens a CSV file calculates nothing of what a database says."""

from __future__ import annotations

import csv
from pathlib import Path

import pyarrow as pa

from typedcan.logs.write.csv import CsvFile

LABELS = ["=1+1", "+49", "-1 means off", "@sum", "plain", "a=b"]


def test_names_and_labels_that_begin_as_formulas_have_an_apostrophe(tmp_path: Path) -> None:
    codes = pa.array([0, 1, 2, 3, 4, 5], pa.int8())
    labels = pa.DictionaryArray.from_arrays(codes, pa.array(LABELS))
    table = pa.table({"=cmd()": pa.array(LABELS), "label": labels, "value": [-1.5] * 6})
    file = CsvFile(tmp_path / "x.csv", table.schema)
    file.write(table)
    file.close()
    with (tmp_path / "x.csv").open(newline="", encoding="utf-8") as written:
        header, *rows = csv.reader(written)
    guarded = ["'=1+1", "'+49", "'-1 means off", "'@sum", "plain", "a=b"]
    assert header == ["'=cmd()", "label", "value"]
    assert rows == [[text, text, "-1.5"] for text in guarded]
