"""Findings of a comparison that somebody has accepted, with the reason, in a TOML file.

::

    [[accepted]]
    fingerprint = "1f0c9a77"
    reason = "The supplier measured the range again."
    date = 2031-04-30
    rule = "signal-scale-same"        # for the reader; checked where given
    subject = "ECU1_Status_Speed"     # the same
"""

from __future__ import annotations

import datetime
import re
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from typedcan.model.errors import Location, ReadError
from typedcan.report.item import Item, RuleInfo

APPROVAL_USED = RuleInfo("approval-used", "An approval accepts a finding that is there.", "error")
"""The rule over approvals themselves."""

_HEADER = re.compile(r"\s*\[\[\s*accepted\s*\]\]")
_NEEDED = ("fingerprint", "reason", "date")
_KEYS = (*_NEEDED, "rule", "subject")
_FINGERPRINT = re.compile(r"[0-9a-f]{8}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Approval:
    """One accepted finding; ``rule`` and ``subject`` are empty where the file has none."""

    fingerprint: str
    reason: str
    date: datetime.date
    rule: str = ""
    subject: str = ""
    where: Location

    def accepts(self, item: Item) -> bool:
        """Whether this is the finding that was accepted."""
        return (
            item.fingerprint == self.fingerprint
            and self.rule in ("", item.rule)
            and self.subject in ("", item.subject)
        )


def read_approvals(path: Path, shown_as: str | None = None) -> tuple[Approval, ...]:
    """The approvals of a file, in its order; raises `ReadError` with the place of the first fault.

    ``shown_as`` is the path as errors and locations shall name it.
    """
    name = shown_as or str(path)
    try:
        text = path.read_text("utf-8")
        document = tomllib.loads(text)
    except OSError as error:
        raise ReadError(f"{name}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ReadError(f"{name}: is not UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        raise ReadError(f"{name}: is not TOML: {error}") from None
    if unknown := sorted(set(document) - {"accepted"}):
        raise ReadError(f"{name}: unknown key {unknown[0]!r}; approvals are [[accepted]] tables")
    entries = document.get("accepted", [])
    if not isinstance(entries, list):
        raise ReadError(f"{name}: write [[accepted]], with two brackets on each side")
    lines = [i for i, line in enumerate(text.splitlines(), start=1) if _HEADER.match(line)]
    places = [Location(name, lines[i] if i < len(lines) else 1) for i in range(len(entries))]
    approvals = tuple(map(_approval, entries, places))
    _refuse_repetition(approvals)
    return approvals


def apply_approvals(items: Iterable[Item], approvals: Sequence[Approval]) -> list[Item]:
    """The items that no approval accepts, then one error for each approval without an item."""
    used: set[Approval] = set()
    left: list[Item] = []
    by_fingerprint = {approval.fingerprint: approval for approval in approvals}
    for item in items:
        approval = by_fingerprint.get(item.fingerprint) if by_fingerprint else None
        if approval and approval.accepts(item):
            used.add(approval)
        else:
            left.append(item)
    return left + [_stale(approval) for approval in approvals if approval not in used]


def _stale(approval: Approval) -> Item:
    what = " ".join(part for part in (approval.rule, approval.subject) if part)
    of = f" ({what})" if what else ""
    return Item(
        rule=APPROVAL_USED.id,
        level=APPROVAL_USED.level,
        group="",
        subject=approval.fingerprint,
        text=f"approval {approval.fingerprint}{of} accepts no finding; remove it",
        where=approval.where,
    )


def _approval(entry: object, where: Location) -> Approval:
    if not isinstance(entry, dict):
        raise ReadError(f"{where}: write [[accepted]], with two brackets on each side")
    if unknown := sorted(set(entry) - set(_KEYS)):
        raise ReadError(f"{where}: unknown key {unknown[0]!r}; known: {', '.join(_KEYS)}")
    for key in _NEEDED:
        if entry.get(key) in (None, ""):
            raise ReadError(f"{where}: an approval needs {', '.join(_NEEDED)}; {key} is missing")
    texts = {key: value for key, value in entry.items() if key != "date"}
    for key, value in texts.items():
        if not isinstance(value, str) or not value.strip():
            raise ReadError(f"{where}: {key} must be text in quotes")
    if not _FINGERPRINT.fullmatch(texts["fingerprint"]):
        raise ReadError(f"{where}: a fingerprint is 8 of 0-9 and a-f, as reports show it")
    return Approval(**texts, date=_date(entry["date"], where), where=where)


def _date(value: object, where: Location) -> datetime.date:
    if isinstance(value, datetime.datetime):
        return value.date()
    if isinstance(value, datetime.date):
        return value
    try:
        return datetime.date.fromisoformat(str(value))
    except ValueError:
        raise ReadError(f"{where}: date must be as 2031-04-30") from None


def _refuse_repetition(approvals: Sequence[Approval]) -> None:
    first: dict[str, Approval] = {}
    for approval in approvals:
        earlier = first.setdefault(approval.fingerprint, approval)
        if earlier is not approval:
            line = earlier.where.line
            raise ReadError(
                f"{approval.where}: {approval.fingerprint} is accepted in line {line} already"
            )
