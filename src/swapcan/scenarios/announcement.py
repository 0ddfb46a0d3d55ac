"""What a scenario sends, told before anything is sent."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from swapcan._generated.protocol import PROTOCOL
from swapcan.nodes.plan import PlannedStep
from swapcan.scenarios.scenario import Scenario
from typedcan.drive.driving import LEAVING, look_out_time
from typedcan.model.editions import unsure_codes
from typedcan.simulate.faults import PlannedFault
from typedcan.wire.message import Message

_AT_FIRST: Mapping[str, str] = {
    "VCU": (
        "V2B_CMD: HV_OnOff = HV Off, HV_ACC_OnOff = HV ACC Off, VehicleSpeed = 0 km/h,"
        " Heat_OnOff = Heat Off, all contactors of the truck Open without fault, relays of the"
        " pack Signal Invalid; V2B_RQData once: nothing is asked for; V2B_VIN where the pack asks"
    ),
    "CHG": "nothing: the charger is not connected yet",
}
_STEPS: Mapping[str, str] = {
    "hv_on": (
        "V2B_CMD: AttRelayST, MainMotorConST and AttConST1 = Closed; two frames later, once"
        " B2V_ST1 is heard, HV_OnOff = HV On, HV_ACC_OnOff = HV ACC On"
    ),
    "hv_off": "V2B_CMD: HV_OnOff = HV Off, HV_ACC_OnOff = HV ACC Off, contactors Open",
    "ask": (
        "V2B_RQData: RQSysCode = Request SysCode Data, RQBattInfo = Request BattInfo Data, once a"
        " second until each is answered, 5 s at most; then Not request"
    ),
    "charge": (
        "C2B_ACStatus from half a second later: VoltageOutput and CurrentOutput as B2C_Charger"
        " asks, within 1000 V and 300 A (said, not given), ChargerStart = On while it asks"
    ),
}
_STEP_ENDS: Mapping[str, str] = {"charge": "C2B_ACStatus comes no more"}
_FAULTS: Mapping[str, str] = {
    "bus_silence": "nothing at all is sent",
    "wrong_checksum": "every checksum is wrong",
    "stuck_counter": "the counter stays as it is",
    "charger_hardware": "C2B_ACStatus: ChargerHardware = Fault, no voltage, no current",
}
_WARNINGS: Mapping[str, str] = {
    "hv_on": "THE PACK MAY CLOSE ITS CONTACTORS: high voltage may be on its terminals",
    "charge": "THE PACK MAY CLOSE ITS CHARGING CONTACTORS",
}


def announcement(scenario: Scenario, nodes: Sequence[str]) -> Iterator[str]:
    """The lines, for a scenario in which those nodes are played."""
    yield f"{scenario.name}: {scenario.title.en}; {scenario.seconds:g} s, as {', '.join(nodes)}"
    for node in nodes:
        for kind in PROTOCOL.sent_by(node):
            yield f"  {_sent(kind)}"
    seconds = look_out_time(kind for node in nodes for kind in PROTOCOL.sent_by(node))
    yield f"  {seconds:g} s before: it only listens, and ends if somebody else sends one of these"
    lines = [(0.0, f"{node}: {_AT_FIRST[node]}") for node in nodes]
    for step in scenario.steps(nodes):
        lines += _step_lines(step)
    for fault in scenario.faults:
        lines += _fault_lines(fault)
    for second, text in sorted(lines, key=lambda line: line[0]):
        yield f"  {second:5g} s  {text}"
    if "VCU" in nodes:
        yield f"    end  VCU: {_STEPS['hv_off']}, until B2V_ST1 says HV open, {LEAVING:g} s at most"
    yield from _left_invalid(nodes)
    if "CHG" in nodes:
        yield f"    end  CHG: {_STEP_ENDS['charge']}"
    for step in scenario.steps(nodes):
        if step.name in _WARNINGS:
            yield f"  {_WARNINGS[step.name]}"


def _left_invalid(nodes: Sequence[str]) -> Iterator[str]:
    """What is left with no valid value, since editions disagree about its codes."""
    for name, codes in unsure_codes(PROTOCOL.model).items():
        sender = PROTOCOL.message(name).SENDER
        if sender in nodes:
            yield f"    end  {sender}: {', '.join(codes)} = Signal Invalid: codes differ by edition"


def _sent(kind: type[Message]) -> str:
    period = "on event" if kind.PERIOD is None else f"every {1000 * kind.PERIOD:g} ms"
    return f"{kind.NAME} 0x{kind.FRAME_ID:08X} {period}"


def _step_lines(step: PlannedStep) -> list[tuple[float, str]]:
    lines = [(step.start, f"{step.node}: {_STEPS[step.name]}")]
    if step.name in _STEP_ENDS:
        lines.append((step.end, f"{step.node}: {_STEP_ENDS[step.name]}"))
    return lines


def _fault_lines(fault: PlannedFault) -> list[tuple[float, str]]:
    text = f"{fault.target}: {_FAULTS[fault.name]}"
    return [(fault.start, text), (fault.end, f"{fault.target}: no more of that")]
