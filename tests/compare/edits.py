"""Single edits of dbc/caamtb-swap.dbc, as a person would make them, and what breaks by each."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

Change = Callable[[str], str]

WIRE, SOURCE, ADDITIVE, COSMETIC = "wire", "source", "additive", "cosmetic"


@dataclass(frozen=True, slots=True)
class Edit:
    """A change of the text, and rule, level and subject of the one finding it must give.

    ``unseen_by`` are those of canmatrix and cantools that take the file for the same: both sort
    signals, and canmatrix compares neither orders nor a comment with none.
    """

    what: str
    change: Change
    rule: str
    level: str
    subject: str
    unseen_by: tuple[str, ...] = ()


def swap(old: str, new: str) -> Change:
    """Replaces a text that stands in the file exactly once."""

    def change(text: str) -> str:
        assert text.count(old) == 1, old
        return text.replace(old, new)

    return change


def part(line: str, old: str, new: str) -> Change:
    """Replaces a part of a line that stands in the file exactly once."""
    assert line.count(old) == 1
    return swap(f"{line}\r\n", f"{line.replace(old, new)}\r\n")


def word(old: str, new: str) -> Change:
    """Replaces a whole word everywhere."""

    def change(text: str) -> str:
        pattern = re.compile(rf"\b{old}\b")
        assert pattern.search(text), old
        return pattern.sub(new, text)

    return change


def without(pattern: str) -> Change:
    """Drops every line in which the pattern is found."""

    def change(text: str) -> str:
        lines = text.splitlines(keepends=True)
        left = [line for line in lines if not re.search(pattern, line)]
        assert len(left) < len(lines)
        return "".join(left)

    return change


def moved(line: str, *, behind: str) -> Change:
    """Puts a line behind another one."""

    def change(text: str) -> str:
        text = swap(f"{line}\r\n", "")(text)
        return swap(f"{behind}\r\n", f"{behind}\r\n{line}\r\n")(text)

    return change


def message_block(name: str) -> str:
    """A pattern of a message with its signals."""
    return rf"BO_ \d+ {name}: [^\r]*\r\n(?: SG_ [^\r]*\r\n)*\r\n"


def removed_message(text: str) -> str:
    """Without B2C_Charger and all that is said of it."""
    return without(r"\b2550224627\b")(re.sub(message_block("B2C_Charger"), "", text))


def messages_swapped(text: str) -> str:
    """The first message behind the second one."""
    pattern = f"({message_block('V2B_CMD')})({message_block('B2V_RQ')})"
    assert re.search(pattern, text)
    return re.sub(pattern, r"\2\1", text)


SOC = ' SG_ B2V_ST2_SOC : 0|8@1+ (0.4,0) [0|102] "%" VCU'
CURRENT = ' SG_ B2V_ST2_Current : 16|16@1+ (0.1,-1000) [-1000|5553.5] "A" VCU'
LIVE = ' SG_ BSU_Live : 0|8@1+ (1,0) [0|255] "" BMU,VCU'
LOCK = ' SG_ BSU_Lock : 8|2@1+ (1,0) [0|3] "" BMU,VCU'
WARNING = ' SG_ BSU_ConctorTempWarn : 24|2@1+ (1,0) [0|3] "" BMU,VCU'
VOLT = ' SG_ BMS_Volt : 15|16@0+ (1,0) [0|65535] "V" TMS'
LIFE = ' SG_ BMS_Life : 55|8@0+ (1,0) [0|255] "" TMS'
CODES = (
    'VAL_ 2566912167 BSU_Lock 0 "Neither unlocked nor locked" 1 "Unlocked" 2 "Locked" 3 "Other" ;'
)
STATUS = 'VAL_ 2550330320 V2B_CMD_ALIV 15 "Signal Invalid" ;'
ST2 = "BO_ 2558710003 B2V_ST2: 8 BMU"
NODES = "BU_: BMU VCU CHG TMS BSU"
NEW_SIGNAL = ' SG_ BSU_Door : 26|2@1+ (1,0) [0|3] "" VCU'
LAID_OVER = ' SG_ BSU_Door : 25|2@1+ (1,0) [0|3] "" VCU'
NEW_MESSAGE = 'BO_ 2566912423 BSU_BMS_1: 8 BSU\r\n SG_ BSU_Door : 0|2@1+ (1,0) [0|3] "" VCU\r\n\r\n'
START = '"GenSigStartValue" SG_ 2558710003 B2V_ST2_SOC '

OF_SIGNALS = (
    Edit("factor", part(SOC, "(0.4,", "(0.5,"), "signal-scale-same", WIRE, "B2V_ST2_SOC"),
    Edit("factor's end", part(SOC, "0.4,", "0.40001,"), "signal-scale-same", WIRE, "B2V_ST2_SOC"),
    Edit("offset", part(CURRENT, ",-1000", ",-500"), "signal-offset-same", WIRE, "B2V_ST2_Current"),
    Edit("unit", part(SOC, '"%"', '"1"'), "signal-unit-same", WIRE, "B2V_ST2_SOC"),
    Edit("no unit", part(SOC, '"%"', '""'), "signal-unit-same", WIRE, "B2V_ST2_SOC"),
    Edit("start", part(LIVE, "0|8", "48|8"), "signal-start-same", WIRE, "BSU_Live"),
    Edit("Motorola start", part(LIFE, "55|8", "34|8"), "signal-start-same", WIRE, "BMS_Life"),
    Edit("shorter", part(SOC, "0|8@", "0|7@"), "signal-length-same", WIRE, "B2V_ST2_SOC"),
    Edit("longer", part(WARNING, "24|2", "24|3"), "signal-length-same", WIRE, WARNING.split()[1]),
    Edit("Motorola length", part(VOLT, "|16@", "|15@"), "signal-length-same", WIRE, "BMS_Volt"),
    Edit("Intel", part(VOLT, "15|16@0", "15|16@1"), "signal-byte-order-same", WIRE, "BMS_Volt"),
    Edit(
        "Motorola, same bytes",
        part(CURRENT, "16|16@1", "23|16@0"),
        "signal-byte-order-same",
        WIRE,
        "B2V_ST2_Current",
    ),
    Edit(
        "Motorola, same start",
        part(CURRENT, "|16@1", "|16@0"),
        "signal-byte-order-same",
        WIRE,
        "B2V_ST2_Current",
    ),
    Edit("signed", part(SOC, "@1+", "@1-"), "signal-sign-same", WIRE, "B2V_ST2_SOC"),
    Edit(
        "lower maximum",
        part(SOC, "|102]", "|100]"),
        "signal-range-not-narrowed",
        WIRE,
        "B2V_ST2_SOC",
    ),
    Edit(
        "higher minimum",
        part(CURRENT, "[-1000|", "[-900|"),
        "signal-range-not-narrowed",
        WIRE,
        "B2V_ST2_Current",
    ),
    Edit(
        "higher maximum",
        part(SOC, "|102]", "|110]"),
        "signal-range-not-widened",
        ADDITIVE,
        "B2V_ST2_SOC",
    ),
    Edit("receiver", part(SOC, "VCU", "TMS"), "signal-receivers-same", WIRE, "B2V_ST2_SOC"),
    Edit("one more", part(SOC, "VCU", "VCU,BSU"), "signal-receivers-same", WIRE, "B2V_ST2_SOC"),
    Edit("one less", part(LOCK, "BMU,VCU", "BMU"), "signal-receivers-same", WIRE, "BSU_Lock"),
    Edit(
        "receivers in another order",
        part(LOCK, "BMU,VCU", "VCU,BMU"),
        "order-same",
        COSMETIC,
        "BSU_Lock",
        unseen_by=("canmatrix",),
    ),
    Edit(
        "start value",
        swap(f"{START}255;", f"{START}254;"),
        "signal-start-value-same",
        WIRE,
        "B2V_ST2_SOC",
    ),
    Edit(
        "selector",
        part(LIVE, "Live :", "Live M :"),
        "signal-multiplexing-same",
        WIRE,
        "BSU_Live",
    ),
    Edit(
        "signal renamed",
        word("B2V_ST2_SOH", "B2V_ST2_Health"),
        "signal-name-same",
        SOURCE,
        "B2V_ST2_Health",
    ),
    Edit("signal removed", without(r"\bB2V_ST2_SOH\b"), "signal-present", WIRE, "B2V_ST2_SOH"),
    Edit(
        "signal added",
        swap(f"{WARNING}\r\n", f"{WARNING}\r\n{NEW_SIGNAL}\r\n"),
        "signal-added",
        ADDITIVE,
        "BSU_Door",
    ),
    Edit(
        "signal laid over another",
        swap(f"{WARNING}\r\n", f"{WARNING}\r\n{LAID_OVER}\r\n"),
        "signal-bits-free",
        WIRE,
        "BSU_Door",
    ),
    Edit(
        "signals in another order",
        moved(LOCK, behind=WARNING),
        "order-same",
        COSMETIC,
        "BSU_BMS_0",
        unseen_by=("cantools", "canmatrix"),
    ),
    Edit(
        "signal's comment",
        swap('BSU_Lock "Lock feedback"', 'BSU_Lock "Feedback of the lock"'),
        "comment-same",
        COSMETIC,
        "BSU_Lock",
    ),
    Edit(
        "signal's comment removed",
        without(r"^CM_ SG_ \d+ BSU_Lock "),
        "comment-same",
        COSMETIC,
        "BSU_Lock",
        unseen_by=("canmatrix",),
    ),
    Edit(
        "signal's place in the standard",
        swap('BSU_Lock "Table 17 row 2 (5.2.4)"', 'BSU_Lock "Table 18 row 2 (5.2.4)"'),
        "reference-same",
        COSMETIC,
        "BSU_Lock",
    ),
)
"""Of one signal."""

OF_CODES = (
    Edit("label", part(CODES, '"Other"', '"Broken"'), "code-meaning-same", WIRE, "BSU_Lock"),
    Edit(
        "invalid code's label",
        part(STATUS, '"Signal Invalid"', '"Overflow"'),
        "code-meaning-same",
        WIRE,
        "V2B_CMD_ALIV",
    ),
    Edit(
        "codes reversed",
        swap(
            'BSU_ConnectSt 1 "Connected" 2 "Not connected"',
            'BSU_ConnectSt 1 "Not connected" 2 "Connected"',
        ),
        "code-meaning-not-reversed",
        WIRE,
        "BSU_ConnectSt",
    ),
    Edit(
        "invalid code removed",
        part(STATUS, ' 15 "Signal Invalid"', ""),
        "code-no-value-same",
        WIRE,
        "V2B_CMD_ALIV",
    ),
    Edit("code removed", part(CODES, ' 3 "Other"', ""), "code-present", WIRE, "BSU_Lock"),
    Edit("all codes removed", part(CODES, CODES, ""), "code-present", WIRE, "BSU_Lock"),
    Edit(
        "code added",
        swap('BSU_ConnectSt 1 "Conn', 'BSU_ConnectSt 0 "Moving" 1 "Conn'),
        "code-added",
        ADDITIVE,
        "BSU_ConnectSt",
    ),
    Edit(
        "first codes",
        lambda text: text + 'VAL_ 2566912167 BSU_Live 255 "No life" ;\r\n',
        "code-added",
        ADDITIVE,
        "BSU_Live",
    ),
    Edit(
        "label's spaces",
        swap(
            'BSU_ConctorTempWarn 0 "Inactive" 1 "Level 1"',
            'BSU_ConctorTempWarn 0 "Inactive" 1 "Level1"',
        ),
        "enum-member-name-same",
        SOURCE,
        "BSU_ConctorTempWarn",
    ),
    Edit(
        "label's case",
        part(CODES, '"Unlocked"', '"UNLOCKED"'),
        "code-label-same",
        COSMETIC,
        "BSU_Lock",
    ),
    Edit(
        "value table renamed",
        swap("VAL_TABLE_ LockState ", "VAL_TABLE_ LockFeedback "),
        "value-table-name-same",
        SOURCE,
        "BSU_Lock",
    ),
)
"""Of the codes of one signal."""

OF_MESSAGES = (
    Edit(
        "identifier",
        word("2558710003", "2558710004"),
        "message-identifier-same",
        WIRE,
        "B2V_ST2",
    ),
    Edit(
        "identifier of one that is all over the file",
        word("2550330320", "2550330321"),
        "message-identifier-same",
        WIRE,
        "V2B_CMD",
    ),
    Edit("length", swap("BSU_BMS_0: 8", "BSU_BMS_0: 7"), "message-length-same", WIRE, "BSU_BMS_0"),
    Edit("sender", part(ST2, "8 BMU", "8 TMS"), "message-sender-same", WIRE, "B2V_ST2"),
    Edit("no sender", part(ST2, "BMU", "Vector__XXX"), "message-sender-same", WIRE, "B2V_ST2"),
    Edit(
        "period",
        swap('"GenMsgCycleTime" BO_ 2558710003 100;', '"GenMsgCycleTime" BO_ 2558710003 200;'),
        "message-period-same",
        WIRE,
        "B2V_ST2",
    ),
    Edit(
        "period removed",
        without('"GenMsgCycleTime" BO_ 2558710003 '),
        "message-period-same",
        WIRE,
        "B2V_ST2",
    ),
    Edit(
        "send type",
        swap('"GenMsgSendType" BO_ 2558710003 0;', '"GenMsgSendType" BO_ 2558710003 7;'),
        "message-send-type-same",
        WIRE,
        "B2V_ST2",
    ),
    Edit("renamed", word("B2V_ST2", "B2V_State2"), "message-name-same", SOURCE, "B2V_State2"),
    Edit("message removed", removed_message, "message-present", WIRE, "B2C_Charger"),
    Edit(
        "message added",
        swap('\r\nCM_ "', f'\r\n{NEW_MESSAGE}CM_ "'),
        "message-added",
        ADDITIVE,
        "BSU_BMS_1",
    ),
    Edit(
        "messages in another order",
        messages_swapped,
        "order-same",
        COSMETIC,
        "messages",
        unseen_by=("canmatrix",),
    ),
    Edit(
        "message's comment",
        swap('"Swap controller status.', '"Status of the swap controller.'),
        "comment-same",
        COSMETIC,
        "BSU_BMS_0",
    ),
)
"""Of one message."""

OF_THE_FILE = (
    Edit("node added", part(NODES, "BSU", "BSU LOG"), "node-added", ADDITIVE, "LOG"),
    Edit(
        "node removed",
        lambda text: without(r" BU_ BSU ")(part(NODES, " BSU", "")(text)),
        "node-present",
        WIRE,
        "BSU",
    ),
    Edit("node renamed", word("CHG", "CHARGER"), "node-name-same", SOURCE, "CHARGER"),
    Edit(
        "nodes in another order",
        part(NODES, "BMU VCU", "VCU BMU"),
        "order-same",
        COSMETIC,
        "nodes",
        unseen_by=("canmatrix",),
    ),
    Edit(
        "node's address",
        swap("BU_ CHG 86;", "BU_ CHG 87;"),
        "node-address-same",
        WIRE,
        "CHG",
    ),
    Edit(
        "node's comment",
        swap('BU_ CHG "AC charger"', 'BU_ CHG "Charger"'),
        "comment-same",
        COSMETIC,
        "CHG",
    ),
    Edit(
        "bit rate",
        swap('BA_ "Baudrate" 250000;', 'BA_ "Baudrate" 500000;'),
        "bus-bit-rate-same",
        WIRE,
        "caamtb_swap",
    ),
)
"""Of nodes, the bus and the file as a whole."""

EDITS = (*OF_SIGNALS, *OF_CODES, *OF_MESSAGES, *OF_THE_FILE)
