"""The rules of this standard: those that hold for any protocol, in its words, and its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    BSU_BMS_0,
    V2B_CMD,
    B2V_BattInfo1,
    B2V_SysCode1,
    B2V_Temp,
    B2V_Ucell,
    V2B_RQData,
)
from swapcan.rules import charging, cooling, notices, pack, texts, voltage
from swapcan.rules.voltage import node_awake, node_silence, relays_before_command, start_state
from swapcan.rules.wording import worded
from typedcan.judge.rule import Rule
from typedcan.judge.rules import rules_for
from typedcan.judge.scope import OpenCodes, Scope
from typedcan.wire.message import Message

_COMMANDS = ("hv_on_off", "hv_acc_on_off", "heat_on_off")


def _names(message: type[Message], *fields: str) -> list[str]:
    return [message.FIELDS[field].dbc_name for field in fields]


SCOPE = Scope(
    # Table 8 row 2 names five manufacturers of many; row 3 labels one number of 32.
    examples=frozenset(_names(B2V_SysCode1, "manufacturer", "sys_code_length")),
    # Tables 6 and 7 number CSCs from 1, as tables 9 and 10 do; how far depends on the pack.
    from_one=(
        *_names(B2V_ST4, "max_temp_csc_no", "min_temp_csc_no"),
        *_names(B2V_ST5, "max_ucell_csc_no"),
        *_names(B2V_ST6, "min_ucell_csc_no"),
    ),
    # Table 1 row 12 has no other code for a pack that is not charging.
    reserved_used=frozenset(_names(B2V_ST1, "chg_mode")),
    # Relay states, which the other side may measure, and items that pad a CSC's last frame.
    without_value=frozenset(
        {
            *_names(B2V_ST0, *B2V_ST0.FIELDS),
            *_names(B2V_Ucell, *B2V_Ucell.FIELDS),
            *_names(B2V_Temp, *B2V_Temp.FIELDS),
            *_names(V2B_CMD, *(name for name in V2B_CMD.FIELDS if name not in _COMMANDS)),
        }
    ),
    open_codes={
        # An unused field is filled with 0 by many; the level that E54 asks for has no meaning.
        **dict.fromkeys(
            (
                *_names(B2V_BattInfo1, "batt_type", "cool_type"),
                *_names(V2B_RQData, "rq_batt_info", "rq_sys_code"),
            ),
            OpenCodes((0,)),
        ),
        **dict.fromkeys(_names(B2V_ST0, "flt_chg_plug_ot"), OpenCodes((3,), ("E54",))),
        **dict.fromkeys(_names(BSU_BMS_0, "connect_st"), OpenCodes((0,), ("E20",))),
    },
    # 15 is no value of theirs; nothing says that all others are (E48).
    open_ends=frozenset((*_names(B2V_ST1, "aliv"), *_names(V2B_CMD, "aliv"))),
    transfers={"cell_voltages": "cells", "probe_temperatures": "probes"},
)
"""What the tables leave open."""


def _of_this_standard(rule: Rule) -> Rule:
    return worded(replace(rule, watch=_WATCHED_HERE.get(rule.id, rule.watch)))


_BEFORE: Mapping[str, tuple[Rule, ...]] = {
    "node-awake": (node_silence.RULE,),
    "bus-load": (start_state.RULE, relays_before_command.RULE),
    "cells-complete": texts.RULES,
}
"""Rules of this standard that are listed among the others, by the one that comes after them."""

_WATCHED_HERE = {"node-awake": node_awake.NodeAwakeHere}
"""What watches for a rule where this standard knows more than its model."""

RULES: tuple[Rule, ...] = (
    *(
        each
        for rule in rules_for(PROTOCOL, SCOPE)
        for each in (*_BEFORE.get(rule.id, ()), _of_this_standard(rule))
    ),
    *pack.RULES,
    *voltage.RULES,
    *charging.RULES,
    *cooling.RULES,
    *notices.RULES,
)
"""Every rule once, in the order in which reports list them."""


def rule_of(rule_id: str) -> Rule:
    """The rule of that id; raises `LookupError`."""
    for rule in RULES:
        if rule.id == rule_id:
            return rule
    raise LookupError(f"there is no rule {rule_id!r}")
