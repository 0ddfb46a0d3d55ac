"""Charging by an AC charger: tables 18 and 19 (5.4), and rows 11 to 13 of table 1."""

from __future__ import annotations

from dataclasses import dataclass

from swapcan.messages import (
    C2B_ACStatus,
    ChargeControl,
    ChargerFault,
    ChargerOperation,
    ChargerTimeout,
    ChargeState,
)
from swapcan.plant.charge_path import ChargePath
from swapcan.plant.sensors import FULL_CELL, Measurement
from typedcan.model.signal_state import SignalState

_MATCHED = 0.05  # share by which the charger's voltage may differ from the battery's
_FULL = 100.0  # percent
_AGAIN = 97.0  # percent below which charging begins again


@dataclass(frozen=True, slots=True, kw_only=True)
class ChargeStatus:
    """What the VCU and the charger are told.

    Parameters
    ----------
    connected
        Whether a charger is there.
    state, control
        As the standard codes them.
    voltage, current
        Set points in V and A.
    """

    connected: bool = False
    state: ChargeState = ChargeState.READY_TO_BE_CHARGING
    control: ChargeControl = ChargeControl.NORMAL_STOP_TO_CHARGE
    voltage: float = 0.0
    current: float = 0.0


class Charging:
    """Decides whether and how to charge.

    Parameters
    ----------
    path
        The relays to the charger.
    """

    def __init__(self, path: ChargePath) -> None:
        self.path = path
        self.status = ChargeStatus()
        self._full = False
        self._heard = False  # since the plug is in

    def step(
        self,
        now: float,
        charger: C2B_ACStatus | None,
        measurement: Measurement,
        *,
        plugged: bool,
        allowed: bool,
        forbidden: bool,
        current: float,
    ) -> None:
        """Go on to a time in seconds.

        Parameters
        ----------
        now, measurement
            The time, and what the battery is like.
        charger
            What the charger said last; None where it is not there, or silent.
        plugged
            Whether its plug is in.
        allowed
            Whether charging is wanted at all.
        forbidden
            Whether the pack has a fault that rules it out.
        current
            What flows from the charger, in A.
        """
        limit = _FULL if not self._full else _AGAIN
        self._full = charger is not None and measurement.soc >= limit
        self._heard = charger is not None or (self._heard and plugged)
        if charger is None:
            self.status = self._unheard(plugged=plugged)
        else:
            self.status = self._decide(charger, measurement, allowed=allowed, forbidden=forbidden)
        matched = charger is not None and _is_matched(charger, measurement.voltage)
        wanted = (
            self.status.control is ChargeControl.START_TO_CHARGE
            # A relay that failed is not tried again before charging has been given up.
            or (self.path.failed and allowed and charger is not None)
        )
        self.path.step(now, wanted=wanted, matched=matched, current=current)

    def _unheard(self, *, plugged: bool) -> ChargeStatus:
        """Without a charger that speaks: one that did has failed, where its plug is still in."""
        if plugged and self._heard:
            return ChargeStatus(
                connected=True,
                state=ChargeState.CHARGE_ERROR,
                control=ChargeControl.FAULT_STOP_TO_CHARGE,
            )
        return ChargeStatus(connected=plugged)

    def _decide(
        self,
        charger: C2B_ACStatus,
        measurement: Measurement,
        *,
        allowed: bool,
        forbidden: bool,
    ) -> ChargeStatus:
        if forbidden or self.path.failed or _is_faulty(charger):
            return ChargeStatus(
                connected=True,
                state=ChargeState.CHARGE_ERROR,
                control=ChargeControl.FAULT_STOP_TO_CHARGE,
            )
        if self._full:
            return ChargeStatus(connected=True, state=ChargeState.END_OF_CHARGE)
        if not allowed or charger.charger_ready != ChargerTimeout.NORMAL:
            return ChargeStatus(connected=True)
        if not self.path.is_closed:
            return ChargeStatus(
                connected=True,
                control=ChargeControl.START_TO_CHARGE,
                voltage=measurement.voltage,
            )
        hot = charger.charger_over_temp == ChargerFault.FAULT
        return ChargeStatus(
            connected=True,
            state=ChargeState.CHARGING,
            control=ChargeControl.START_TO_CHARGE,
            voltage=FULL_CELL * sum(len(csc) for csc in measurement.cells),
            current=measurement.charge_limit / (2 if hot else 1),
        )


def _is_faulty(charger: C2B_ACStatus) -> bool:
    return (
        charger.charger_hardware == ChargerFault.FAULT
        or charger.charger_input_voltage == ChargerFault.FAULT
        or charger.charger_can == ChargerTimeout.FAULT_OVERTIME
    )


def _is_matched(charger: C2B_ACStatus, voltage: float) -> bool:
    given = charger.voltage_output
    if charger.charger_start != ChargerOperation.ON or isinstance(given, SignalState):
        return False
    return abs(given - voltage) <= _MATCHED * voltage
