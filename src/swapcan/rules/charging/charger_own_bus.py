"""The charger is not on the bus of the powertrain."""

from __future__ import annotations

from swapcan.messages import V2B_CMD, C2B_ACStatus
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.report.language import Text

_SHARED = Text(
    "comes on {channel}, as V2B_CMD does: 4.2.2 wants a CAN interface of its own",
    "与 V2B_CMD 同在通道 {channel} 上,而 4.2.2 要求使用独立的 CAN 接口",
)


class ChargerOwnBus(Watcher):
    """Compares the channels of a log that has such."""

    def feed(self, chunk: Chunk) -> None:
        """Which channels there are is known at the end."""

    def finish(self, end: LogEnd) -> None:
        """Judge where the frames of charger and VCU came."""
        channels, message = end.traffic.channels, C2B_ACStatus
        channel, powertrain = channels.get(message), channels.get(V2B_CMD)
        if channel is None or powertrain is None:
            return
        self.findings.examine(message.SENDER)
        if channel == powertrain:
            seen = end.messages[message]
            self.findings.add(
                Occurrence(
                    subject=Subject(message.SENDER, message.NAME),
                    start=seen.first,
                    end=seen.last,
                    order=seen.first_order,
                    frames=seen.frames,
                    measure=seen.frames,
                    text=_SHARED,
                    values={"channel": str(channel)},
                )
            )


RULE = Rule(
    id="charger-own-bus",
    title=Text("The charger has a bus of its own", "充电机使用独立的总线"),
    purpose=Text(
        "What a charger sends is not to disturb what the truck is driven by.",
        "充电机的通讯不应影响动力总成控制系统。",
    ),
    clause="4.2.2",
    severity=Severity.MUST,
    judges=(C2B_ACStatus.SENDER,),
    watch=ChargerOwnBus,
)
