"""The whole screen as text, for a fixed set of frames and a clock that stands still.

After a change on purpose, renew the screens and look at what is different:

    SWAPCAN_RENEW_SCREENS=1 pytest tests/monitor/test_monitor_screen.py; git diff
"""

from __future__ import annotations

import asyncio
import os
from pathlib import Path

import can
import pytest
from monitor.monitored import Monitored, frame

pytest.importorskip("textual", reason="the view needs textual")

from monitor.screen import screen_lines

from typedcan.monitor.view import MonitorApp

_RENEW = bool(os.environ.get("SWAPCAN_RENEW_SCREENS"))


_CHARGE_RELAYS_OPEN = dict.fromkeys(("ST_ChgPos1", "ST_ChgNeg1", "ST_ChgPos2", "ST_ChgNeg2"), 1)


def _cells(at: float) -> list[can.Message]:
    names = ("CSCNo_UcellN", "CSCNo_UcellN1", "CSCNo_UcellN2")
    return [
        frame(
            "B2V_Ucell",
            at,
            UC_CSCNo=csc,
            FrameNo=number,
            **{name: 3.3 + (csc + 4 * number + n) / 1000 for n, name in enumerate(names)},
        )
        for csc in (1, 2)
        for number in (1, 2, 3)
        if (csc, number) != (2, 2)
    ]


def _cycle(at: float, counter: int) -> list[can.Message]:
    return [
        frame("V2B_CMD", at, ALIV=counter, HV_OnOff=1),
        frame("B2V_ST0", at, ST_MainPos=2, ST_MainNeg=2, ST_Prechg=1, **_CHARGE_RELAYS_OPEN),
        frame("B2V_ST1", at, ALIV=counter, BMS=2, Fault_Levl=1, Flt_OverTemp=1),
        frame("B2V_ST2", at, SOC=76.4, SOH=102, Current=80),
        frame("B2V_ST3", at, Upack_Batt=612.5, Upack_Out=612, Pos_InsRes=5000, Neg_InsRes=4800),
        frame("B2V_ST4", at, Max_Temp=57, MaxTemp_CSCNo=2, MaxTemp_Position=3, Avg_Temp=30),
        frame("B2V_ST5", at, Max_Ucell=3.317, MaxUcell_CSCNo=2, MaxUcell_Position=9),
        *_cells(at),
    ]


def _drive(monitored: Monitored) -> None:
    """A second of driving; the swap controller falls silent, a frame comes damaged."""
    for n in range(10):
        monitored.hear(*_cycle(n / 10, n))
        if n < 3:
            monitored.hear(frame("BSU_BMS_0", n / 10, BSU_Live=n))
    monitored.hear(
        can.Message(arbitration_id=0x1882D0F3, data=bytes(7), timestamp=0.95),
        can.Message(arbitration_id=0x18FEF100, data=bytes(8), timestamp=0.95),
    )
    monitored.clock.advance_to(1.0)


@pytest.mark.parametrize(("pane", "keys"), [("messages", ""), ("signals", "2"), ("pack", "3")])
def test_the_screen_looks_as_it_did(pane: str, keys: str, monitored: Monitored) -> None:
    _drive(monitored)
    app = MonitorApp(monitored.session, "test bus")

    async def shown() -> str:
        async with app.run_test(size=(100, 30)) as pilot:
            await pilot.press("slash", *"B2V_ST1", "enter", "escape", *keys)
            app.renew()
            await pilot.pause()
            return "".join(f"{line}\n" for line in screen_lines(app))

    screen = Path(__file__).with_name(f"screen-{pane}.txt")
    text = asyncio.run(shown())
    if _RENEW:
        screen.write_text(text, encoding="utf-8")
    assert text == screen.read_text(encoding="utf-8")
