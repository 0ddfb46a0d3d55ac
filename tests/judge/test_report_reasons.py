"""Why a rule was not judged, in every format; such a rule is never said to have passed."""

from __future__ import annotations

import csv
import io
import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import pytest
from judge.report_samples import GOOD

from swapcan.conform import Judgement, Status
from typedcan.judge.report import to_csv, to_html, to_json, to_junit
from typedcan.judge.report.terminal import summary

OCCASION = "nothing came that it could examine"
ABSENT = "no frame of VCU, which it judges"
UNWANTED = "it is about BMU, VCU, not among the judged nodes"

JUDGEMENTS = {
    OCCASION: GOOD,
    ABSENT: replace(GOOD, nodes=("VCU", "TMS"), seen=("TMS",)),
    UNWANTED: replace(GOOD, nodes=("TMS",), seen=("TMS",)),
}

over_reasons = pytest.mark.parametrize(
    ("reason", "judgement"), JUDGEMENTS.items(), ids=["occasion", "absent", "unwanted"]
)


@over_reasons
def test_every_format_says_why(reason: str, judgement: Judgement) -> None:
    (idle,) = judgement.of_status(Status.NOT_JUDGED)
    name = idle.rule.id
    text = " ".join("\n".join(summary([judgement], "en", colour=False, verbose=True)).split())
    assert re.search(f"not judged, 1: {re.escape(reason)}[^:]*(: what[^:]*)?: {name}", text)
    (rule,) = [
        each
        for each in json.loads(to_json([judgement], "en"))["logs"][0]["rules"]
        if each["id"] == name
    ]
    assert rule["status"] == "not_judged"
    assert rule["reason"].startswith(reason)
    case = ET.fromstring(to_junit([judgement], "en")).find(f".//testcase[@name='{name}']")
    assert case is not None
    skipped = case.find("skipped")
    assert skipped is not None
    assert skipped.get("message", "").startswith(reason)
    (row,) = csv.DictReader(io.StringIO(to_csv([judgement], "en")))
    assert (row["rule"], row["status"]) == (name, "not_judged")
    assert row["text"].startswith(reason)
    assert reason in to_html([judgement], [()], "en", {})


@over_reasons
def test_chinese_reports_say_it_in_chinese(reason: str, judgement: Judgement) -> None:
    document = json.loads(to_json([judgement], "zh"))
    (said,) = [each["reason"] for each in document["logs"][0]["rules"] if each["reason"]]
    assert reason not in said
    assert not re.search(r"[a-z]{3}", said)


def test_rules_that_were_judged_have_no_reason() -> None:
    rules = json.loads(to_json([GOOD], "en"))["logs"][0]["rules"]
    assert {each["reason"] for each in rules if each["status"] != "not_judged"} == {""}
