"""Values that take several frames: VIN, pack code, cell voltages and probe temperatures.

Split for sending, put together on receipt. Nothing here knows a bus or a clock: messages and
times, in seconds that never go back, are handed in.

What a result of the text transfers, `Vin` and `PackCode`, is worth
-------------------------------------------------------------------
A set is one frame of each number within the timeout, in any order; no frame counts in two sets.
Other content than a frame of that number had before is a conflict: all is dropped, and from then
on a result takes two complete sets in a row that are identical, without a conflict in between,
until there has been one. After three timeouts without any frame all is forgotten. From this
follows, when n is the number of frames in which the values differ:

- One value, whatever is lost, repeated or reordered: that value or nothing.
- Two nodes that send different values in turns, each its frames in order and without a pause of
  three timeouts, nothing lost since they began: only values that one of them sends. For three or
  more nodes this takes as many ``rounds`` as there are nodes.
- Two such nodes and losses, with ``rounds=2`` or after a first result: a value that nobody sent
  takes at least n lost frames, and certain ones. No receiver can do better: what is then left is
  what one node with that value would have sent.
- A value that changes, frames lost or repeated but in order: with ``rounds=2`` the old or the new
  value, unless it changes back before two sets are complete. With ``rounds=1`` the same, once a
  first result was there; before that, a set that has frames of both values can pass.

Therefore the pack code, which is sent every second while it is requested, takes two rounds, and
the VIN, which is sent once on request, one. Ask for ``rounds=2`` where the VIN is sent again, and
for ``check=True`` where VINs have the check digit of ISO 3779: it finds most mixtures.

What a result of the readings, `CellVoltages` and `ProbeTemperatures`, is worth
-------------------------------------------------------------------------------
Each frame is a measurement of its own. A result has for every cell what was received last for it,
none older than the window, and all of it received since the result before; whatever is lost,
repeated or reordered. It takes the totals of B2V_BattInfo2, which are believed.

How many cells a CSC has is not sent. It is known once the last cells of all CSCs have had a value,
since only then do the cells make the total. Before that, all CSCs are taken to be alike where the
total can be divided so, no cell speaks against it, and all their frames came five times: only a
pack whose CSCs are not alike, with cells without a value at the end of a CSC or frames lost that
often, can deceive this. Where the total cannot be divided, nothing is reported before it is known.
What is known is forgotten with other totals, and after twenty windows without a frame.
"""

from swapcan.transfer.collect import Assembler, Outcome, Transfers
from swapcan.transfer.problem import Kind, Problem
from swapcan.transfer.reading_assembly import CellAssembler, ProbeAssembler
from swapcan.transfer.readings import (
    CellVoltages,
    ProbeTemperatures,
    Reading,
    Readings,
    split_cell_voltages,
    split_probe_temperatures,
)
from swapcan.transfer.text import PackCode, Vin, split_pack_code, split_vin
from swapcan.transfer.text_assembly import PackCodeAssembler, VinAssembler
from swapcan.transfer.vin import check_digit, is_valid_vin, vin_problem

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
