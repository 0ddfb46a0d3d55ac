"""Which column of a sheet is what, whichever of its names stands above it."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from dbcspec.errors import Fault
from dbcspec.matrix.grid import Grid

_LAST_HEADING_ROW = 40
_CHINESE = re.compile(r"[一-鿿]+")
_LATIN = re.compile(r"[a-z0-9]+")

Headings = Mapping[str, str]
"""What a column is called in the code, to its names in the sheet, separated by spaces."""

MATRIX: Headings = {
    "msg_name": "报文名称 报文名 消息名称 msgname messagename framename",
    "msg_id": "报文标识符 报文id 消息id 帧id msgid messageid frameid canid id msgidhex idhex",
    "frame_format": "帧格式 报文帧格式 帧类型 frameformat frametype msgformat idformat",
    "send_type": "发送类型 报文发送类型 发送方式 sendtype msgsendtype txtype",
    "period": "周期 报文周期 报文周期时间 发送周期 周期时间 cycletime cycletimems msgcycletime "
    "msgcycletimems period periodms cycle",
    "condition": "发送条件 sendcondition",
    "msg_length": "报文长度 msglength msglengthbyte messagelength messagelengthbyte dlc msgdlc",
    "msg_title": "报文描述 msgdescription messagedescription",
    "signal_name": "信号名称 信号名 signalname signal",
    "title": "信号描述 描述 中文描述 signaldescription description",
    "english": "英文描述 信号英文描述 descriptionenglish signaldescriptionenglish "
    "englishdescription",
    "byte_order": "排列格式 字节序 字节顺序 byteorder endianness",
    "start_byte": "起始字节 startbyte",
    "start_bit": "起始位 startbit",
    "length": "信号长度 长度 位长度 bitlength signallength length bitlengthbit lengthbit "
    "signallengthbit",
    "data_type": "数据类型 datatype valuetype sign signed",
    "factor": "精度 分辨率 比例因子 resolution factor scale",
    "offset": "偏移量 偏移 offset",
    "minimum": "物理最小值 最小值 min minimum physicalmin minvalue signalminvaluephys minphys",
    "maximum": "物理最大值 最大值 max maximum physicalmax maxvalue signalmaxvaluephys maxphys",
    "raw_minimum": "总线最小值 busmin busminhex signalminvaluehex minhex rawmin",
    "raw_maximum": "总线最大值 busmax busmaxhex signalmaxvaluehex maxhex rawmax",
    "initial": "初始值 initialvalue initialvaluehex initial startvalue",
    "invalid": "无效值 invalidvalue invalidvaluehex invalid",
    "abnormal": "异常值 abnormalvalue abnormalvaluehex abnormal",
    "acting": "动作值 actingvalues actingvalueshex",
    "safe": "安全值 safevalue safevaluehex",
    "acts_as": "动作类型 actsas",
    "acting_reference": "动作依据 actingreference",
    "unit": "单位 unit units",
    "codes": "信号值描述 值描述 编码定义 signalvaluedescription valuedescription",
    "english_codes": "英文值描述 valuedescriptionenglish signalvaluedescriptionenglish",
    "value_table": "值表 值表名称 valuetable valuetablename",
    "multiplexing": "复用 多路复用 multiplexing multiplex mux",
    "protection": "校验与计数 protection",
    "sender": "发送节点 发送者 sender transmitter",
    "receivers": "接收节点 接收者 receiver receivers",
    "reference": "标准出处 出处 reference",
    "errata": "勘误 errata",
}
MATRIX_NEEDS = ("msg_name", "msg_id", "signal_name", "start_bit", "length")

NODES: Headings = {
    "name": "节点 节点名称 node nodename",
    "title": "名称 title",
    "english": "英文名称 titleenglish",
    "address": "地址 address sourceaddress",
    "other_addresses": "其他地址 otheraddresses",
    "errata": "勘误 errata",
}
NODES_NEED = ("name", "title", "english")

BUSES: Headings = {
    "name": "总线 bus busname",
    "title": "名称 title",
    "english": "英文名称 titleenglish",
    "bit_rate": "波特率 bitrate bitratebits baudrate",
    "nodes": "总线节点 nodes",
    "errata": "勘误 errata",
}
BUSES_NEED = ("name", "bit_rate", "nodes")

ERRATA: Headings = {
    "id": "编号 erratum",
    "kind": "类型 kind",
    "place": "位置 place",
    "printed": "原文 printed",
    "reading": "解读 reading",
    "because": "理由 reason",
}
ERRATA_NEED = tuple(ERRATA)

COVER: Headings = {
    "name": "名称 name",
    "number": "编号 number",
    "title": "标题 title",
    "english": "英文标题 titleenglish",
    "edition": "版本 edition",
    "frame_format": "帧格式 frameformat",
    "digest": "摘要 digest",
}


@dataclass(frozen=True, slots=True)
class Table:
    """A table found in a sheet: the row of its headings and the column of each."""

    grid: Grid
    row: int
    columns: Mapping[str, int]
    faults: tuple[Fault, ...]


def normal(text: str) -> str:
    """Text without the ways in which full-width, capital and spaced letters differ."""
    return unicodedata.normalize("NFKC", text).strip()


def meanings(heading: str, headings: Headings) -> set[str]:
    """What a heading can mean: one word, two where its languages contradict, or none."""
    by_name = {name: key for key, names in headings.items() for name in names.split()}
    found: set[str] = set()
    for part in re.split(r"[\n/|]", normal(heading).lower()):
        for text in (part, re.sub(r"\([^)]*\)", " ", part)):
            hits = {by_name[name] for name in _spellings(text) if name in by_name}
            found |= hits
            if hits:
                break
    return found


def _spellings(text: str) -> Iterator[str]:
    """A heading as a whole, its Chinese alone and its English alone."""
    chinese = "".join(_CHINESE.findall(text))
    latin = "".join(_LATIN.findall(text))
    whole = re.sub(r"[\W_]+", "", text)
    yield whole
    if chinese and latin:
        yield chinese
        yield latin


def find_table(
    grid: Grid, headings: Headings, first: int = 0, last: int | None = _LAST_HEADING_ROW
) -> Table:
    """The row with the most of these headings; of equal ones the last, as merged rows need it."""
    best = Table(grid, first, {}, ())
    for row in range(first, min(len(grid.rows), last or len(grid.rows))):
        table = _table_at(grid, row, headings)
        if len(table.columns) >= max(1, len(best.columns)):
            best = table
    return best


def _table_at(grid: Grid, row: int, headings: Headings) -> Table:
    columns: dict[str, int] = {}
    faults: list[Fault] = []
    for column, cell in enumerate(grid.rows[row]):
        if cell.kind != "s":
            continue
        found = sorted(meanings(cell.text, headings))
        if len(found) > 1:
            text = (
                f"heading {' '.join(cell.text.split())!r} names two columns: {' and '.join(found)}"
            )
            faults.append(Fault(cell.where, text))
        elif found and found[0] in columns:
            text = f"a second column {' '.join(cell.text.split())!r}: keep one"
            faults.append(Fault(cell.where, text))
        elif found:
            columns[found[0]] = column
    return Table(grid, row, columns, tuple(faults))
