"""How a pack reacts to a charger that comes, is well again after a fault, and goes."""

from __future__ import annotations

from swapcan.messages import B2C_Charger, C2B_ACStatus, ChargeControl, ChargerFault
from swapcan.scenarios.reactions.reaction import PACK, Reaction, first
from typedcan.judge.chunk import LogEnd
from typedcan.judge.findings import Occurrence, Subject
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.protocol import FieldRef

_CONTROL = FieldRef(B2C_Charger, "charge_control")
_HARDWARE = FieldRef(C2B_ACStatus, "charger_hardware")
_ABOUT = Subject(PACK, B2C_Charger.NAME, B2C_Charger.FIELDS["charge_control"].dbc_name)

_BEGIN_LIMIT = Tolerance(
    name="reaction-charge-begins.seconds",
    value=10.0,
    unit="s",
    text=Text(
        "from the charger's first report to the command to charge; the standard names no time",
        "从充电机首次上报到启动充电命令的时间;标准未规定该时间",
    ),
)
_RESUME_LIMIT = Tolerance(
    name="reaction-charge-resumes.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "from the end of the charger's fault to the command to charge; the standard names no time",
        "从充电机故障消失到启动充电命令的时间;标准未规定该时间",
    ),
)
_END_LIMIT = Tolerance(
    name="reaction-charge-ends.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "from the charger's last report to the end of charging: ten of its periods",
        "从充电机最后一次上报到停止充电的时间:十个周期",
    ),
)
_NOT_BEGUN = Text(
    'still "{control}" {seconds:.3g} s after the charger was ready, {limit:g} s are allowed',
    '充电机就绪 {seconds:.3g} s 后仍为 "{control}",允许 {limit:g} s',
)
_NOT_RESUMED = Text(
    'still "{control}" {seconds:.3g} s after the charger\'s fault was gone,'
    " {limit:g} s are allowed",
    '充电机故障消失 {seconds:.3g} s 后仍为 "{control}",允许 {limit:g} s',
)
_NOT_ENDED = Text(
    'still "{control}" {seconds:.3g} s after the charger\'s last report, {limit:g} s are allowed',
    '充电机最后一次上报 {seconds:.3g} s 后仍为 "{control}",允许 {limit:g} s',
)


class _Charging(Reaction):
    """Knows when the charger reports, and whether the pack asks it to charge."""

    wants = (_CONTROL, _HARDWARE)

    def await_control(
        self, since: tuple[float, int], until: float, limit: float, text: Text, *, charge: bool
    ) -> None:
        """See that charging is commanded, or not commanded, in time.

        Nothing where there was less time, or where the pack did not speak.

        Parameters
        ----------
        since
            Second and number of the frame that asks for it.
        until
            The second up to which it is asked for.
        """
        begin, order = since
        told = self.track(_CONTROL).after(order).between(begin, min(begin + limit, until))
        charging = told.of(ChargeControl.START_TO_CHARGE)
        came = not charging.empty if charge else len(charging.time) < len(told.time)
        if told.empty or (not came and until < begin + limit):
            return
        self.findings.examine(PACK)
        if came:
            return
        last = float(told.time[-1])
        control = B2C_Charger.FIELDS["charge_control"].text(int(told.value[-1]))
        self.findings.add(
            Occurrence(
                subject=_ABOUT,
                start=begin,
                end=last,
                order=order,
                frames=len(told.time),
                measure=last - begin,
                text=text,
                values={"control": control, "seconds": last - begin, "limit": limit},
            )
        )

    def fault(self) -> tuple[tuple[float, int] | None, tuple[float, int] | None]:
        """When the charger first reports a fault of its hardware, and when that is gone."""
        reports = self.track(_HARDWARE)
        begin = first(reports.of(ChargerFault.FAULT))
        gone = first(reports.after(begin[1]).of(ChargerFault.OK)) if begin else None
        return begin, gone


class _Begins(_Charging):
    """Waits for the command to charge."""

    def finish(self, end: LogEnd) -> None:
        """Judge from the charger's first report to its fault."""
        ready = first(self.track(_HARDWARE).of(ChargerFault.OK))
        fault, _ = self.fault()
        if ready:
            limit = self.findings.limit(_BEGIN_LIMIT)
            self.await_control(
                ready, fault[0] if fault else end.time, limit, _NOT_BEGUN, charge=True
            )


class _Resumes(_Charging):
    """Waits for the command to charge once a fault of the charger is gone."""

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Judge where charging went on before the fault."""
        fault, gone = self.fault()
        if not fault or self.track(_CONTROL).at(fault[1]) != ChargeControl.START_TO_CHARGE:
            return
        if gone:
            last = float(self.track(_HARDWARE).time[-1])
            limit = self.findings.limit(_RESUME_LIMIT)
            self.await_control(gone, last, limit, _NOT_RESUMED, charge=True)


class _Ends(_Charging):
    """Waits for the end of charging once the charger is gone."""

    def finish(self, end: LogEnd) -> None:
        """Judge from the charger's last report on, where charging went on then."""
        reports = self.track(_HARDWARE)
        if reports.empty:
            return
        last = float(reports.time[-1]), int(reports.order[-1])
        if self.track(_CONTROL).at(last[1]) == ChargeControl.START_TO_CHARGE:
            limit = self.findings.limit(_END_LIMIT)
            self.await_control(last, end.time, limit, _NOT_ENDED, charge=False)


CHARGE_BEGINS = Rule(
    id="reaction-charge-begins",
    title=Text("Charging begins once the charger is ready", "充电机就绪后开始充电"),
    purpose=Text(
        "The charger waits for the pack's command; a full or faulty pack is right not to give it.",
        "充电机等待电池包的启动命令;电池已满或故障时可不启动。",
    ),
    clause="Table 18 row 3 (5.3), Table 19 row 6 (5.4)",
    severity=Severity.SHOULD,
    judges=(PACK,),
    tolerances=(_BEGIN_LIMIT,),
    watch=_Begins,
)

CHARGE_RESUMES = Rule(
    id="reaction-charge-resumes",
    title=Text("Charging begins again after a charger's fault", "充电机故障消失后重启充电"),
    purpose=Text(
        "The pack ends charging on a fault of the charger's hardware and begins again after it.",
        "充电机硬件故障时 BMU 终止充电流程,待故障消失后重启充电流程。",
    ),
    clause="Table 19 row 3 (5.4)",
    severity=Severity.MUST,
    judges=(PACK,),
    tolerances=(_RESUME_LIMIT,),
    watch=_Resumes,
)

CHARGE_ENDS = Rule(
    id="reaction-charge-ends",
    title=Text("Charging ends when the charger is gone", "充电机断开后停止充电"),
    purpose=Text(
        "A pack that goes on charging keeps its contactors closed towards nothing.",
        "若继续充电,充电继电器将在无充电机时保持闭合。",
    ),
    clause="5.4",
    severity=Severity.SHOULD,
    judges=(PACK,),
    tolerances=(_END_LIMIT,),
    watch=_Ends,
)
