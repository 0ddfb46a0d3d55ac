"""The JSON report as a program reads it."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from judge.report_samples import BEGIN, EMPTY, GOOD, HOSTILE, PLAIN, hostile, odd

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import Judgement
from typedcan.judge.report import as_json, to_json
from typedcan.report.language import Text


def read(*judgements: Judgement, language: Any = "en") -> dict[str, Any]:
    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is no JSON")

    text = to_json(judgements, language)
    document = json.loads(text.encode("utf-8"), parse_constant=refuse)
    assert isinstance(document, dict)
    return document


def test_verdicts_are_words_for_machines() -> None:
    document = read(PLAIN, GOOD, EMPTY)
    assert document["verdict"] == "violates"
    verdicts = [log["verdict"] for log in document["logs"]]
    assert verdicts == ["violates", "conforms", "not_judged"]
    assert document["protocol"] == {"name": PROTOCOL.name, "digest": PROTOCOL.digest}


def test_a_log_says_what_it_is() -> None:
    plain, good = read(PLAIN, GOOD)["logs"]
    assert plain["begin"] == BEGIN
    assert plain["begin_utc"] == "2023-11-14T22:13:20.000000Z"
    assert good["begin_utc"] is None
    assert list(plain["frames"].items()) == [("", 12), ("B2V_ST1", 100), ("B2V_ST2", 600)]
    assert (plain["nodes"], plain["seen"]) == (["BMU", "VCU"], ["BMU", "CHG"])
    assert plain["damage"] == list(PLAIN.damage)


def test_every_rule_has_its_status_and_the_tolerances_in_force() -> None:
    rules = read(PLAIN)["logs"][0]["rules"]
    assert [rule["id"] for rule in rules] == [each.rule.id for each in PLAIN.results]
    statuses = [rule["status"] for rule in rules]
    assert statuses == ["failed", "failed", "noted", "passed", "not_judged"]
    severities = [rule["severity"] for rule in rules]
    assert severities == ["must", "should", "info", "must", "must"]
    (tolerance,) = rules[0]["tolerances"]
    assert (tolerance["value"], tolerance["default"], tolerance["unit"]) == (0.75, 0.5, "s")
    assert (rules[0]["count"], rules[0]["frames"], rules[0]["examined"]) == (1234, 3702, 1000)


def test_an_occurrence_has_all_that_is_known_of_it() -> None:
    rule = read(PLAIN)["logs"][0]["rules"][0]
    assert rule["occurrences"][0] == {
        "node": "BMU",
        "message": "B2V_ST2",
        "signal": "B2V_ST2_SOC",
        "detail": "frame 3",
        "start": 2.5,
        "end": 2.75,
        "order": 250,
        "frames": 3,
        "measure": 1.0,
        "text": "step of 0.25 s",
        "values": {"step": 0.25, "said": ""},
        "is_open": False,
        "errata": [],
    }
    assert rule["worst"] == rule["occurrences"][1]


def test_numbers_have_no_noise_and_what_is_none_is_null() -> None:
    values = {
        "third": 1 / 3,
        "sum": 0.1 + 0.2,
        "nothing": math.nan,
        "endless": math.inf,
        "whole": np.int64(7),
        "is": True,
        "label": Text("Off", "断开"),
    }
    ((log,), chinese) = (read(odd(values))["logs"], read(odd(values), language="zh"))
    given = log["rules"][0]["occurrences"][0]["values"]
    assert {name: given[name] for name in values} == {
        "third": 0.333333333,
        "sum": 0.3,
        "nothing": None,
        "endless": None,
        "whole": 7,
        "is": True,
        "label": "Off",
    }
    assert chinese["logs"][0]["rules"][0]["occurrences"][0]["values"]["label"] == "断开"


def test_a_message_without_steps_has_null_for_them() -> None:
    none = replace(PLAIN.periods[0], mean=math.nan, longest=math.nan)
    (periods,) = read(replace(PLAIN, periods=(none,)))["logs"][0]["periods"]
    assert (periods["mean"], periods["longest"], periods["shortest"]) == (None, None, 0.08)
    assert periods["spans"]["high"] == [0.11, 0.12, 0.11, 0.5, 0.11, 0.11]


@pytest.mark.parametrize("text", HOSTILE)
def test_any_text_arrives_as_it_was(text: str) -> None:
    (log,) = read(hostile(text))["logs"]
    assert log["log"] == text
    assert log["rules"][0]["title"] == text
    assert log["rules"][0]["occurrences"][0]["signal"] == text
    assert log["load"][0]["channel"] == text


def test_texts_come_in_the_language_asked_for_and_in_their_own_characters() -> None:
    text = to_json([PLAIN], "zh")
    assert '"language": "zh"' in text
    assert "间隔 0.25 s" in text
    assert "step of" not in text


def test_every_key_is_documented() -> None:
    def keys(value: Any) -> set[str]:
        if isinstance(value, list):
            return {key for each in value for key in keys(each)}
        if not isinstance(value, dict):
            return set()
        inner = [keys(each) for name, each in value.items() if name not in ("values", "frames")]
        return set(value).union(*inner)

    said = as_json.__doc__ or ""
    undocumented = {key for key in keys(read(PLAIN)) if f"``{key}``" not in said}
    assert undocumented == set()
