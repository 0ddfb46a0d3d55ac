"""A rule: what it asks for, of whom, where the standard says so, and what watches for it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import ClassVar

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, LeftOpen
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text


class Severity(IntEnum):
    """How grave it is to break a rule; only ``MUST`` decides whether a node conforms."""

    INFO = 0
    """Worth knowing: nothing in the standard is broken."""

    SHOULD = 1
    """What the standard means, or what others rely on, though it is not printed as a demand."""

    MUST = 2
    """What the standard prints."""


class Watcher(ABC):
    """Watches one log for what breaks one rule.

    Parameters
    ----------
    findings
        Where it says what it examined and what it found.
    """

    wants_cycles: ClassVar[bool] = False
    """Whether it looks at `Chunk.cycles`: they are put together only for those who do."""

    def __init__(self, findings: Findings) -> None:
        self.findings = findings

    @abstractmethod
    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames; what a chunk holds is not to be kept."""

    def finish(self, end: LogEnd) -> None:  # noqa: B027  (most rules have nothing left)
        """Judge what is left when the log has ended."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """What is judged, apart from the judging.

    Parameters
    ----------
    id
        In lower case with hyphens; the file of the rule has the same name.
    title, purpose
        What is asked for in a few words, and why in one or two sentences.
    clause
        Where the standard asks for it, such as ``5.2.1, Table 14 row 3``; empty where no place of
        it does.
    severity
        How grave it is to break it.
    judges
        The nodes that it judges.
    tolerances
        What it allows; the values may be others for one run.
    errata
        What the whole rule rests on where the standard needed a reading; a demand rests on none
        that fills a gap or makes a choice.
    left_open
        Parts of it that rest on such errata: what is found there is a recommendation at most.
    watch
        Makes what watches one log.
    """

    id: str
    title: Text
    purpose: Text
    clause: str = ""
    severity: Severity
    judges: tuple[str, ...]
    tolerances: tuple[Tolerance, ...] = ()
    errata: tuple[str, ...] = ()
    left_open: tuple[LeftOpen, ...] = ()
    watch: Callable[[Findings], Watcher]
