"""Dates as programs write them into logs, in the language of the computer that they ran on."""

from __future__ import annotations

import re
from datetime import datetime

_ENCODINGS = ("utf-8", "cp1252", "gbk", "cp1251", "shift_jis")

_TIME = re.compile(r"(\d{1,2}):(\d{1,2}):(\d{1,2})(?:[.,:](\d{1,9}))?")
_HALF = re.compile(
    r"(?<![^\W\d_])([ap])\.?\s?m(?![^\W\d_])|(上午|午前|오전)|(下午|午後|오후)", re.IGNORECASE
)
_YEAR = re.compile(r"(?<!\d)((?:19|20)\d\d)(?!\d)")
_MONTH_NUMBER = re.compile(r"(\d{1,2})\s?[月월]")
_DAY = re.compile(r"(?<!\d)(\d{1,2})(?!\d)")
_WORD = re.compile(r"[^\W\d_]{3,}")
_YEAR_FIRST = re.compile(r"(?<!\d)((?:19|20)\d\d)\D(\d{1,2})\D(\d{1,2})(?!\d)")
_DAY_FIRST = re.compile(r"(?<!\d)(\d{1,2})[.:](\d{1,2})[.:]((?:19|20)\d\d)(?!\d)")
_MONTH_FIRST = re.compile(r"(?<!\d)(\d{1,2})/(\d{1,2})/((?:19|20)\d\d)(?!\d)")

_MONTHS = (
    "jan gen ene sty янв",
    "feb fév fev lut фев",
    "mar mär mrz mrt maa мар",
    "apr avr abr kwi апр",
    "may mai mag maj mei май мая",
    "jun juin giu cze июн",
    "jul juil lug lip июл",
    "aug août aou ago sie авг",
    "sep set wrz сен",
    "oct okt ott out paź окт",
    "nov lis ноя",
    "dec dez déc dic gru дек",
)


def date_in(text: bytes) -> datetime | None:
    """The date and time in a text of any of the usual encodings, if there is one.

    English, German, French, Italian, Spanish, Portuguese, Dutch, Polish and Russian names of
    months are known, months as numbers in Chinese, Japanese and Korean, and dates in digits.
    """
    for encoding in _ENCODINGS:
        try:
            date = _date(text.decode(encoding))
        except ValueError:
            continue
        if date is not None:
            return date
    return None


def _date(text: str) -> datetime | None:
    """Raises `ValueError` where there is no such day or time."""
    time = _TIME.search(text)
    if time is None:
        return None
    rest = f"{text[: time.start()]} {text[time.end() :]}"
    half = _HALF.search(rest)
    hour = int(time[1])
    if half is not None:
        rest = _HALF.sub(" ", rest)
        hour = hour % 12 + (12 if half[3] or (half[1] or "").lower() == "p" else 0)
    day = _day(rest)
    if day is None:
        return None
    micros = int((time[4] or "0").ljust(6, "0")[:6])
    return datetime(*day, hour, int(time[2]), int(time[3]), micros)


def _day(text: str) -> tuple[int, int, int] | None:
    for pattern, order in (
        (_YEAR_FIRST, (1, 2, 3)),
        (_DAY_FIRST, (3, 2, 1)),
        (_MONTH_FIRST, (3, 1, 2)),
    ):
        if found := pattern.search(text):
            year, month, day = (int(found[place]) for place in order)
            return year, month, day
    year_found = _YEAR.search(text)
    if year_found is None:
        return None
    text = _YEAR.sub(" ", text)
    if number := _MONTH_NUMBER.search(text):
        month = int(number[1])
        text = _MONTH_NUMBER.sub(" ", text)
    else:
        month = _month(text)
    day_found = _DAY.search(text)
    if day_found is None or not month:
        return None
    return int(year_found[1]), month, int(day_found[1])


def _month(text: str) -> int:
    """0 where there is none. The last word counts: a day of the week may look like a month."""
    found = 0
    for word in _WORD.findall(text.lower()):
        for number, begins in enumerate(_MONTHS, 1):
            if word.startswith(tuple(begins.split())):
                found = number
    return found
