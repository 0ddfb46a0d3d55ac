"""What labels of codes say in the words that matter most, in English or Chinese.

A label has a value on each axis that it speaks of: whether a contact is open, whether something is
on, connected, asked for, allowed, locked, or no value at all. Two labels of different languages
whose words stand on different sides of one axis are no translations of each other.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from functools import lru_cache

_LONGEST = 200
"""Characters of a label that are looked at: those of real files have some twenty."""

_WORDS: tuple[tuple[str, dict[str, str]], ...] = (
    # What denies comes first: what it has matched is not looked at again.
    (r"\binvalid|not valid|无效", {"value": "invalid"}),
    (r"\babnormal|异常", {"value": "abnormal"}),
    (r"no (?:fault|error)|\bnormal\b|无故障|正常", {"health": "sound"}),
    (r"\breserved?\b|\bspare\b|预留|保留", {"value": "reserved"}),
    (r"not connected|unconnected|disconnected|未连接", {"connection": "no"}),
    (r"\bconnected|连接", {"connection": "yes"}),
    (r"\bno(?:t)? request(?:ed)?|不请求|无请求", {"request": "no"}),
    (r"\brequest(?:ed)?\b|请求", {"request": "yes"}),
    (r"not allowed|forbidden|prohibited|disallow|不允许|禁止", {"permission": "no"}),
    (r"\ballow(?:ed)?\b|允许", {"permission": "yes"}),
    (r"\bunlock(?:ed)?\b|解锁", {"lock": "no"}),
    (r"\block(?:ed)?\b|上锁|锁止", {"lock": "yes"}),
    (r"\bweld(?:ed|ing)?\b|\bstuck\b|粘连", {"contact": "welded"}),
    # 断开 and 闭合 are said of contacts and of what they switch; 关闭 is "off" and "closed" alike.
    (r"断开", {"contact": "open", "power": "off"}),
    (r"闭合|吸合|接通", {"contact": "closed", "power": "on"}),
    (r"开路|\bopen(?:ed)?\b", {"contact": "open"}),
    (r"\bclosed?\b", {"contact": "closed"}),
    (r"\boff\b|\bdisabled?\b|关闭|关机|下电|下高压|停止|\bstop(?:ped)?\b", {"power": "off"}),
    (r"\bon\b|\benabled?\b|开启|开机|上电|上高压|启动|\bstart(?:ed)?\b", {"power": "on"}),
    (r"\bfaults?\b|\berror\b|\bfail(?:ed|ure)?\b|故障", {"health": "faulty"}),
)
_PATTERN = re.compile("|".join(f"({pattern})" for pattern, _ in _WORDS))


@lru_cache(maxsize=4096)
def senses(label: str) -> Mapping[str, str]:
    """What a label says, by axis; an axis on which it says two things is left out."""
    text = unicodedata.normalize("NFKC", label[:_LONGEST]).casefold().replace("_", " ")
    found: dict[str, str] = {}
    doubtful: set[str] = set()
    for match in _PATTERN.finditer(text):
        for axis, value in _WORDS[(match.lastindex or 1) - 1][1].items():
            if found.setdefault(axis, value) != value:
                doubtful.add(axis)
    return {axis: value for axis, value in found.items() if axis not in doubtful}


def contradict(old: str, new: str) -> bool:
    """Whether two labels stand on different sides of anything."""
    before, after = senses(old), senses(new)
    return any(axis in after and after[axis] != value for axis, value in before.items())


def agree(old: str, new: str) -> bool:
    """Whether two labels say the same of something, and nothing that differs."""
    before, after = senses(old), senses(new)
    shared = before.keys() & after.keys()
    return bool(shared) and all(before[axis] == after[axis] for axis in shared)


def means_no_value(label: str) -> bool:
    """Whether a label says that there is no value: invalid or abnormal."""
    return senses(label).get("value") in ("invalid", "abnormal")


def is_reserved(text: str) -> bool:
    """Whether a name or title says that its bits are reserved."""
    return senses(text).get("value") == "reserved"
