"""The columns of the Excel matrix: headings, widths, and what stands in them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal

from dbcspec.matrix.cells import LONGEST_TEXT, Value, raw_text
from typedcan.model.acting import ActingCodes
from typedcan.model.layout import float_limits
from typedcan.model.protocol import Aspect, ByteOrder, Code, Message, Protocol, SendType, Signal

_MOST_LINES = 200
_SEND_TYPES = {
    SendType.CYCLIC: "Cyclic",
    SendType.IF_ACTIVE: "IfActive",
    SendType.EVENT: "Event",
}
_LONGEST_BLOCK = LONGEST_TEXT - 2_000


@dataclass(frozen=True, slots=True)
class Column:
    """One column: its two headings, its width in characters, its cells.

    It is left out of a protocol that does not carry the aspect ``needs``.
    """

    chinese: str
    english: str
    width: float
    of_message: Callable[[Message], Value] = lambda _: None
    of_signal: Callable[[Message, Signal], Value] = lambda _message, _signal: None
    needs: Aspect | None = None

    @property
    def heading(self) -> str:
        """Both headings, one a line."""
        return f"{self.chinese}\n{self.english}"


def columns_of(protocol: Protocol) -> list[Column]:
    """The columns for what the protocol carries, those of the nodes left out."""
    return [
        column for column in COLUMNS if column.needs is None or column.needs in protocol.carries
    ]


def node_names(protocol: Protocol) -> list[str]:
    """The nodes that have a column: the declared ones, then others that send or receive."""
    names = dict.fromkeys(node.name for node in protocol.nodes)
    for message in protocol.messages:
        names |= dict.fromkeys((*message.senders, *message.receivers))
    return [name for name in names if name]


def code_blocks(signal: Signal, *, english: bool) -> list[str]:
    """The codes, one a line, in as many blocks as Excel needs cells for them.

    English lines are only there for codes whose English label is another one.
    """
    lines: list[str] = []
    blocks: list[str] = []
    for line in _code_lines(signal, english=english):
        if len(lines) == _MOST_LINES or sum(map(len, lines)) + 2 * len(line) > _LONGEST_BLOCK:
            blocks.append("\n".join(lines))
            lines = []
        lines.append(line)
    return [*blocks, "\n".join(lines)] if lines else blocks


def _code_lines(signal: Signal, *, english: bool) -> Iterator[str]:
    for code in signal.value_table.codes if signal.value_table else ():
        if not english or code.english != code.label:
            yield f"{raw_text(code.value, signal)}: {_label(code, english=english)}"


def _label(code: Code, *, english: bool) -> str:
    """The label, in quotes where a reader would lose a part of it."""
    label = code.english if english else code.label
    plain = label == label.strip() and "\n" not in label and not label.startswith('"')
    return label if plain else json.dumps(label, ensure_ascii=False)


def _first_codes(signal: Signal, *, english: bool) -> str | None:
    return next(iter(code_blocks(signal, english=english)), None)


def _byte_order(signal: Signal) -> str:
    """Start bits of Motorola signals are those of the most significant bit, as in DBC files."""
    return "Intel" if signal.byte_order is ByteOrder.INTEL else "Motorola MSB"


def _data_type(signal: Signal) -> str:
    if signal.is_float:
        return "Float" if signal.signed else "Unsigned Float"
    return "Signed" if signal.signed else "Unsigned"


def _code(value: int | None, signal: Signal) -> str | None:
    return None if value is None else raw_text(value, signal, -(-signal.length // 4))


def _limit(signal: Signal, value: Decimal) -> Decimal | None:
    """A physical limit; the largest float has up to 309 digits and says nothing: left empty."""
    return None if signal.is_float and value in float_limits(signal.length) else value


def _bus_limit(signal: Signal, side: int) -> str | None:
    """A physical limit as raw value, where the bits can hold it."""
    if signal.is_float or not signal.factor:
        return None
    value = signal.raw_range[side]
    low, high = signal.raw_limits
    return _code(value, signal) if low <= value <= high else None


def _multiplexing(_: Message, signal: Signal) -> str | None:
    """``M`` for a selector, ``m0-3,7 @Selector`` for a signal that it selects."""
    ranges = ",".join(_ranges(signal.selectors))
    parts = f"m{ranges}" * bool(signal.multiplexer) + "M" * signal.is_selector
    return " @".join(filter(None, (parts, signal.multiplexer))) or None


def _ranges(values: Sequence[int]) -> Iterator[str]:
    """Values with runs of three and more put together."""
    runs: list[list[int]] = []
    for value in values:
        if runs and value == runs[-1][-1] + 1:
            runs[-1].append(value)
        else:
            runs.append([value])
    for run in runs:
        if len(run) > 2:
            yield f"{run[0]}-{run[-1]}"
        else:
            yield from map(str, run)


def _protection(message: Message, signal: Signal) -> str | None:
    checksum, counter = message.checksum, message.counter
    if checksum and checksum.signal == signal.name:
        extras = "".join(f", {key} {value}" for key, value in checksum.extras)
        open_ = ", open" if checksum.is_open else ""
        return f"Checksum {checksum.algorithm}, bytes {checksum.covers()}{extras}{open_}"
    if counter and counter.signal == signal.name:
        runs = (("first", counter.first, 0), ("step", counter.step, 1))
        extras = "".join(f", {key} {value}" for key, value, usual in runs if value != usual)
        return f"Counter, modulus {counter.modulus}{extras}"
    return None


def _acting(fact: Callable[[ActingCodes], Value]) -> Callable[[Message, Signal], Value]:
    """A fact of the codes that act, empty for signals without."""
    return lambda _, signal: fact(signal.acting) if signal.acting else None


def _acting_codes(_: Message, signal: Signal) -> str | None:
    codes = signal.acting.codes if signal.acting else ()
    return ", ".join(_code(code, signal) or "" for code in codes) or None


def _name(message: Message, _: Signal | None = None) -> Value:
    return message.name


def _id(message: Message, _: Signal | None = None) -> Value:
    return f"0x{message.frame_id:0{8 if message.extended else 3}X}"


def _frame_format(message: Message) -> str:
    width = "Extended" if message.extended else "Standard"
    if not message.is_fd:
        return "J1939PG" if message.by_pgn else width
    return f"{width} FD" if message.bit_rate_switch else f"{width} FD, no BRS"


COLUMNS: tuple[Column, ...] = (
    Column("报文名称", "Msg Name", 17, _name, _name),
    Column("报文标识符", "Msg ID", 12, _id, _id),
    Column("帧格式", "Frame Format", 9, _frame_format),
    Column(
        "发送类型", "Send Type", 9, lambda msg: _SEND_TYPES[msg.send_type], needs=Aspect.PERIODS
    ),
    Column("周期", "Cycle Time (ms)", 7, lambda msg: msg.period, needs=Aspect.PERIODS),
    Column("报文长度", "Msg Length (Byte)", 7, lambda msg: msg.length),
    Column("信号名称", "Signal Name", 27, of_signal=lambda _, sig: sig.name),
    Column(
        "信号描述",
        "Signal Description",
        26,
        lambda msg: msg.title,
        lambda _, sig: sig.title,
        Aspect.COMMENTS,
    ),
    Column(
        "英文描述",
        "Description (English)",
        30,
        lambda msg: msg.english,
        lambda _, sig: sig.english,
        Aspect.COMMENTS,
    ),
    Column("排列格式", "Byte Order", 10, of_signal=lambda _, sig: _byte_order(sig)),
    Column("起始字节", "Start Byte", 6, of_signal=lambda _, sig: sig.start // 8),
    Column("起始位", "Start Bit", 6, of_signal=lambda _, sig: sig.start),
    Column("信号长度", "Bit Length", 7, of_signal=lambda _, sig: sig.length),
    Column("数据类型", "Data Type", 9, of_signal=lambda _, sig: _data_type(sig)),
    Column("精度", "Resolution", 10, of_signal=lambda _, sig: sig.factor),
    Column("偏移量", "Offset", 8, of_signal=lambda _, sig: sig.offset),
    Column("物理最小值", "Min", 10, of_signal=lambda _, sig: _limit(sig, sig.minimum)),
    Column("物理最大值", "Max", 10, of_signal=lambda _, sig: _limit(sig, sig.maximum)),
    Column("总线最小值", "Bus Min (Hex)", 11, of_signal=lambda _, sig: _bus_limit(sig, 0)),
    Column("总线最大值", "Bus Max (Hex)", 11, of_signal=lambda _, sig: _bus_limit(sig, 1)),
    Column(
        "初始值",
        "Initial Value (Hex)",
        11,
        of_signal=lambda _, sig: _code(sig.start_value, sig),
        needs=Aspect.START_VALUES,
    ),
    Column(
        "无效值", "Invalid Value (Hex)", 11, of_signal=lambda _, sig: _code(sig.invalid_code, sig)
    ),
    Column(
        "异常值", "Abnormal Value (Hex)", 11, of_signal=lambda _, sig: _code(sig.abnormal_code, sig)
    ),
    Column("动作值", "Acting Values (Hex)", 11, of_signal=_acting_codes, needs=Aspect.ACTS),
    Column(
        "安全值",
        "Safe Value (Hex)",
        11,
        of_signal=lambda _, sig: _code(sig.acting.safe, sig) if sig.acting else None,
        needs=Aspect.ACTS,
    ),
    Column(
        "动作类型",
        "Acts As",
        10,
        of_signal=_acting(lambda acting: acting.kind.capitalize()),
        needs=Aspect.ACTS,
    ),
    Column(
        "动作依据",
        "Acting Reference",
        18,
        of_signal=_acting(lambda acting: acting.reference),
        needs=Aspect.ACTS,
    ),
    Column("单位", "Unit", 8, of_signal=lambda _, sig: sig.unit),
    Column(
        "信号值描述",
        "Signal Value Description",
        28,
        of_signal=lambda _, sig: _first_codes(sig, english=False),
    ),
    Column(
        "英文值描述",
        "Value Description (English)",
        24,
        of_signal=lambda _, sig: _first_codes(sig, english=True),
    ),
    Column(
        "值表",
        "Value Table",
        16,
        of_signal=lambda _, sig: sig.value_table.name if sig.value_table else None,
        needs=Aspect.VALUE_TABLE_NAMES,
    ),
    Column("复用", "Multiplexing", 11, of_signal=_multiplexing),
    Column("校验与计数", "Protection", 16, of_signal=_protection, needs=Aspect.PROTECTION),
    Column("发送条件", "Send Condition", 20, lambda msg: msg.condition, needs=Aspect.COMMENTS),
    Column(
        "标准出处",
        "Reference",
        22,
        lambda msg: msg.reference,
        lambda _, sig: sig.reference,
        Aspect.REFERENCES,
    ),
    Column(
        "勘误",
        "Errata",
        9,
        lambda msg: ", ".join(msg.errata),
        lambda _, sig: ", ".join(sig.errata),
        Aspect.REFERENCES,
    ),
)
"""In the order of the sheet; the nodes follow."""

CODES_HEADING, ENGLISH_CODES_HEADING = "Signal Value Description", "Value Description (English)"
SIGNAL_NAME_HEADING = "Signal Name"
