"""Which codes act, as the tables have them, and what is known of those that were sent."""

from __future__ import annotations

import pytest
from node.rough_bus import database

from swapcan import Codec, EncodeError
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_ST2,
    BMS_TMS_0,
    V2B_CMD,
    AccessoryHvCommand,
    B2C_Charger,
    C2B_ACStatus,
    ChargeControl,
    ChargerOperation,
    HeatCommand,
    HvCommand,
    HvRequest,
    ThermalMode,
)
from typedcan.node.commanded import SentCommands
from typedcan.wire.acting import acting_fields, acts, safe_codes, what_acts
from typedcan.wire.message import Message

TABLE = {
    # Table 14 rows 3, 4, 6; table 18 row 3; table 19 (5.5) rows 1, 2: the codes, and the safe one
    (V2B_CMD, "hv_on_off"): ({1}, 2),
    (V2B_CMD, "hv_acc_on_off"): ({1}, 2),
    (V2B_CMD, "heat_on_off"): ({1}, 2),
    (B2C_Charger, "charge_control"): ({0}, 1),
    (BMS_TMS_0, "reqst_tms_hv_on"): ({0}, 1),
    (BMS_TMS_0, "reqst_set_tms_sts"): ({1, 2, 3}, 0),
}

REST: dict[type[Message], Message] = {
    V2B_CMD: V2B_CMD(),
    B2C_Charger: B2C_Charger(charge_control=ChargeControl.NORMAL_STOP_TO_CHARGE),
    BMS_TMS_0: BMS_TMS_0(reqst_tms_hv_on=HvRequest.REQUEST_HV_OFF),
}
"""Nothing acts in these."""


def with_code(kind: type[Message], field: str, code: int) -> Message:
    given = {name: getattr(REST[kind], name) for name in kind.FIELDS}
    return kind(**(given | {field: code}))


def test_the_codes_that_act_are_those_of_the_tables() -> None:
    known = {
        (kind, field.name): (set(field.acting.codes), field.acting.safe)
        for kind in PROTOCOL.messages
        for field in acting_fields(kind)
        if field.acting
    }
    assert known == TABLE


@pytest.mark.parametrize(("kind", "field"), TABLE)
def test_a_message_acts_with_these_codes_and_with_no_other(kind: type[Message], field: str) -> None:
    codes, safe = TABLE[kind, field]
    for code in range(4):
        message = with_code(kind, field, code)
        assert acts(message) == (code in codes)
        assert len(what_acts(message)) == (code in codes)
    assert safe_codes(kind)[kind.FIELDS[field].dbc_name] == safe
    assert not acts(with_code(kind, field, safe))


def test_what_acts_is_told_with_its_label() -> None:
    command = V2B_CMD(hv_on_off=HvCommand.HV_ON, heat_on_off=HeatCommand.HEAT_ON)
    assert what_acts(command) == ("hv_on_off = HV On", "heat_on_off = Heat On")
    assert what_acts(REST[V2B_CMD]) == ()
    assert what_acts(B2V_ST2()) == ()


def test_what_only_says_that_something_is_on_does_not_act() -> None:
    report = C2B_ACStatus(charger_start=ChargerOperation.ON)
    assert not acts(report)
    assert acting_fields(C2B_ACStatus) == ()
    assert safe_codes(C2B_ACStatus) == {}


def test_a_value_that_cannot_be_sent_is_no_answer() -> None:
    with pytest.raises(EncodeError):
        acts(V2B_CMD(hv_on_off=7))  # type: ignore[arg-type]
    with pytest.raises(EncodeError):
        what_acts(V2B_CMD(hv_on_off=7))  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", REST)
def test_safe_codes_replace_what_acts_and_nothing_else(kind: type[Message]) -> None:
    message = REST[kind]
    for (other, field), (codes, _) in TABLE.items():
        if other is kind:
            message = type(message)(
                **({name: getattr(message, name) for name in kind.FIELDS} | {field: min(codes)})
            )
    reader = database().get_message_by_frame_id(kind.FRAME_ID)

    def decoded(*, safe: bool) -> dict[str, object]:
        data = Codec().encode(message, safe=safe)
        values = reader.decode(data, decode_choices=False, scaling=False)
        assert isinstance(values, dict)
        return {name: value for name, value in values.items() if "Check" not in name}

    wanted = {
        kind.FIELDS[field].dbc_name: safe
        for (other, field), (_, safe) in TABLE.items()
        if other is kind
    }
    if "V2B_CMD_Heat_OnOff" in wanted:
        wanted["V2B_CMD_Heat_OnOff"] = 3  # editions disagree about 1 and 2: Signal Invalid
    assert decoded(safe=True) == decoded(safe=False) | wanted
    assert decoded(safe=False) != decoded(safe=True)


ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)
OFF = V2B_CMD(hv_on_off=HvCommand.HV_OFF, hv_acc_on_off=AccessoryHvCommand.HV_ACC_OFF)
COOL = BMS_TMS_0(reqst_tms_hv_on=HvRequest.REQUEST_HV_OFF, reqst_set_tms_sts=ThermalMode.COOLING)


def acting(sent: SentCommands) -> list[Message]:
    return list(sent.acting)


def test_what_acts_counts_from_before_it_is_sent_until_something_else_was_sent() -> None:
    sent = SentCommands()
    assert (acting(sent), sent.all) == ([], ())
    sent.begin(ON)
    assert acting(sent) == [ON]  # it may go out although sending it fails
    sent.begin(OFF)
    assert acting(sent) == [OFF]  # which has not gone out yet, as far as is known
    sent.end(OFF)
    assert (acting(sent), sent.all) == ([], (OFF,))


def test_what_went_out_after_its_safe_codes_counts_again() -> None:
    sent = SentCommands()
    sent.begin(ON)
    sent.made_safe(ON)
    assert acting(sent) == []
    sent.end(ON)
    assert acting(sent) == [ON]


def test_each_message_counts_on_its_own_and_others_do_not() -> None:
    sent = SentCommands()
    for message in (COOL, B2V_ST2(), OFF, ON):
        sent.begin(message)
        sent.end(message)
    assert acting(sent) == [COOL, ON]
    assert sent.all == (COOL, ON)
    sent.made_safe(COOL)
    assert acting(sent) == [ON]
    sent.begin(B2V_ST2())
    sent.end(B2V_ST2())
    assert acting(sent) == [ON]
