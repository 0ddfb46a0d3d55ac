"""The fixed texts of all reports, in English and in Chinese."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.judge.judgement import Status, Verdict
from typedcan.judge.rule import Severity
from typedcan.report.language import Text

VERDICTS: Mapping[Verdict, Text] = {
    Verdict.CONFORMS: Text("Conforms", "符合标准"),
    Verdict.VIOLATES: Text("Does not conform", "不符合标准"),
    Verdict.NOT_JUDGED: Text("Could not be judged", "无法判定"),
}

REASONS: Mapping[Verdict, Text] = {
    Verdict.CONFORMS: Text(
        "Nothing that the standard demands is broken in this log.",
        "本日志中未发现违反标准强制要求的情况。",
    ),
    Verdict.VIOLATES: Text(
        "Demands of the standard that are broken: {rules}; by: {nodes}.",
        "违反标准强制要求的规则数：{rules}；涉及节点：{nodes}。",
    ),
    Verdict.NOT_JUDGED: Text(
        "None of the judged nodes sent a frame of the protocol.",
        "被判定的节点均未发送本协议的报文。",
    ),
}

STATUSES: Mapping[Status, Text] = {
    Status.FAILED: Text("failed", "不通过"),
    Status.NOTED: Text("noted", "提示"),
    Status.PASSED: Text("passed", "通过"),
    Status.NOT_JUDGED: Text("not judged", "未判定"),
}

SEVERITIES: Mapping[Severity, Text] = {
    Severity.MUST: Text("must", "强制"),
    Severity.SHOULD: Text("should", "建议"),
    Severity.INFO: Text("note", "提示"),
}

STATUS_OF: Mapping[Verdict, int] = {
    Verdict.CONFORMS: 0,
    Verdict.VIOLATES: 1,
    Verdict.NOT_JUDGED: 2,
}
"""The exit statuses of verdicts."""

EXITS: Mapping[int, Text] = {
    0: Text("Exit status 0: every log conforms.", "退出码 0：所有日志均符合标准。"),
    1: Text("Exit status 1: a log does not conform.", "退出码 1：有日志不符合标准。"),
    2: Text(
        "Exit status 2: a log could not be judged, or not all of it.",
        "退出码 2：有日志无法判定，或未能完整判定。",
    ),
}

TITLE = Text("Conformance report", "符合性报告")
COLON = Text(": ", "：")
SEMICOLON = Text("; ", "；")
COMMA = Text(", ", "、")
NONE = Text("none", "无")

DIGEST = Text("SHA-256", "SHA-256")
BEGIN = Text("Begin", "起始时间")
NO_DATE = Text("not known: times count from the log's begin", "未知：时间从日志起点算起")
LENGTH = Text("Length", "时长")
FRAMES = Text("Frames", "帧数")
OTHERS = Text("of other identifiers: {count}", "其中其他标识符：{count}")
JUDGED = Text("Judged nodes", "被判定节点")
SEEN = Text("Seen nodes", "出现的节点")
UNSEEN = Text("Judged, but not seen: {nodes}", "被判定但未出现：{nodes}")
DAMAGE = Text("Damage", "损坏")
SPEC = Text("Protocol", "协议")

BROKEN = Text("Demands that are broken", "违反的强制要求")
UNHEEDED = Text("Recommendations that are not heeded", "未遵循的建议")
NOTED = Text("Notes", "提示")
PASSED = Text("Passed", "通过")
NOT_JUDGED = Text("Not judged", "未判定")
NOT_ASKED_FOR = Text(
    "it is about {nodes}, not among the judged nodes", "仅判定 {nodes}，不在被判定节点之列"
)
NOT_SEEN = Text("no frame of {nodes}, which it judges", "日志中没有被判定节点 {nodes} 的报文")
NOTHING_TO_JUDGE = Text(
    "nothing came that it could examine: what it asks for had no occasion, or lacked a message",
    "日志中没有可检查的内容：未出现相应情况，或缺少所需报文",
)
NOT_JUDGED_AS = Text("not judged, {count}: {reason}", "未判定 {count} 条：{reason}")

RULE = Text("Rule", "规则")
RULES = Text("Rules", "规则")
SEVERITY = Text("Severity", "级别")
NODE = Text("Node", "节点")
NODES = Text("Nodes", "节点")
EXAMINED = Text("Examined", "检查数")
COUNT = Text("Found", "发现数")
STATUS = Text("Status", "结果")

ERRATA = Text("erratum {errata}", "勘误 {errata}")
LEFT_OPEN = Text("no demand, as the standard leaves it open", "标准未明确，不作强制要求")

FIRST = Text("First", "首次")
WORST = Text("Worst", "最严重")
START = Text("Start", "开始")
END = Text("End", "结束")
ORDER = Text("First frame", "首帧序号")
SUBJECT = Text("Subject", "对象")
WHAT = Text("What", "内容")
OCCURRENCES = Text("Occurrences", "发生记录")
FOUND = Text("found: {count}, frames: {frames}", "发现 {count} 次，共 {frames} 帧")
MORE = Text("and {count} more; see the CSV or JSON report", "另有 {count} 条，见 CSV 或 JSON 报告")

TOLERANCES = Text("Tolerances", "容差")
TOLERANCE = Text("Tolerance", "容差")
VALUE = Text("Value in force", "生效值")
UNIT = Text("Unit", "单位")
DEFAULT = Text("Default", "默认值")
MEANING = Text("What is allowed", "含义")

PERIODS = Text("Periods", "周期")
PERIODS_HELP = Text(
    "The band spans the shortest and the longest step between frames, the dashed line is the "
    "printed period, the shade what is allowed. A mark at the top: longer than is drawn.",
    "色带为相邻帧间隔的最小值至最大值，虚线为标准规定的周期，阴影为允许范围。顶部标记：间隔超出绘图范围。",
)
PERIOD = Text("printed {period}", "标准周期 {period}")
MEAN = Text("mean {mean} ± {deviation}", "平均 {mean} ± {deviation}")
RANGE = Text("{shortest} to {longest}", "{shortest} 至 {longest}")

LOAD = Text("Bus load", "总线负载率")
LOAD_HELP = Text(
    "Shares of the bit rate of {rate} kbit/s: without stuff bits, and with the most there can be.",
    "占 {rate} kbit/s 位速率的比例：不含填充位，以及含最多填充位。",
)
CHANNEL = Text("Channel", "通道")
NO_CHANNEL = Text("(unnamed)", "(未命名)")
MEASURED = Text("measured", "实测")
OWN = Text("of the protocol", "其中本协议")
EXPECTED = Text("expected", "预期")
LOAD_LINE = Text(
    "Bus load on {channel}: {measured} measured, {expected} expected; "
    "with all stuff bits {measured_stuffed}, {expected_stuffed}",
    "总线负载率 {channel}：实测 {measured}，预期 {expected}；"
    "含最多填充位为 {measured_stuffed}、{expected_stuffed}",
)

MOMENT = Text("{which}, {start}", "{which}，{start}")
EVENTS = Text("frames", "帧")
NO_FRAMES = Text("No frame in this span.", "此时段内无帧。")
SECONDS = Text("seconds since the log's begin", "自日志起点的秒数")

ENVIRONMENT = Text("Environment", "运行环境")
NAMES: Mapping[str, Text] = {"System": Text("System", "操作系统")}
"""What the environment is made of, but for proper names."""

OVERVIEW = Text("Logs", "日志一览")
