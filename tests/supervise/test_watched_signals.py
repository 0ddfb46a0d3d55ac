"""Signals that say something is wrong, told when that begins and when it ends."""

from decimal import Decimal

import cantools
import pytest
from cantools.database.can import Database
from supervise.arrivals import DBC, received

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_BattInfo2,
    RelayState,
)
from typedcan.model.protocol import Signal
from typedcan.model.signal_state import SignalState
from typedcan.supervise import SignalChanged, SupervisionEvent, Supervisor
from typedcan.supervise.signal_watch import Judge, judge_of
from typedcan.wire.fields import PhysicalField


def told(*frames: tuple[str, dict[str, int]], node: str = "VCU") -> list[list[str]]:
    """What is said of signals with each of these frames, 1 s apart."""
    supervisor = Supervisor(PROTOCOL, node)
    lines = []
    for n, (name, raw) in enumerate(frames):
        events = supervisor.take(received(name, **raw), float(n))
        lines.append([str(event) for event in events if isinstance(event, SignalChanged)])
    return lines


def test_an_invalid_value_is_told_when_it_begins_and_when_it_ends() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    assert len(supervisor.take(received("B2V_ST2", SOC=100), 0.0)) == 1  # never seen -> alive
    assert supervisor.take(received("B2V_ST2", SOC=255), 0.1) == (
        SignalChanged(B2V_ST2, "soc", "invalid", active=True, value=SignalState.INVALID, at=0.1),
    )
    assert supervisor.take(received("B2V_ST2", SOC=255, SOH=50), 0.2) == ()
    assert supervisor.take(received("B2V_ST2", SOC=100), 0.3) == (
        SignalChanged(B2V_ST2, "soc", "invalid", active=False, value=40.0, at=0.3),
    )
    assert supervisor.take(received("B2V_ST2", SOC=101), 0.4) == ()


def test_what_is_wrong_with_the_first_frame_is_told() -> None:
    assert told(("B2V_ST2", {"SOH": 255})) == [["B2V_ST2.soh: invalid: Signal Invalid"]]


def test_abnormal_is_told_apart_from_invalid() -> None:
    """Table 6: 254 is abnormal, 255 invalid."""
    assert told(("B2V_ST4", {"Max_Temp": 254}), ("B2V_ST4", {"Max_Temp": 255})) == [
        ["B2V_ST4.max_temp: abnormal: Abnormal"],
        [
            "B2V_ST4.max_temp: no longer abnormal: Signal Invalid",
            "B2V_ST4.max_temp: invalid: Signal Invalid",
        ],
    ]


def test_a_code_that_is_labelled_invalid_is_invalid() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    events = supervisor.take(received("B2V_ST0", ST_MainPos=3), 0.0)
    assert events[1:] == (
        SignalChanged(
            B2V_ST0,
            "st_main_pos",
            "invalid",
            active=True,
            value=RelayState.SIGNAL_INVALID,
            at=0.0,
        ),
    )


@pytest.mark.parametrize(("raw", "is_outside"), [(50, False), (51, True), (254, True)])
def test_a_value_beyond_the_printed_range_is_out_of_range(raw: int, is_outside: bool) -> None:  # noqa: FBT001
    """Table 13: the platform voltage of a cell is 0 to 5.0 V in steps of 0.1 V."""
    supervisor = Supervisor(PROTOCOL, "VCU")
    events = supervisor.take(received("B2V_BattInfo2", Platform_Ucell=raw), 0.0)
    kinds = [event.kind for event in events if isinstance(event, SignalChanged)]
    assert kinds == (["out of range"] if is_outside else [])


def test_the_last_value_of_a_range_is_in_it_though_its_float_is_not() -> None:
    field = PhysicalField(
        signal=Signal(name="X", start=0, length=3, minimum=Decimal(0), maximum=Decimal("0.3")),
        name="x",
        dbc_name="X",
        title="",
        length=3,
        factor=0.1,
        minimum=0.0,
        maximum=0.3,
    )
    judge = judge_of(field)
    assert judge
    assert 3 * 0.1 > 0.3
    assert [judge(raw * 0.1) for raw in (2, 3, 4)] == [None, None, "out of range"]


