"""Values that take several frames: VIN, pack code, cell voltages and probe temperatures.

Split for sending, put together on receipt. Nothing here knows a bus or a clock: messages and
times, in seconds that never go back, are handed in.

What results are worth under loss, repetition and reordering stands in `typedcan.model.transfers`.
The pack code, which is sent every second while it is requested, takes two rounds, and the VIN,
which is sent once on request, one. Ask for ``rounds=2`` where the VIN is sent again, and for
``check=True`` where VINs have the check digit of ISO 3779: it finds most mixtures. Cells and probes
take the totals of B2V_BattInfo2; a CSC is a group.
"""

from swapcan.transfer.collect import Outcome, Transfers
from swapcan.transfer.readings import (
    CellAssembler,
    CellVoltages,
    ProbeAssembler,
    ProbeTemperatures,
    split_cell_voltages,
    split_probe_temperatures,
)
from swapcan.transfer.text import (
    PackCode,
    PackCodeAssembler,
    Vin,
    VinAssembler,
    split_pack_code,
    split_vin,
)
from swapcan.transfer.vin import check_digit, is_valid_vin, vin_problem
from typedcan.transfer import Assembler, Kind, Problem, Reading, Readings

__all__ = [
    "Assembler",
    "CellAssembler",
    "CellVoltages",
    "Kind",
    "Outcome",
    "PackCode",
    "PackCodeAssembler",
    "ProbeAssembler",
    "ProbeTemperatures",
    "Problem",
    "Reading",
    "Readings",
    "Transfers",
    "Vin",
    "VinAssembler",
    "check_digit",
    "is_valid_vin",
    "split_cell_voltages",
    "split_pack_code",
    "split_probe_temperatures",
    "split_vin",
    "vin_problem",
]
