"""The sheets around the matrix: cover, nodes and buses, errata."""

from __future__ import annotations

from collections.abc import Sequence

from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.matrix.cells import A4, Value, fit_to_page, put, put_table, set_widths
from typedcan.model.protocol import Aspect, Protocol

_COVER_LINE = 62
"""Characters that fit into a line of the cover."""

_LEGEND = (
    ("S / R", "发送 / 接收", "sends / receives"),
    ("Intel", "起始位为最低有效位", "the start bit is the least significant bit"),
    ("Motorola MSB", "起始位为最高有效位", "the start bit is the most significant bit"),
    ("0x…", "原始值,负数为补码", "raw value; negative ones in two's complement"),
    (
        "动作值 / Acting Values",
        "接收方据此闭合接触器、充电、加热、制冷或运行水泵;安全值使其停止",
        "the receiver closes a contactor, charges, heats, cools or pumps; the safe value ends it",
    ),
)


def add_cover(sheet: Worksheet, protocol: Protocol, sheets: Sequence[str]) -> None:
    """Title, edition, number, digest and contents; no dates, no versions of tools."""
    set_widths(sheet, (26, 60, 44))
    fit_to_page(sheet, A4)
    heading = protocol.title or protocol.english or protocol.name
    put(sheet, 1, 1, "CAN 通信矩阵 / CAN Matrix", "swap_title")
    put(sheet, 2, 1, heading, "swap_title")
    for row in (1, 2):
        sheet.merge_cells(start_row=row, end_row=row, start_column=1, end_column=3)
    sheet.row_dimensions[1].height = 24
    sheet.row_dimensions[2].height = 44
    facts: list[tuple[str, Value]] = [
        ("名称 / Name", protocol.name),
        ("编号 / Number", protocol.number),
        ("标题 / Title", protocol.title),
        ("英文标题 / Title (English)", protocol.english),
        ("版本 / Edition", protocol.edition),
        ("帧格式 / Frame Format", protocol.frame_format),
        ("摘要 / Digest", protocol.digest),
        ("报文数 / Messages", len(protocol.messages)),
        ("信号数 / Signals", sum(1 for _ in protocol.signals())),
    ]
    row = 4
    for label, value in facts:
        put(sheet, row, 1, label, "swap_message")
        put(sheet, row, 2, value)
        sheet.row_dimensions[row].height = 14 * (1 + len(str(value)) // _COVER_LINE)
        row += 1
    row += 1
    for letters, chinese, english in _LEGEND:
        put(sheet, row, 1, letters, "swap_message")
        put(sheet, row, 2, chinese)
        put(sheet, row, 3, english)
        row += 1
    put(sheet, row + 1, 1, "目录 / Contents", "swap_head")
    for index, name in enumerate(sheets, start=row + 2):
        cell = put(sheet, index, 1, name, "swap_link")
        cell.hyperlink = Hyperlink(ref=cell.coordinate, location=f"'{name}'!A1")


def add_nodes(sheet: Worksheet, protocol: Protocol) -> None:
    """Who takes part, and the buses they meet on."""
    set_widths(sheet, (16, 26, 44, 16, 22, 12))
    fit_to_page(sheet, A4)
    addresses = Aspect.ADDRESSES in protocol.carries
    row = put_table(
        sheet,
        1,
        (
            "节点\nNode",
            "名称\nTitle",
            "英文名称\nTitle (English)",
            *(("地址\nAddress", "其他地址\nOther Addresses") if addresses else ()),
            "勘误\nErrata",
        ),
        (
            (
                node.name,
                node.title,
                node.english,
                *(
                    (
                        None if node.address is None else f"0x{node.address:02X}",
                        ", ".join(f"0x{address:02X}" for address in node.other_addresses),
                    )
                    if addresses
                    else ()
                ),
                ", ".join(node.errata),
            )
            for node in protocol.nodes
        ),
    )
    _add_buses(sheet, row + 1, protocol)


def _add_buses(sheet: Worksheet, row: int, protocol: Protocol) -> None:
    put_table(
        sheet,
        row,
        (
            "总线\nBus",
            "名称\nTitle",
            "英文名称\nTitle (English)",
            "波特率\nBit Rate (bit/s)",
            "总线节点\nNodes",
            "勘误\nErrata",
        ),
        (
            (
                bus.name,
                bus.title,
                bus.english,
                bus.bit_rate,
                ", ".join(bus.nodes),
                ", ".join(bus.errata),
            )
            for bus in protocol.buses
        ),
    )


def add_errata(sheet: Worksheet, protocol: Protocol) -> None:
    """Every reading that differs from print."""
    set_widths(sheet, (8, 10, 30, 44, 44, 60))
    put_table(
        sheet,
        1,
        (
            "编号\nErratum",
            "类型\nKind",
            "位置\nPlace",
            "原文\nPrinted",
            "解读\nReading",
            "理由\nReason",
        ),
        (
            (each.id, each.kind, each.place, each.printed, each.reading, each.because)
            for each in protocol.errata
        ),
    )
    sheet.freeze_panes = "B2"
    fit_to_page(sheet, A4)