@pytest.mark.parametrize("signed", [False, True])
def test_a_value_within_what_the_bits_can_hold_is_never_judged(*, signed: bool) -> None:
    def judge(maximum: float, states: dict[int, SignalState]) -> Judge | None:
        low = -128 if signed else 0
        signal = Signal(
            name="Temp",
            start=0,
            length=8,
            signed=signed,
            minimum=Decimal(low - 40),
            maximum=Decimal(maximum),
        )
        return judge_of(
            PhysicalField(
                signal=signal,
                name="temp",
                dbc_name="Temp",
                title="",
                length=8,
                offset=-40.0,
                minimum=low - 40.0,
                maximum=maximum,
                states=states,
            )
        )

    highest = (127 if signed else 255) - 40.0
    assert judge(highest, {}) is None
    narrower = judge(highest - 5, {})
    assert narrower
    assert (narrower(highest - 5), narrower(highest)) == (None, "out of range")
    states = {126: SignalState.ABNORMAL, 127: SignalState.INVALID}
    for found in (judge(highest, states), judge(highest - 5, states)):
        assert found
        assert found(SignalState.INVALID) == "invalid"
        assert found(SignalState.ABNORMAL) == "abnormal"
        assert found(0.0) is None


def test_a_value_that_stays_out_of_range_is_told_once() -> None:
    name = "B2V_BattInfo2"
    assert told(*((name, {"Platform_Ucell": raw}) for raw in (60, 70, 80, 33))) == [
        ["B2V_BattInfo2.platform_ucell: out of range: 6 V"],
        [],
        [],
        ["B2V_BattInfo2.platform_ucell: no longer out of range: 3.3 V"],
    ]
    assert B2V_BattInfo2.FIELDS["platform_ucell"].maximum == 5.0


def test_a_code_without_a_meaning_is_unknown() -> None:
    """Table 12 row 44 has no third level; table 17 gives the connector 1 and 2 only."""
    assert told(("B2V_ST0", {"Flt_ChgPlugOT": 3})) == [["B2V_ST0.flt_chg_plug_ot: unknown code: 3"]]
    said = told(*(("BSU_BMS_0", {"ConnectSt": code}) for code in (0, 1, 2, 3)))
    assert said == [
        ["BSU_BMS_0.connect_st: unknown code: 0"],
        ["BSU_BMS_0.connect_st: no longer unknown code: Connected"],
        [],
        ["BSU_BMS_0.connect_st: unknown code: 3"],
    ]


def test_an_alarm_is_told_with_each_of_its_levels() -> None:
    said = told(*(("B2V_ST1", {"Flt_OverTemp": level}) for level in (0, 1, 3, 3, 0)))
    assert said == [
        [],
        ["B2V_ST1.flt_over_temp: alarm: Level 1-Light fault"],
        ["B2V_ST1.flt_over_temp: alarm: Level3-Most severe fault"],
        [],
        ["B2V_ST1.flt_over_temp: no longer alarm: Normal"],
    ]


def test_faults_that_are_labelled_ok_or_inactive_at_0_are_alarms() -> None:
    said = told(
        ("C2B_ACStatus", {"F_ChargerHardware": 1, "St_ChargerStart": 1}),
        ("TMS_BMS_0", {"FaultLv": 2}),
        node="BMU",
    )
    # Table 19 row 7: the charger's start is no fault, whatever it is.
    assert said[0][1:] == []
    assert said[0][0].startswith("C2B_ACStatus.charger_hardware: alarm: Fault")
    assert "TMS_BMS_0.fault_lv: alarm: Level 2" in said[1]


