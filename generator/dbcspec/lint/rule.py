"""What a lint rule is, what it looks at, and what it finds."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

from dbcspec.errors import Fault
from dbcspec.spec.rows import Spec
from typedcan.model.checksums.methods import Algorithm
from typedcan.model.checksums.registry import Given
from typedcan.model.errors import Location
from typedcan.model.protocol import NOWHERE, Protocol


@dataclass(frozen=True, slots=True, order=True)
class Finding:
    """One place where a rule is broken.

    ``subject`` is the name that a waiver matches, ``message`` the message that it belongs to, or
    "" where it belongs to the protocol as a whole.
    """

    where: Location
    rule: str
    subject: str
    text: str
    message: str = ""
    level: str = "error"
    """``error``, ``warning`` or ``note``."""

    def __str__(self) -> str:
        return f"{self.where}: {self.rule}: {self.text}"


@dataclass(frozen=True, slots=True)
class Waiver:
    """A finding that is accepted, with the reason.

    ``subject`` and ``message`` may have shell wildcards; without ``message`` any is meant.
    """

    rule: str
    subject: str
    reason: str
    where: Location
    message: str = "*"


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a project sets for the rules.

    ``bus_load`` is the most that periodic messages may take of a bus, in percent; ``units`` are
    known units beside the usual ones. ``house`` is what a project asks of its own files; without
    it, as of files of others, rules hold only what is surely wrong to be wrong.
    """

    bus_load: float = 70.0
    units: frozenset[str] = frozenset()
    house: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Subject:
    """What is linted: the model always, and what its source says besides.

    ``spec`` has the corrected rows where a spec is the source, ``errata_faults`` the changes that
    could not be made. ``dbc_text`` is the whole text where a DBC file is the source. ``source``
    is the file that findings without a place of their own are shown at. ``unused_waivers`` are
    those that matched no finding of the other rules, ``algorithms`` what users give to compute
    checksums.
    """

    protocol: Protocol
    spec: Spec | None = None
    dbc_text: str | None = None
    source: str = ""
    settings: Settings = dataclasses.field(default_factory=Settings)
    errata_faults: tuple[Fault, ...] = ()
    unused_waivers: tuple[Waiver, ...] = ()
    algorithms: Given = dataclasses.field(default_factory=dict[str, Algorithm | str])


class Found(NamedTuple):
    """What a check yields: a finding but for the rule.

    ``message`` can be left out where the subject is a message, or a signal of one message only,
    ``level`` where it is that of the rule.
    """

    where: Location
    subject: str
    text: str
    message: str = ""
    level: str = ""


Check = Callable[[Subject], Iterable[Found]]


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: its stable id, what it is for, and its check.

    ``default`` says whether it runs unasked, ``foreign`` whether on files of others too. ``level``:
    an ``error`` is read wrongly somewhere or cannot be carried, a ``warning`` contradicts itself or
    falls short of what is demanded, a ``note`` is for knowing.
    """

    id: str
    purpose: str
    check: Check
    default: bool = True
    level: str = "error"
    foreign: bool = False

    def findings(self, subject: Subject) -> list[Finding]:
        """All findings in a subject, in order of place."""
        found_all = [*self.check(subject)]
        messages = _messages(subject.protocol) if found_all else {}
        return sorted(
            Finding(
                where=Location(subject.source) if found.where == NOWHERE else found.where,
                rule=self.id,
                subject=found.subject,
                text=found.text,
                message=found.message or messages.get(found.subject, ""),
                level=found.level or self.level,
            )
            for found in found_all
        )


def _messages(protocol: Protocol) -> dict[str, str]:
    """The message of each name that is a message, or a signal of one message only."""
    counts = Counter(signal.name for _, signal in protocol.signals())
    owners = {sig.name: msg.name for msg, sig in protocol.signals() if counts[sig.name] == 1}
    return owners | {message.name: message.name for message in protocol.messages}
