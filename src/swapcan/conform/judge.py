"""Judges one log: blocks of frames in, a judgement out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.before import Before
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings
from swapcan.conform.judgement import Judgement, RuleResult
from swapcan.conform.measure.homes import Homes, is_judged
from swapcan.conform.measure.load import LoadMeter
from swapcan.conform.measure.periods import PeriodMeter
from swapcan.conform.registry import RULES
from swapcan.conform.rule import Rule
from swapcan.conform.series import Series
from swapcan.log_protocol import CELLS, OWN, PROBES
from typedcan.logs.cells.cycles import CellColumns, CycleTable
from typedcan.logs.checks import checksums_right, has_checksum, rows_where
from typedcan.logs.columns import MessageColumns
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock
from typedcan.logs.plan import Mode
from typedcan.model.errors import TypedcanError
from typedcan.wire.message import Message


class ConformError(TypedcanError, ValueError):
    """What is to be judged, or how, makes no sense."""


class Judge:
    """Takes the frames of one log in their order.

    Each message is judged on the channel on which it is seen first. Times are taken to go forward:
    where they go back, as when a clock was set, nothing is judged across that.

    Parameters
    ----------
    nodes
        Whom to judge.
    rules
        By what.
    limits
        Tolerances by name that are to have another value.

    Raises
    ------
    ConformError
        There is no such node or tolerance.
    """

    def __init__(
        self,
        nodes: Iterable[str] = PROTOCOL.nodes,
        rules: Sequence[Rule] = RULES,
        limits: Mapping[str, float] | None = None,
    ) -> None:
        self.nodes = tuple(nodes)
        self._limits = dict(limits or {})
        _check(self.nodes, self._limits, rules)
        judged = frozenset(self.nodes)
        self._findings = [(rule, Findings(judged, self._limits)) for rule in rules]
        self._watchers = [
            rule.watch(findings) for rule, findings in self._findings if judged & set(rule.judges)
        ]
        self._decoder = Decoder(OWN.messages, mode=Mode.RAW)
        self._cells = _Cells()
        self._load, self._periods = LoadMeter(), PeriodMeter()
        self._before: dict[tuple[type[Message], bool], Before | None] = {}
        self._homes = Homes()
        self._begin: float | None = None
        self._end = 0.0
        self._orders = 0
        self._counts: Counter[str] = Counter()

    def take(self, block: FrameBlock) -> None:
        """Judge the next frames."""
        if not len(block):
            return
        if self._begin is None:
            self._begin = float(block.timestamp[0])
        self._end = max(self._end, float(block.timestamp.max()) - self._begin)
        chunk = self._chunk(block, self._begin)
        for watcher in self._watchers:
            watcher.take(chunk)
        self._load.take(chunk)
        self._periods.take(chunk)
        self._orders += len(block)

    def finish(self, log: str = "", digest: str = "", damage: Iterable[str] = ()) -> Judgement:
        """Judge what is left, and say what was found."""
        for watcher in self._watchers:
            watcher.finish(self._end)
        seen = {message.SENDER for message in PROTOCOL.messages if self._counts[message.NAME]}
        return Judgement(
            log=log,
            digest=digest,
            begin=self._begin or 0.0,
            seconds=self._end,
            frames=dict(self._counts),
            nodes=self.nodes,
            seen=tuple(node for node in PROTOCOL.nodes if node in seen),
            results=tuple(_result(rule, findings) for rule, findings in self._findings),
            periods=self._periods.finish(self._end),
            load=self._load.finish(self._end),
            limits=self._limits,
            damage=tuple(damage),
        )

    def _chunk(self, block: FrameBlock, begin: float) -> Chunk:
        decoded = self._decoder.decode(block)
        frames: dict[type[Message], Series] = {}
        sound: dict[type[Message], Series] = {}
        for message in PROTOCOL.messages:
            columns = decoded.messages.get(message.NAME)
            columns = None if columns is None else self._own(message, columns)
            right = None if columns is None else _right(message, columns)
            frames[message] = self._series(message, columns, begin, sound=False)
            if right is not None and columns is not None:
                columns = rows_where(columns, right)
            sound[message] = self._series(message, columns, begin, sound=True)
            self._counts[message.NAME] += frames[message].fresh
        self._counts[""] += len(block) - sum(each.fresh for each in frames.values())
        cycles = cache(lambda: self._cells.cycles(block, self._homes.channels))
        return Chunk(block, begin, self._orders, self._end, frames, sound, cycles)

    def _series(
        self, message: type[Message], columns: MessageColumns | None, begin: float, *, sound: bool
    ) -> Series:
        before = self._before.get((message, sound))
        series = Series(message, columns, before, begin, self._orders)
        self._before[message, sound] = series.last()
        return series

    def _own(self, message: type[Message], columns: MessageColumns) -> MessageColumns:
        """The frames that are what the standard says of them, on the channel of the first."""
        block, rows = columns.block, columns.rows
        good = is_judged(message, block, rows)
        if message.NAME not in self._homes.channels:
            self._homes.find(message, block, rows[good])
        if len(block.channels) > 1:
            good &= self._homes.at_home(message, block, rows)
        return columns if good.all() else rows_where(columns, good)


class _Cells:
    """Puts cells and probes together, where a rule asks for them; then it has to ask each time."""

    def __init__(self) -> None:
        wanted = dict.fromkeys((CELLS.message, PROBES.message, CELLS.totals))
        self._decoder = Decoder(OWN.messages, reserved=OWN.reserved, wanted=wanted)
        self._columns = CellColumns(OWN.readings)

    def cycles(
        self, block: FrameBlock, homes: Mapping[str, int | str | None]
    ) -> Sequence[CycleTable]:
        """The cycles that are complete with a block, those of each message's own channel."""
        tables = self._columns.add(self._decoder.decode(block).messages)
        return [
            table
            for table in tables
            if table.channel == homes.get(table.readings.message, table.channel)
        ]


def _right(message: type[Message], columns: MessageColumns) -> NDArray[np.bool_] | None:
    """Which frames have the right checksum; None: all."""
    if not has_checksum(message.MODEL):
        return None
    right = checksums_right(message.MODEL, columns.block.data[columns.rows])
    return None if right.all() else right


def _result(rule: Rule, findings: Findings) -> RuleResult:
    kept = sorted(findings.kept, key=lambda found: (found.start, found.order, found.subject))
    return RuleResult(
        rule=rule,
        examined=findings.examined.total(),
        count=findings.count,
        frames=findings.frames,
        occurrences=tuple(kept),
        worst=findings.worst,
    )


def _check(nodes: Sequence[str], limits: Mapping[str, float], rules: Sequence[Rule]) -> None:
    if not nodes:
        raise ConformError(f"judge whom? nodes are {', '.join(PROTOCOL.nodes)}")
    for node in nodes:
        if node not in PROTOCOL.nodes:
            raise ConformError(f"there is no node {node!r}; known: {', '.join(PROTOCOL.nodes)}")
    known = {tolerance.name for rule in (*RULES, *rules) for tolerance in rule.tolerances}
    for name in limits:
        if name not in known:
            raise ConformError(f"there is no tolerance {name!r}; known: {', '.join(sorted(known))}")