def test_every_fault_signal_of_the_tables_is_an_alarm() -> None:
    """A signal is a fault where the DBC calls code 0 Normal or OK and code 1 otherwise."""
    database = cantools.database.load_file(DBC)
    assert isinstance(database, Database)
    tried = 0
    for message in PROTOCOL.messages:
        for field in message.FIELDS.values():
            signal = database.get_message_by_name(message.NAME).get_signal_by_name(field.dbc_name)
            labels = {int(code): str(label) for code, label in (signal.choices or {}).items()}
            if labels.get(0) not in ("Normal", "OK"):
                continue
            tried += 1
            supervisor = Supervisor(PROTOCOL, message.RECEIVERS[0])
            supervisor.take(received(message.NAME), 0.0)
            events = supervisor.take(received(message.NAME, **{field.dbc_name: 1}), 0.1)
            alarms = [e for e in events if isinstance(e, SignalChanged)]
            assert [(e.field, e.kind, e.active) for e in alarms] == [(field.name, "alarm", True)]
    assert tried > 50


def test_signals_of_one_frame_are_told_in_the_order_of_their_bits() -> None:
    ((first, second),) = told(("B2V_ST1", {"Flt_Fire": 1, "Flt_OverTemp": 1}))
    assert first.startswith("B2V_ST1.flt_over_temp")
    assert second.startswith("B2V_ST1.flt_fire")


def test_each_frame_of_the_cell_voltages_has_its_own_signals() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    names = _names("B2V_Ucell")[2:]
    healthy = dict.fromkeys(names, 3300)
    broken = healthy | {names[1]: 65535}
    events: list[SupervisionEvent] = []
    for n in range(4):
        events += supervisor.take(received("B2V_Ucell", FrameNo=1, CSCNo=1, **healthy), n * 0.1)
        events += supervisor.take(received("B2V_Ucell", FrameNo=2, CSCNo=7, **broken), n * 0.1)
    told = [event for event in events if isinstance(event, SignalChanged)]
    assert [str(event) for event in told] == [
        "B2V_Ucell[7, 2].csc_no_ucell_n1: invalid: Signal Invalid"
    ]
    (healed,) = supervisor.take(received("B2V_Ucell", FrameNo=2, CSCNo=7, **healthy), 0.5)
    assert isinstance(healed, SignalChanged)
    assert (healed.part, healed.active) == ((7, 2), False)
    assert healed.value == pytest.approx(3.3)


def test_bytes_behind_the_last_character_of_a_vin_mean_nothing() -> None:
    """17 characters in 3 frames of 7: the last four bytes of the third are not defined."""
    names = _names("V2B_VIN")[1:]
    characters = dict.fromkeys(names, 65)
    rest = characters | dict.fromkeys(names[3:], 0x01)
    assert told(("V2B_VIN", {"FrameNo": 3, **rest}), node="BMU") == [[]]
    wrong = told(("V2B_VIN", {"FrameNo": 3, **rest, names[2]: 0x2A}), node="BMU")
    assert wrong == [["V2B_VIN[3].b3_10_17: unknown code: 0x2A"]]
    wrong = told(("V2B_VIN", {"FrameNo": 2, **characters, names[2]: 0x2A}), node="BMU")
    assert wrong == [["V2B_VIN[2].b3_10_17: unknown code: 0x2A"]]


def test_a_length_of_the_pack_code_and_its_fill_are_no_unknown_codes() -> None:
    names = _names("B2V_SysCode1")
    raw = dict.fromkeys(names[3:], 65) | {names[1]: 1, names[2]: 24, names[-1]: 0}
    assert told(("B2V_SysCode1", raw)) == [[]]


def _names(message: str) -> list[str]:
    return [field.dbc_name for field in PROTOCOL.message(message).FIELDS.values()]


def test_signals_without_a_wrong_value_say_nothing() -> None:
    assert B2V_ST1.FIELDS["bms"].labels[3] == "Fail to HV on"
    energy = dict.fromkeys(_names("B2V_ElecEnergy"), 0xFFFF)
    assert told(("B2V_ElecEnergy", energy), ("B2V_ST1", {"B2V_ST1_BMS": 3})) == [[], []]
