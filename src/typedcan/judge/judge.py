"""Judges one log: blocks of frames in, a judgement out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.decoded import DecodedChunk
from typedcan.judge.findings import Findings
from typedcan.judge.judgement import Judgement, RuleResult
from typedcan.judge.measure.channels import Channels, Formats, Senders, has_length
from typedcan.judge.measure.last_known import fresh_for
from typedcan.judge.measure.left_over import by_pgn_of, keys_of, left_over
from typedcan.judge.measure.load import LoadMeter
from typedcan.judge.measure.periods import PeriodMeter
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.measure.steps import StepMeter
from typedcan.judge.measure.traffic import Traffic
from typedcan.judge.rule import Rule
from typedcan.judge.rules import rules_for
from typedcan.judge.series import Before, Series
from typedcan.judge.tolerance import SHARED, Limits
from typedcan.logs import protocol as logs
from typedcan.logs.checks import rows_where
from typedcan.logs.checksums import NONE, checksums_right
from typedcan.logs.columns import MessageColumns
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock
from typedcan.logs.plan import Mode
from typedcan.logs.protocol import known as known_protocol
from typedcan.logs.transfers.cycles import CycleTable, ReadingColumns
from typedcan.model.checksums.registry import Given
from typedcan.model.errors import TypedcanError
from typedcan.model.seal import seals_of
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol


class JudgeError(TypedcanError, ValueError):
    """What is to be judged, or how, makes no sense."""


class Judge:
    """Takes the frames of one log in their order.

    Each message is judged on the channel on which it is seen first. Times are taken to go forward:
    where they go back, as when a clock was set, nothing is judged across that.

    Parameters
    ----------
    protocol
        What frames are decoded by.
    rules
        By what to judge; None: by those that its model gives.
    nodes
        Whom to judge; None: all.
    limits
        Tolerances by name that are to have another value.
    known
        Further rules whose tolerances may be named, though they do not judge.
    algorithms
        What computes checksums that are not known here, as `typedcan.wire.codec.Codec` has it.

    Raises
    ------
    JudgeError
        There is no such node or tolerance, or nobody to judge.
    AlgorithmError
        No message has an algorithm of a name that is given, or what is given is none.
    """

    def __init__(
        self,
        protocol: Protocol,
        rules: Sequence[Rule] | None = None,
        *,
        nodes: Iterable[str] | None = None,
        limits: Mapping[str, float] | None = None,
        known: Sequence[Rule] = (),
        algorithms: Given = NONE,
    ) -> None:
        rules = rules_for(protocol) if rules is None else rules
        every = nodes_of(protocol)
        self.nodes = every if nodes is None else tuple(nodes)
        self._protocol = protocol
        self._limits = Limits(limits)
        self._algorithms = algorithms
        self._seals = seals_of(protocol.model.messages, algorithms)
        _check(every, self.nodes, self._limits.given, (*rules, *known))
        judged = [node for node in every if node in self.nodes]
        self._findings = [
            (rule, Findings(judged, self._limits.given, rule.left_open)) for rule in rules
        ]
        self._watchers = [
            rule.watch(findings)
            for rule, findings in self._findings
            if not set(judged).isdisjoint(rule.judges)
        ]
        decoded_by = known_protocol(protocol.model)
        self._decoder = Decoder(decoded_by.messages, mode=Mode.RAW)
        wanted = any(watcher.wants_cycles for watcher in self._watchers)
        self._readings = _Readings(decoded_by) if wanted else None
        self._steps, self._traffic = StepMeter(protocol, self._limits), Traffic(protocol)
        self._keys = keys_of(protocol)
        self._load, self._periods = LoadMeter(), PeriodMeter(protocol)
        self._before: dict[tuple[type[Message], bool], Before | None] = {}
        self._channels, self._formats = Channels(), Formats(protocol)
        self._senders, self._by_pgn = Senders(protocol), by_pgn_of(protocol)
        self._begin: float | None = None
        self._end = 0.0
        self._orders = 0
        self._counts: Counter[str] = Counter()

    def feed(self, block: FrameBlock) -> None:
        """Judge the next frames."""
        if not len(block):
            return
        if self._begin is None:
            self._begin = float(block.timestamp[0])
        self._end = max(self._end, float(block.timestamp.max()) - self._begin)
        chunk = self._measured(self._decoded(block, self._begin))
        for watcher in self._watchers:
            watcher.feed(chunk)
        self._orders += len(block)

    def finish(self, log: str = "", digest: str = "", damage: Iterable[str] = ()) -> Judgement:
        """Judge what is left, and say what was found."""
        presences = self._steps.presences
        end = LogEnd(
            time=self._end,
            nodes=presences.nodes,
            messages=presences.messages,
            silent=presences.silent_at(self._end),
            stopped=tuple(self._steps.stopped()),
            traffic=self._traffic,
            by_frame=self._steps.by_frame(),
        )
        for watcher in self._watchers:
            watcher.finish(end)
        messages = self._protocol.messages
        seen = {message.SENDER for message in messages if self._counts[message.NAME]}
        return Judgement(
            protocol=self._protocol,
            log=log,
            digest=digest,
            begin=self._begin or 0.0,
            seconds=self._end,
            frames=dict(self._counts),
            nodes=self.nodes,
            seen=tuple(node for node in nodes_of(self._protocol) if node in seen),
            results=tuple(_result(rule, findings) for rule, findings in self._findings),
            periods=self._periods.finish(presences.messages, end.by_frame),
            load=self._load.finish(self._end, self._traffic),
            limits=self._limits.given,
            damage=tuple(damage),
        )

    def _decoded(self, block: FrameBlock, begin: float) -> DecodedChunk:
        decoded = self._decoder.decode(block)
        others: list[NDArray[np.int64]] = []
        frames: dict[type[Message], Series] = {}
        sound: dict[type[Message], Series] = {}
        for message in self._protocol.messages:
            columns = decoded.messages.get(message.NAME)
            if columns is not None and columns.by_pgn:
                sent = self._senders.sent(message, block.frame_id[columns.rows])
                others.append(columns.rows[~sent])
                columns = rows_where(columns, sent) if sent.any() else None
            columns = None if columns is None else self._own(message, columns)
            right = None if columns is None else self._right(message, columns)
            frames[message] = self._series(message, columns, begin, sound=False)
            if right is not None and columns is not None:
                columns = rows_where(columns, right)
            sound[message] = self._series(message, columns, begin, sound=True)
            self._counts[message.NAME] += frames[message].fresh
        self._counts[""] += len(block) - sum(each.fresh for each in frames.values())
        return DecodedChunk(
            block,
            begin,
            self._orders,
            self._end,
            frames,
            sound,
            seals=self._seals,
            others=np.concatenate(others) if others else None,
        )

    def _measured(self, chunk: DecodedChunk) -> Chunk:
        """The chunk with what rules need to know of it, measured once for all of them."""
        timing = self._steps.feed(chunk)
        self._traffic.feed(chunk)
        self._load.feed(chunk)
        self._periods.feed(timing)
        return Chunk(
            chunk,
            timing=timing,
            nodes=self._steps.presences.nodes,
            left_over=left_over(chunk, self._keys, self._by_pgn),
            cycles=self._cycles(chunk.block),
        )

    def _cycles(self, block: FrameBlock) -> Sequence[CycleTable]:
        return self._readings.cycles(block, self._channels.first) if self._readings else ()

    def _series(
        self, message: type[Message], columns: MessageColumns | None, begin: float, *, sound: bool
    ) -> Series:
        before = self._before.get((message, sound))
        series = Series(
            message, columns, before, begin, self._orders, fresh_for(message, self._limits)
        )
        self._before[message, sound] = series.last()
        return series

    def _right(self, message: type[Message], columns: MessageColumns) -> NDArray[np.bool_] | None:
        """Which frames have the right checksum; None: all."""
        if message.NAME not in self._seals:
            return None
        payload = columns.block.data[columns.rows]
        right = checksums_right(message.MODEL, payload, self._algorithms)
        return None if right.all() else right

    def _own(self, message: type[Message], columns: MessageColumns) -> MessageColumns:
        """The frames that are what the standard says of them, on the channel of the first."""
        block, rows = columns.block, columns.rows
        good = self._formats.fit(message, block, rows) & has_length(message, block, rows)
        if message.NAME not in self._channels.first:
            self._channels.note(message, block, rows[good])
        if len(block.channels) > 1:
            good &= self._channels.are_first(message, block, rows)
        return columns if good.all() else rows_where(columns, good)


class _Readings:
    """Puts cycles of readings together."""

    def __init__(self, protocol: logs.Protocol) -> None:
        wanted = dict.fromkeys(
            name for each in protocol.readings for name in (each.message, each.totals)
        )
        self._decoder = Decoder(protocol.messages, reserved=protocol.reserved, wanted=wanted)
        self._columns = ReadingColumns(protocol.readings, recognise=False)

    def cycles(
        self, block: FrameBlock, channels: Mapping[str, int | str | None]
    ) -> Sequence[CycleTable]:
        """The cycles that are complete with a block, those of each message's own channel."""
        tables = self._columns.add(self._decoder.decode(block).messages)
        return [
            table
            for table in tables
            if table.channel == channels.get(table.readings.message, table.channel)
        ]


def _result(rule: Rule, findings: Findings) -> RuleResult:
    kept = sorted(findings.kept, key=lambda found: (found.start, found.order, found.subject))
    return RuleResult(
        rule=rule,
        examined=findings.examined.total(),
        count=findings.count,
        frames=findings.frames,
        occurrences=tuple(kept),
        worst=findings.worst,
        open_count=findings.open_count,
    )


def _check(
    every: Sequence[str], nodes: Sequence[str], limits: Mapping[str, float], rules: Sequence[Rule]
) -> None:
    if not every:
        raise JudgeError("there is nobody to judge: the protocol has no nodes and no messages")
    if not nodes:
        raise JudgeError(f"judge whom? nodes are {', '.join(every)}")
    for node in nodes:
        if node not in every:
            raise JudgeError(f"there is no node {node!r}; known: {', '.join(every)}")
    own = (tolerance for rule in rules for tolerance in rule.tolerances)
    known = {tolerance.name for tolerance in (*own, *SHARED)}
    for name in limits:
        if name not in known:
            raise JudgeError(f"there is no tolerance {name!r}; known: {', '.join(sorted(known))}")
