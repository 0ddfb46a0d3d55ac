"""What the monitor shows of this standard: a pack with its cells, its VIN and its code."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from swapcan._generated.protocol import PROTOCOL
from swapcan.glance.cells import CellMap, Cells
from swapcan.glance.pack import Pack, pack_of
from swapcan.messages import B2V_ST1, B2V_BattInfo2, B2V_Ucell
from swapcan.transfer import CellVoltages, Outcome, PackCode, ProbeTemperatures, Transfers, Vin
from typedcan.monitor.glance import Alarm, Known, Noticed
from typedcan.wire.message import Message
from typedcan.wire.protocol import FieldRef, Protocol

_SUMMARY = ("soc", "voltage_inside", "current", "hv_state", "fault_level")
"""The items of the pack in the line that sums up."""


@dataclass(frozen=True, slots=True)
class PackLook:
    """The pack at one moment.

    ``vin`` and ``pack_code`` are the last that were complete, empty where none was; ``alarms`` are
    those of all nodes.
    """

    pack: Pack
    cells: CellMap
    vin: str
    pack_code: str
    alarms: tuple[Alarm, ...]

    @property
    def name(self) -> str:
        """What its pane is called."""
        return "pack"

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it.

        ``{"pack": {"vin": "", "pack_code": "", "items": {"soc": {"text": "80 %", "value": 80.0,
        "unit": "%", "mark": ""}, ...}, "alarms": [{"message": "B2V_ST1", ...}]},
        "cells": {"received": 96, "total": 96, "age": 0.01, "volts": {"1": [3.312, null, ...]}}}``.
        What nobody has told yet has an empty text and a null value; ``mark`` says why not to rely
        on a value: "invalid", "late", "lost" and the like. A cell is its voltage, "Signal Invalid"
        or "Abnormal", or null where nothing has come.
        """
        return {
            "pack": {
                "vin": self.vin,
                "pack_code": self.pack_code,
                "items": self.pack.as_dict(),
                "alarms": [asdict(alarm) for alarm in self.alarms],
            },
            "cells": self.cells.as_dict(),
        }

    def summary(self) -> list[str]:
        """State of charge, voltage, current and the like, as far as they are known."""
        items = (self.pack.item(key) for key in _SUMMARY)
        return [
            f"{item.label} {item.text}{f' ({item.mark})' if item.mark else ''}"
            for item in items
            if item.text
        ]

    def text(self, width: int) -> Any:
        """All of it as a text of `rich`, in lines of so many characters at most."""
        from swapcan.glance.pack_text import pack_text  # with the view alone there is rich

        return pack_text(self.pack, self.cells, self.vin, self.pack_code, width)


class PackGlance:
    """Gathers what is to be known first of a pack.

    Parameters
    ----------
    protocol
        This standard, be it with message classes of its own; see `glance_of`.
    """

    def __init__(self, protocol: Protocol = PROTOCOL) -> None:
        self._protocol = protocol
        self._transfers = Transfers(protocol)
        self._cells = Cells()
        self._vin = ""
        self._pack_code = ""
        self.summed_up = (FieldRef(protocol.message(B2V_ST1.NAME), "fault_levl"),)
        """Alarms that only sum up what others say: the level of the worst fault."""

    @property
    def next_check(self) -> float:
        """When `check` has something to do if nothing comes; infinite for never."""
        return self._transfers.next_deadline

    def take(self, message: Message, now: float) -> tuple[Noticed, ...]:
        """Take a message that came at ``now``, and tell what it brings about."""
        outcomes = self._transfers.take(message, now)
        for outcome in outcomes:
            self._keep(outcome)
        if message.NAME == B2V_Ucell.NAME:
            self._cells.take(message, now)
        elif message.NAME == B2V_BattInfo2.NAME:
            self._cells.take_totals(message)
        return tuple(_noticed(outcomes))

    def check(self, now: float) -> tuple[Noticed, ...]:
        """What time alone has changed up to now."""
        return tuple(_noticed(self._transfers.expire(now)))

    def look(self, known: Known) -> PackLook:
        """What there is to be seen."""
        return PackLook(
            pack=pack_of(self._protocol, known),
            cells=self._cells.map(known.time),
            vin=self._vin,
            pack_code=self._pack_code,
            alarms=known.alarms,
        )

    def _keep(self, outcome: Outcome) -> None:
        if isinstance(outcome, Vin):
            self._vin = outcome.text
        elif isinstance(outcome, PackCode):
            self._pack_code = outcome.text
        elif isinstance(outcome, CellVoltages):
            self._cells.take_set(outcome)


def glance_of(protocol: Protocol) -> PackGlance | None:
    """The glance at a pack, where the protocol has the messages of this standard; else None.

    In whatever words: one made from a database with Chinese labels has classes of its own.
    """
    return PackGlance(protocol) if _names(protocol) == _names(PROTOCOL) else None


def _names(protocol: Protocol) -> list[tuple[str, tuple[str, ...]]]:
    return [(kind.NAME, tuple(kind.FIELDS)) for kind in protocol.messages]


def _noticed(outcomes: tuple[Outcome, ...]) -> Iterator[Noticed]:
    for outcome in outcomes:
        if isinstance(outcome, Vin):
            yield Noticed(f"VIN {outcome}")
        elif isinstance(outcome, PackCode):
            yield Noticed(f"pack code {outcome}")
        elif not isinstance(outcome, CellVoltages | ProbeTemperatures):
            yield Noticed(str(outcome))
