"""Codes are those that the value tables have."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, LeftOpen, Said
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.content.codes import Codes, judge_codes, senders, whole_fields, without
from typedcan.judge.scope import OpenCodes, Scope
from typedcan.report.language import Text
from typedcan.wire.fields import LabelledField
from typedcan.wire.protocol import FieldRef, Protocol, Transfer

_UNDEFINED = Text(
    "code {code} has no meaning; defined are {defined}",
    "编码 {code} 未定义,已定义的编码为 {defined}",
)
_NOT_THERE = Text("has no meaning; defined are {defined}", "未定义,已定义的编码为 {defined}")
_NUMBERED_FROM_ONE = Text("number {code}; numbers begin at 1", "编号为 {code},编号应从 1 开始")


_NONE = OpenCodes(())


class CodeDefined(Watcher):
    """Holds codes against the value tables, and numbers against where they begin and end."""

    def __init__(
        self, findings: Findings, tables: Sequence[Codes], numbers: Sequence[Codes]
    ) -> None:
        super().__init__(findings)
        self._tables = [codes for codes in tables if not codes.detail]
        self._left_open = [codes for codes in tables if codes.detail]
        self._numbers = numbers

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_codes(self.findings, chunk, self._tables, _describe)
        judge_codes(self.findings, chunk, self._left_open, _describe_open)
        judge_codes(self.findings, chunk, self._numbers, _describe_number)


def _describe(codes: Codes, code: int) -> Said:
    return _UNDEFINED, {"code": code, "defined": ", ".join(map(str, codes.right))}


def _describe_open(codes: Codes, code: int) -> Said:  # noqa: ARG001
    return _NOT_THERE, {"defined": ", ".join(map(str, codes.right))}


def _describe_number(codes: Codes, code: int) -> Said:  # noqa: ARG001
    return _NUMBERED_FROM_ONE, {"code": code}


def _labelled(protocol: Protocol, scope: Scope) -> Iterator[Codes]:
    for message, field in whole_fields(protocol):
        if isinstance(field, LabelledField) and field.dbc_name not in scope.examples:
            right = tuple(sorted(field.labels))
            left_open = scope.open_codes.get(field.dbc_name, _NONE).codes
            undefined = without([field.signal.raw_limits], {*right, *left_open})
            if undefined:
                yield Codes(message, field, undefined, right)
            for code in left_open:
                yield Codes(message, field, ((code, code),), right, f"code {code}")


def _frame_numbers(transfers: Sequence[Transfer]) -> Iterator[Codes]:
    """Of the frames of transfers of which it is known how many they take."""
    for transfer in transfers:
        if transfer.frame_number and (numbers := transfer.parts.numbers):
            message, name = transfer.frame_number
            field = message.FIELDS[name]
            right = tuple(numbers)
            yield Codes(message, field, without([field.signal.raw_limits], right), right)


def _from_one(protocol: Protocol, scope: Scope) -> Iterator[Codes]:
    refs: list[FieldRef] = []
    for transfer in protocol.transfers:
        first = (transfer.parts.transfer.first_number, transfer.parts.transfer.first_group)
        if transfer.frame_number and transfer.group:
            numbers = zip((transfer.frame_number, transfer.group), first, strict=True)
            refs += [ref for ref, begin in numbers if begin == 1]
    for message, field in whole_fields(protocol):
        if field.dbc_name in scope.from_one:
            refs.append(FieldRef(message, field.name))
    for message, name in refs:
        yield Codes(message, message.FIELDS[name], ((0, 0),))


def rule(protocol: Protocol, scope: Scope) -> Rule:
    """The rule of a protocol."""
    tables = (*_labelled(protocol, scope), *_frame_numbers(protocol.transfers))
    numbers = tuple(_from_one(protocol, scope))
    return Rule(
        id="code-defined",
        title=Text("Codes have a meaning", "编码有定义"),
        purpose=Text(
            "Nobody knows what a code says that the value table does not have.",
            "编码定义中没有的编码,接收方无法理解。",
        ),
        severity=Severity.MUST,
        judges=senders((*tables, *numbers)),
        left_open=tuple(
            LeftOpen(f"{name} code {code}", left_open.errata)
            for name, left_open in scope.open_codes.items()
            for code in left_open.codes
        ),
        watch=partial(CodeDefined, tables=tables, numbers=numbers),
    )
