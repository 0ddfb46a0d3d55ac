"""Labels of codes in two languages: which say the opposite, and which nobody can tell."""

from __future__ import annotations

import pytest

from dbcspec.compare.senses import agree, contradict, is_reserved, means_no_value


@pytest.mark.parametrize(
    ("chinese", "same", "opposite"),
    [
        ("加热断开", "Heat Off", "Heat On"),
        ("闭合", "Closed", "Open"),
        ("断开状态", "Open", "Closed"),
        ("开路故障", "Opened", "Weld"),
        ("粘连", "Stuck", "Opened"),
        ("未连接", "Not connected", "Connected"),
        ("连接", "connected", "disconnected"),
        ("不请求下高压", "No Request HV Off", "Request HV Off"),
        ("上高压请求", "Request HV on", "Request HV off"),
        ("禁止充电", "Charging forbidden", "Charging allowed"),
        ("允许充电", "Allowed", "Not allowed"),
        ("解锁成功", "Unlocked", "Locked"),
        ("上锁成功", "Locked", "Unlocked"),
        ("高压下电", "HV_OFF", "HV_ON"),
        ("开启", "Enabled", "Disabled"),
        ("停止", "Stopped", "Started"),
        ("信号无效", "Signal Invalid", "Abnormal"),
        ("异常", "Abnormal", "Reserved"),
        ("无故障", "Normal", "Fault"),
        ("故障", "Error", "No error"),
        ("保留", "Spare", "Not valid"),
    ],
)
def test_a_label_agrees_with_its_translation_and_contradicts_the_opposite(
    chinese: str, same: str, opposite: str
) -> None:
    assert agree(chinese, same)
    assert not contradict(chinese, same)
    assert contradict(chinese, opposite)
    assert contradict(opposite, chinese)
    assert not agree(chinese, opposite)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("关闭", "Closed"),  # said of a valve it is the same, said of a pump it is off
        ("未解锁未上锁", "Unlocked"),
        ("自循环", "On"),
        ("无故障", "Inactive"),
        ("", "Off"),
        ("Location", "Off"),
        ("Offset", "On"),
    ],
)
def test_what_nobody_can_tell_neither_agrees_nor_contradicts(old: str, new: str) -> None:
    assert not agree(old, new)
    assert not contradict(old, new)


def test_no_value_and_reserved_are_words_and_not_parts_of_others() -> None:
    assert means_no_value("Signal Invalid")
    assert means_no_value(" 异常;")
    assert not means_no_value("Normal")
    assert is_reserved("预留")
    assert is_reserved("B2V_Reserve".lower())
    assert not is_reserved("preserved")


def test_a_label_of_any_length_costs_what_a_short_one_costs() -> None:
    assert contradict("on" + " x" * 10**6, "off")
