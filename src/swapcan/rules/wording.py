"""The rules that hold for any protocol in the words of this standard, with its clauses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from swapcan.rules.left_open import LEFT_OPEN
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text


@dataclass(frozen=True, slots=True, kw_only=True)
class Wording:
    """What is said of a rule; what is not given is its own."""

    clause: str
    severity: Severity | None = None
    title: Text | None = None
    purpose: Text | None = None
    tolerances: Mapping[str, Text] = field(default_factory=dict[str, Text])
    errata: tuple[str, ...] = ()


def worded(rule: Rule) -> Rule:
    """A rule in the words of this standard; raises `KeyError` where there are none."""
    left_open = (*rule.left_open, *LEFT_OPEN.get(rule.id, ()))
    if rule.id in CLAUSES:
        return replace(rule, clause=CLAUSES[rule.id], left_open=left_open)
    words = WORDINGS[rule.id]
    return replace(
        rule,
        clause=words.clause,
        severity=rule.severity if words.severity is None else words.severity,
        title=words.title or rule.title,
        purpose=words.purpose or rule.purpose,
        tolerances=tuple(
            replace(each, text=words.tolerances.get(each.name, each.text))
            for each in rule.tolerances
        ),
        errata=words.errata,
        left_open=left_open,
    )


CLAUSES: Mapping[str, str] = {
    "identifier-priority": "A.1 (4.2.1)",
    "foreign-frames": "A.1",
    "error-frames": "4.1, 4.2.2",
    "message-one-channel": "4.2.2",
    "checksum": "Tables 1, 8, 14 and 16",
    "period-mean": "A.1",
    "period-jitter": "A.1",
    "period-gap": "A.1",
    "period-short": "A.1",
    "event-repeated": "A.1",
    "message-missing": "A.1",
    "start-complete": "A.1",
    "bus-load": "A.1, 4.2.2",
    "value-range": "Table 13 rows 9 to 11 (5.1.12), Table 17 row 4 (5.2.4)",
}
"""Of the rules that need no other words, by their ids."""

WORDINGS: Mapping[str, Wording] = {
    "frame-kind": Wording(
        title=Text("Frames are classical data frames", "帧为经典 CAN 数据帧"),
        clause="4.2.1, 4.2.2",
    ),
    "frame-length": Wording(
        title=Text(
            "Frames have 8 bytes",
            "帧的数据长度为 8 字节",
        ),
        clause="A.1",
    ),
    "source-address": Wording(
        purpose=Text(
            "Receivers compare whole identifiers: from another source address the message is not "
            "seen. V2B_RQData comes from 0xEF, BMS_TMS_0 from 0xF4, unlike the rest of their "
            "senders' messages. A frame counts as a message's where its sender has that address "
            "in others, or where the log lacks the message; else it is taken for another node's, "
            "as is a proprietary PGN from an address that no node has.",
            "接收方按完整标识符过滤:源地址不同则收不到该报文。"
            "V2B_RQData 的源地址为 0xEF,BMS_TMS_0 为 0xF4,与其发送节点的其他报文不同。"
            "该源地址属于发送节点,或日志中缺少该报文时,判为该报文的错误;否则视为其他节点的报文。"
            "专用 PGN 的源地址不属于任何节点时,亦视为其他节点的报文。",
        ),
        clause="A.1",
    ),
    "reserved-bits": Wording(
        purpose=Text(
            "A later edition may give them a meaning, which is then taken from what is sent "
            "today, and newer ones do so. Filled with 0 is printed in tables 3 and 14, and read "
            "for the other reserved fields.",
            "后续版本可能定义预留位的含义,届时会按现在发送的内容解释。"
            "新版本已使用部分预留位。"
            "表 3 和表 14 规定预留填充 0,其他预留字段按此理解。",
        ),
        severity=Severity.SHOULD,
        errata=("E07", "E08"),
        clause="A.1; Table 3 rows 3 and 4 (5.1.3), Table 14 row 21 (5.2.1)",
    ),
    "unassigned-bits": Wording(
        purpose=Text(
            "The standard says nothing of them; 0 is what it fills with elsewhere, and what a "
            "later edition will count on.",
            "标准未规定这些位;其他处均填充 0,后续版本也会以此为前提。",
        ),
        clause="A.1",
    ),
    "counter-sequence": Wording(
        clause="Table 1 row 8 (5.1.1), Table 14 row 2 (5.2.1), Table 17 row 1 (5.2.4), Table 19 "
        "row 7 (5.5)",
    ),
    "counter-allowed": Wording(
        purpose=Text(
            "15 says Signal Invalid: a receiver cannot tell from it that the sender is alive.",
            "15 表示信号无效,接收方无法据此判断发送方是否正常工作。",
        ),
        clause="Table 1 row 8 (5.1.1), Table 14 row 2 (5.2.1)",
    ),
    "node-awake": Wording(
        clause="A.1, 5.2.1.4",
        severity=Severity.MUST,
    ),
    "code-defined": Wording(
        purpose=Text(
            "Nobody knows what a code says that the value table does not have. Tables that number "
            "CSCs and frames count as examples: a pack may have more of them, but none has number "
            "0. Positions, manufacturers and the length of the pack code are left open.",
            "编码定义中没有的编码,接收方无法理解。"
            "CSC 编号和帧序号的编码表视为示例:电池包可以有更多编号,但不应为 0。"
            "位置编号、电池厂家和编码长度不作限制。",
        ),
        clause="Tables 1 to 20",
    ),
    "code-reserved": Wording(
        purpose=Text(
            "A reserved code says nothing; what is not known or not there has a code for that. "
            "B2V_ST1_ChgMode is not judged, as only 0 is left for it while nothing charges.",
            "保留编码没有含义;状态未知或不存在时应发送无效编码。"
            "B2V_ST1_ChgMode 不判定,因为不充电时只有编码 0 可用。",
        ),
        clause="Tables 2, 3, 13 and 14",
    ),
    "invalid-lasting": Wording(
        purpose=Text(
            "Who relies on a signal must do without it as long as it is invalid. States of relays "
            "and contactors are left out, as the other side may measure them, and single cells "
            "and probes, as the last frame of a CSC may have no more of them.",
            "信号无效期间,依赖该信号的节点无法工作。"
            "继电器和接触器状态可能由对方检测,单体电压和探针温度可能是 CSC 末帧的填充,均不判定。",
        ),
        clause="Tables 1, 5 to 7, 11, 13 and 14",
    ),
    "answer-in-time": Wording(
        purpose=Text(
            "Who asks for VIN, pack code or basic data waits for all messages of the answer. A "
            "node that is not on the bus, and a request withdrawn before its time, are not judged.",
            "请求 VIN、电池包编码或电池系统信息的节点需要收到全部应答报文。"
            "不在总线上的节点以及提前撤销的请求不作判定。",
        ),
        clause="5.2.2; 5.1.7; 5.2.3; Table 3 row 1 (5.1.3); Table 16 rows 2 and 3 (5.2.3)",
        tolerances={
            "answer-in-time.seconds": Text(
                "From a request to the last of its answers: twice the longest printed period, "
                "1000 ms",
                "从发出请求到收到全部应答的时间:最长规定周期 1000 ms 的两倍",
            ),
        },
    ),
    "answer-unasked": Wording(
        purpose=Text(
            "VIN, pack code and basic data are events: they are sent at the wish of the other "
            "node and only load the bus otherwise. A.1 prints periods for them as well: who sends "
            "one all the time at its period keeps to that.",
            "VIN、电池包编码和电池系统基本参数属于事件型报文,按对方需求发送;否则只会增加总线负载。"
            "表 A.1 也规定了这些报文的周期:始终按该周期发送亦符合标准。",
        ),
        clause="5.2.2; 5.2.3; A.1 (type Event)",
        errata=("E56",),
        tolerances={
            "answer-unasked.seconds": Text(
                "From the withdrawal of a request to the last frame of its answers: twice the "
                "longest printed period, 1000 ms",
                "从撤销请求到最后一帧应答的时间:最长规定周期 1000 ms 的两倍",
            ),
        },
    ),
    "request-withdrawn": Wording(
        purpose=Text(
            "A request that stays in force keeps its answers on the bus. That is allowed: A.1 "
            "prints periods for them, so a request may hold; but what they say does not change.",
            "持续有效的请求会使应答报文一直占用总线。标准允许这样做:表 A.1 规定了应答的周期;"
            "但应答内容不会变化。",
        ),
        clause="5.1.3; 5.2.3; A.1",
        tolerances={
            "request-withdrawn.seconds": Text(
                "From the last of the answers to the withdrawal: ten rounds of a pack code",
                "从收到全部应答到撤销请求的时间:可重复发送十次电池包编码",
            ),
        },
    ),
    "cells-complete": Wording(
        title=Text(
            "Each cycle has all cell voltages",
            "每个周期包含全部单体电压",
        ),
        purpose=Text(
            "The VCU passes the voltages of all cells on; a missing frame leaves old ones.",
            "VCU 将全部单体电压上传云平台;缺帧时只能使用旧值。",
        ),
        clause="5.1.8; Table 9 rows 1 and 2",
        tolerances={
            "cells-complete.periods": Text(
                "Periods without a frame after which what comes is a new beginning, be it of a "
                "restarted node or of another pack",
                "超过该周期数没有报文时,其后的报文视为重新开始(节点重启或更换电池包)",
            ),
        },
    ),
    "cells-order": Wording(
        title=Text(
            "Cell voltages come in the order of their numbers",
            "单体电压按编号顺序发送",
        ),
        purpose=Text(
            "CSCs and frames are numbered. A receiver that takes a lower number for the beginning "
            "of a cycle would mix two cycles.",
            "CSC 和帧均有编号;接收方如以编号变小作为新周期的起点,会混淆两个周期的数据。",
        ),
        clause="5.1.8; Table 9 rows 1 and 2",
        tolerances={
            "cells-order.periods": Text(
                "Periods without a frame after which what comes is a new beginning, be it of a "
                "restarted node or of another pack",
                "超过该周期数没有报文时,其后的报文视为重新开始(节点重启或更换电池包)",
            ),
        },
    ),
    "probes-complete": Wording(
        title=Text(
            "Each cycle has all probe temperatures",
            "每个周期包含全部探针温度",
        ),
        purpose=Text(
            "The VCU passes the temperatures of all probes on; a missing frame leaves old ones.",
            "VCU 将全部探针温度上传云平台;缺帧时只能使用旧值。",
        ),
        clause="5.1.9; Table 10 rows 1 and 2",
        tolerances={
            "probes-complete.periods": Text(
                "Periods without a frame after which what comes is a new beginning, be it of a "
                "restarted node or of another pack",
                "超过该周期数没有报文时,其后的报文视为重新开始(节点重启或更换电池包)",
            ),
        },
    ),
    "probes-order": Wording(
        title=Text(
            "Probe temperatures come in the order of their numbers",
            "探针温度按编号顺序发送",
        ),
        purpose=Text(
            "CSCs and frames are numbered. A receiver that takes a lower number for the beginning "
            "of a cycle would mix two cycles.",
            "CSC 和帧均有编号;接收方如以编号变小作为新周期的起点,会混淆两个周期的数据。",
        ),
        clause="5.1.9; Table 10 rows 1 and 2",
        tolerances={
            "probes-order.periods": Text(
                "Periods without a frame after which what comes is a new beginning, be it of a "
                "restarted node or of another pack",
                "超过该周期数没有报文时,其后的报文视为重新开始(节点重启或更换电池包)",
            ),
        },
    ),
    "frame-numbers": Wording(
        title=Text(
            "CSCs and frames are numbered from 1",
            "CSC 编号和帧序号从 1 开始",
        ),
        purpose=Text(
            "A receiver finds the place of a cell or probe by these numbers; tables 9 and 10 "
            "begin them at 1, and the pack tells how many CSCs it has.",
            "接收方通过这些编号确定电芯和探针的位置;"
            "表 9、表 10 规定从 1 开始,电池包给出 CSC 总数。",
        ),
        clause="Tables 9 and 10 rows 1 and 2 (5.1.8, 5.1.9); Table 13 row 6 (5.1.12)",
    ),
}
"""By ids of rules."""
