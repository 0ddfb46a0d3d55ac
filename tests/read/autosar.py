"""A small ARXML file with end-to-end protected messages, for tests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Guarded(NamedTuple):
    """A message: its signals as name, start bit and length, its profile and data ids."""

    name: str
    frame_id: int
    length: int
    signals: Sequence[tuple[str, int, int]]
    category: str
    data_ids: Sequence[int]


def arxml(*messages: Guarded) -> str:
    """The text of a file."""
    elements = "".join(_elements(each) for each in messages)
    triggerings = "".join(_triggering(each) for each in messages)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<AUTOSAR xmlns="http://autosar.org/schema/r4.0"
 xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xsi:schemaLocation="http://autosar.org/schema/r4.0 AUTOSAR_00046.xsd">
<AR-PACKAGES><AR-PACKAGE><SHORT-NAME>P</SHORT-NAME><ELEMENTS>
<CAN-CLUSTER><SHORT-NAME>Bus</SHORT-NAME>
<CAN-CLUSTER-VARIANTS><CAN-CLUSTER-CONDITIONAL><BAUDRATE>500000</BAUDRATE><PHYSICAL-CHANNELS>
<CAN-PHYSICAL-CHANNEL><SHORT-NAME>Channel</SHORT-NAME>
<FRAME-TRIGGERINGS>{triggerings}</FRAME-TRIGGERINGS>
</CAN-PHYSICAL-CHANNEL></PHYSICAL-CHANNELS></CAN-CLUSTER-CONDITIONAL></CAN-CLUSTER-VARIANTS>
</CAN-CLUSTER>
{elements}<END-TO-END-PROTECTION-SET><SHORT-NAME>Protections</SHORT-NAME>
<END-TO-END-PROTECTIONS>{"".join(map(_protection, messages))}</END-TO-END-PROTECTIONS>
</END-TO-END-PROTECTION-SET></ELEMENTS></AR-PACKAGE></AR-PACKAGES></AUTOSAR>
"""


def _triggering(message: Guarded) -> str:
    return f"""<CAN-FRAME-TRIGGERING><SHORT-NAME>T_{message.name}</SHORT-NAME>
<FRAME-REF DEST="CAN-FRAME">/P/{message.name}</FRAME-REF>
<CAN-ADDRESSING-MODE>STANDARD</CAN-ADDRESSING-MODE><IDENTIFIER>{message.frame_id}</IDENTIFIER>
</CAN-FRAME-TRIGGERING>
"""


def _elements(message: Guarded) -> str:
    mappings = "".join(
        f"""<I-SIGNAL-TO-I-PDU-MAPPING><SHORT-NAME>M_{name}</SHORT-NAME>
<I-SIGNAL-REF DEST="I-SIGNAL">/P/{name}</I-SIGNAL-REF>
<PACKING-BYTE-ORDER>MOST-SIGNIFICANT-BYTE-LAST</PACKING-BYTE-ORDER>
<START-POSITION>{start}</START-POSITION></I-SIGNAL-TO-I-PDU-MAPPING>
"""
        for name, start, _ in message.signals
    )
    signals = "".join(
        f"""<I-SIGNAL><SHORT-NAME>{name}</SHORT-NAME><LENGTH>{length}</LENGTH>
<SYSTEM-SIGNAL-REF DEST="SYSTEM-SIGNAL">/P/S_{name}</SYSTEM-SIGNAL-REF></I-SIGNAL>
<SYSTEM-SIGNAL><SHORT-NAME>S_{name}</SHORT-NAME></SYSTEM-SIGNAL>
"""
        for name, _, length in message.signals
    )
    return f"""<CAN-FRAME><SHORT-NAME>{message.name}</SHORT-NAME>
<FRAME-LENGTH>{message.length}</FRAME-LENGTH><PDU-TO-FRAME-MAPPINGS><PDU-TO-FRAME-MAPPING>
<SHORT-NAME>F_{message.name}</SHORT-NAME>
<PDU-REF DEST="I-SIGNAL-I-PDU">/P/Pdu_{message.name}</PDU-REF><START-POSITION>0</START-POSITION>
</PDU-TO-FRAME-MAPPING></PDU-TO-FRAME-MAPPINGS></CAN-FRAME>
<I-SIGNAL-I-PDU><SHORT-NAME>Pdu_{message.name}</SHORT-NAME><LENGTH>{message.length}</LENGTH>
<I-SIGNAL-TO-PDU-MAPPINGS>{mappings}</I-SIGNAL-TO-PDU-MAPPINGS></I-SIGNAL-I-PDU>
{signals}"""


def _protection(message: Guarded) -> str:
    ids = "".join(f"<DATA-ID>{each}</DATA-ID>" for each in message.data_ids)
    return f"""<END-TO-END-PROTECTION><SHORT-NAME>E_{message.name}</SHORT-NAME>
<END-TO-END-PROFILE><CATEGORY>{message.category}</CATEGORY><DATA-IDS>{ids}</DATA-IDS>
</END-TO-END-PROFILE><END-TO-END-PROTECTION-I-SIGNAL-I-PDUS><END-TO-END-PROTECTION-I-SIGNAL-I-PDU>
<I-SIGNAL-I-PDU-REF DEST="I-SIGNAL-I-PDU">/P/Pdu_{message.name}</I-SIGNAL-I-PDU-REF>
</END-TO-END-PROTECTION-I-SIGNAL-I-PDU></END-TO-END-PROTECTION-I-SIGNAL-I-PDUS>
</END-TO-END-PROTECTION>
"""
