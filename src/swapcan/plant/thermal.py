"""What a pack asks of its cooling unit, table 19 (5.5)."""

from __future__ import annotations

from swapcan.messages import ThermalMode
from swapcan.plant.sensors import Measurement
from typedcan.model.signal_state import SignalState

_COOL_FROM, _COOL_TO = 32.0, 28.0  # degC of the warmest probe
_HEAT_FROM, _HEAT_TO = 5.0, 10.0  # degC of the coldest one
_WISHED_FROM, _WISHED_TO = 13.0, 15.0  # the same where the VCU commands heating

SET_TEMPERATURES = {ThermalMode.COOLING: 20.0, ThermalMode.HEATING: 35.0}
"""degC of the water."""

NEUTRAL_TEMPERATURE = 25.0
"""degC that the water is set to in the other modes."""


def next_mode(
    before: ThermalMode, measurement: Measurement, *, busy: bool, heating_wished: bool = False
) -> ThermalMode:
    """The mode to ask for after another one.

    ``busy`` says that current may flow: then the water circulates at least. ``heating_wished`` is
    the command of the VCU.
    """
    warmest = measurement.highest_probe.value
    coldest = measurement.lowest_probe.value
    idle = ThermalMode.SELF_CIRCULATION if busy else ThermalMode.OFF
    if isinstance(warmest, SignalState) or isinstance(coldest, SignalState):
        return idle
    if warmest >= (_COOL_TO if before is ThermalMode.COOLING else _COOL_FROM):
        return ThermalMode.COOLING
    heat_from, heat_to = (_WISHED_FROM, _WISHED_TO) if heating_wished else (_HEAT_FROM, _HEAT_TO)
    if coldest <= (heat_to if before is ThermalMode.HEATING else heat_from):
        return ThermalMode.HEATING
    return idle
