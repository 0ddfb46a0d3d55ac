"""Parts of the rules that hold for any protocol which rest on what this standard leaves open."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.judge.findings import LeftOpen

_BY_TURNS = (LeftOpen("B2V_Ucell", ("E55",)), LeftOpen("B2V_Temp", ("E55",)))

LEFT_OPEN: Mapping[str, tuple[LeftOpen, ...]] = {
    # No rule is printed for these checksums and counters.
    "checksum": (
        *(LeftOpen(f"B2V_SysCode{number}", ("E46",)) for number in range(1, 5)),
        LeftOpen("BMS_TMS_0", ("E47",)),
    ),
    "counter-sequence": (LeftOpen("BSU_Live", ("E49",)), LeftOpen("BMS_Life", ("E49",))),
    # V2B_RQData has the address 0xEF in one place only.
    "source-address": (LeftOpen("V2B_RQData", ("E41",)),),
    # Whether a period is that of a frame or of all, where frames take turns.
    "period-mean": _BY_TURNS,
    "period-gap": _BY_TURNS,
}
"""By ids of rules, what of them rests on what the standard leaves open."""
